"""The state after a growth in which the stick zone receded at one end at a time.

The pressure is that without friction, the stick zone and the shear in it follow from the history
(`march`, `moving_history`). Under Q at constant P the change is that of `slip`: it depends on the
shear before Q alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_state import Step
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import Interval

from .moving_history import MovingHistory, Stage
from .root_series import RootSeries
from .slip import SMALL, GoodmanSlip

Array = NDArray[np.float64]

KEPT = 0.7  # of the stick zone, from the end that recedes: it stuck under the lighter load
LIGHTEST = 0.8  # of the half-width of the contact: no lighter load is looked at
LATER = 1e-3  # of a half-width: after the stick zone began to recede, its end has moved
OF_SHEAR = 1e-7  # of the largest shear: what is promised of (12), and kept by a factor of ten
HALVINGS = 60
ON_PANEL = 8  # nodes of a rule for the slip between two places
KIND = "outwards on both sides while the normal load grew, the stick zone receded, β q neglected"


@dataclass(frozen=True, eq=False)
class NormalShear:
    """The shear before Q, for β > 0, from its history.

    step        the contact and its pressure
    history     of the stick zone, in places from `origin`
    origin      the centre of the contact under the whole load
    corners     places at which an end was when it changed its motion
    """

    step: Step
    history: MovingHistory
    origin: float
    corners: tuple[float, ...]

    @cached_property
    def stick(self) -> tuple[float, float]:
        u, a = self.history.final
        return self.origin + u, self.origin + a

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places in the stick zone where the shear is not smooth, with its ends."""
        c1, c2 = self.stick
        apart, marks = SMALL * self.step.pressure.contact.r, [c1]
        for x in sorted(self.origin + y for y in self.corners):
            if marks[-1] + apart < x < c2 - apart:
                marks.append(x)
        return *marks, c2

    def direct(self, x: Array) -> Array:
        """q in the stick zone by the integrals over its history."""
        p, q = self.step.pressure(x), np.zeros(x.shape)
        right = x > 0.5 * sum(self.stick)
        for own, side in ((right, 1.0), (~right, -1.0)):
            if own.any():
                q[own] = side * (p[own] - self.history.lack(x[own] - self.origin, side))
        limited: Array = self.step.scene.friction * np.clip(q, -p, p)
        return limited

    @cached_property
    def _series(self) -> RootSeries:
        return RootSeries(self.direct, np.array(self.marks))

    def __call__(self, x: Array) -> Array:
        """q in the contact."""
        c1, c2 = self.stick
        f_p = self.step.scene.friction * self.step.pressure(x)
        q = np.where(x >= c2, f_p, -f_p)
        stuck = (x > c1) & (x < c2)
        values = self._series(x[stuck])
        q[stuck] = np.clip(values, -f_p[stuck], f_p[stuck])
        return q


@dataclass(frozen=True, eq=False)
class MovingSlip(GoodmanSlip):
    """The state after the normal load, and Q at constant P; `before` is the shear before Q."""

    before: NormalShear | None = None
    of_shear = OF_SHEAR

    @property
    def _normal(self) -> NormalShear:
        assert self.before is not None
        return self.before

    @property
    def kind(self) -> str:  # type: ignore[override]
        return f"{KIND} (Goodman)" if self.zones is None else f"{KIND}; then along Q (Goodman)"

    @property
    def symmetric(self) -> bool:
        return False

    @property
    def normal_stick(self) -> tuple[float, float]:
        return self._normal.stick

    @cached_property
    def marks(self) -> tuple[float, ...]:  # type: ignore[override]
        x1, x2 = self.step.pressure.interval
        apart, marks = SMALL * self.contact.r, [x1]
        normal = self._normal
        everywhere = {normal.origin + y for y in normal.corners}
        for x in sorted({*everywhere, *normal.stick, *self.stick[0]}):
            if marks[-1] + apart < x < x2 - apart:
                marks.append(x)
        return *marks, x2

    @property
    def untouched(self) -> tuple[float, float]:
        """What stuck under the lighter load, and ever since."""
        zones = np.array([self.lighter.normal_stick, self.normal_stick, self.stick[0]])
        return float(zones[:, 0].max()), float(zones[:, 1].min())

    def normal_shear(self, x: Array) -> Array:
        return self._normal(x)

    def _tabulated_shear(self, x: Array) -> Array:
        return self._normal(x)

    # -- while the load grew -----------------------------------------------------------------------

    @cached_property
    def _since(self) -> tuple[int, float]:
        """The contact after which most of the stick zone stuck, and no place of it slipped.

        It is given by the number of its stage and its half-width.
        """
        stages = self._normal.history.stages
        last = stages[-1]
        first, second = last.ends()[2:, 1].tolist()
        aim = first + KEPT * (second - first)

        def late(stage: Stage, r: float) -> bool:
            a = float(stage.second_end(np.array([r]))[0])
            return a > aim and r > LIGHTEST * last.hi

        k = len(stages) - 1
        while k and late(stages[k], stages[k].lo):
            before = stages[k - 1]
            if before.recedes != last.recedes or before.side != last.side:
                return k, stages[k].lo * (1.0 + LATER)
            k -= 1
        lo, hi = stages[k].lo, stages[k].hi
        for _ in range(HALVINGS):
            middle = 0.5 * (lo + hi)
            lo, hi = (lo, middle) if late(stages[k], middle) else (middle, hi)
        return k, hi

    @cached_property
    def lighter(self) -> MovingSlip:  # type: ignore[override]
        """The state under a lighter load."""
        (k, r), step, old = self._since, self.step, self._normal
        stages = old.history.stages
        centre = old.origin + stages[k].side * float(stages[k].middle(np.array([r]))[0])
        m, integrals = self.table.contact(r, centre)
        load = self.table.search.load(Interval(m - r, m + r), integrals)
        found = step.contact_under(load, step.normal.edges.tilt)
        before = replace(step, normal=found, pressure=step.pressure_on(found), Q=0.0)
        history = MovingHistory((*stages[:k], replace(stages[k], hi=r)))
        shear = NormalShear(before, history, old.origin, old.corners)
        return replace(self, step=before, zones=None, before=shear)

    def slip(self, x: Array) -> Array:
        raise self._not_computed()

    @property
    def energy(self) -> float:
        raise self._not_computed()

    @property
    def shift(self) -> float:
        raise self._not_computed()

    @staticmethod
    def _not_computed() -> ContactError:
        return ContactError(
            "the slip of a contact whose stick zone receded while the load grew is not computed in "
            "Goodman's approximation: zones, pressure, shear and stresses are"
        )

    def slip_now(self, x: Array) -> Array:
        """The slip since the lighter load, from the change of H q + β p beside the stick zone."""
        (c1, c2), light, beta = self.stick[0], self.lighter, self.step.scene.beta
        slip = np.zeros(x.shape)
        for end, side in ((c1, -1.0), (c2, 1.0)):
            own = np.flatnonzero(side * (x - end) > 0.0)
            own = own[np.argsort(side * x[own])]
            ends = np.concatenate(([end], x[own]))
            nodes, _, w = gauss_jacobi(ON_PANEL, 0.0, 0.0)
            at = (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
            rate = self.shear.hilbert(at) + beta * self.step.pressure(at)
            rate -= light.shear.hilbert(at) + beta * light.step.pressure(at)
            slip[own] = np.cumsum(np.diff(ends) * (rate.reshape(-1, ON_PANEL) @ w))
        return slip
