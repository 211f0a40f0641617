"""The state after a growth in which the stick zone receded at one end.

The pressure is that without friction. In a growth in proportion the stick zone and the shear in it
are those of `proportion`, elsewhere those of `marched_shear`.
Under Q at constant P the change is that of `slip`: it depends on the shear before Q alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.slip_state import Step
from sie.numerics.gauss_jacobi import gauss_jacobi

from .proportion import Proportion
from .slip import SMALL, GoodmanSlip

Array = NDArray[np.float64]

KEPT = 0.7  # of the stick zone, from the end that recedes: it stuck under the lighter load
LIGHTEST = 0.8  # of the half-width: no lighter load is looked at
ON_PANEL = 8  # nodes of a rule for the slip between two places
KIND = "outwards on both sides while the normal load grew, the stick zone receded, β q neglected"


class ShearBeforeQ(Protocol):
    """The shear that the normal load alone leaves, for β > 0.

    step        the contact and its pressure
    touch       the place of first touch
    stick       the stick zone
    marks       places inside where the shear is not smooth
    lighter     the same under a lighter load
    untouched   what stuck under the lighter load, and ever since
    """

    @property
    def step(self) -> Step: ...
    @property
    def touch(self) -> float: ...
    @property
    def stick(self) -> tuple[float, float]: ...
    @property
    def marks(self) -> tuple[float, ...]: ...
    @property
    def lighter(self) -> ShearBeforeQ: ...
    @property
    def untouched(self) -> tuple[float, float]: ...
    def __call__(self, x: Array) -> Array: ...


@dataclass(frozen=True, eq=False)
class MovingShear:
    """The shear before Q, for β > 0.

    step        the contact and its pressure
    growth      of the contact, mirrored where `side` is -1
    touch       the place of first touch
    side        that of the end that advances
    """

    step: Step
    growth: Proportion
    touch: float
    side: float

    @property
    def stick(self) -> tuple[float, float]:
        r = self.side * self.step.pressure.contact.r
        first, second = (self.touch + r * end for end in self.growth.stick)
        return min(first, second), max(first, second)

    @property
    def marks(self) -> tuple[float, ...]:
        return (self.touch,)

    @cached_property
    def lighter(self) -> MovingShear:
        """The shear under a lighter load, under which most of the stick zone stuck."""
        step = self.step
        first, second = self.growth.stick
        part = max(LIGHTEST, (first + KEPT * (second - first)) / second)
        load = step.normal_load * part ** (1.0 + self.growth.power)
        found = step.contact_under(load, step.normal.edges.tilt)
        before = replace(step, normal=found, pressure=step.pressure_on(found), Q=0.0)
        return replace(self, step=before)

    @property
    def untouched(self) -> tuple[float, float]:
        (a, b), (c, d) = self.stick, self.lighter.stick
        return max(a, c), min(b, d)

    def __call__(self, x: Array) -> Array:
        """q in the contact."""
        step, r = self.step, self.step.pressure.contact.r
        f_p = step.scene.friction * step.pressure(x)
        c1, c2 = self.stick
        q = np.where(x >= c2, f_p, -f_p)
        stuck = (x > c1) & (x < c2)
        below, above = (x[stuck] - c1) / r, (c2 - x[stuck]) / r
        first, second = (below, above) if self.side > 0.0 else (above, below)
        lack, left = self.growth.lack(first, second)
        limit, lack = f_p[stuck], step.scene.friction * step.normal_load / r * lack
        values = self.side * np.where(left, lack - limit, limit - lack)
        q[stuck] = np.clip(values, -limit, limit)
        return q


@dataclass(frozen=True, eq=False)
class MovingSlip(GoodmanSlip):
    """The state after the normal load, and Q at constant P; `before` is the shear before Q."""

    before: ShearBeforeQ | None = None

    @property
    def _normal(self) -> ShearBeforeQ:
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
        for x in sorted({*self._normal.marks, *self.normal_stick, *self.stick[0]}):
            if marks[-1] + apart < x < x2 - apart:
                marks.append(x)
        return *marks, x2

    @property
    def untouched(self) -> tuple[float, float]:
        """What stuck under the lighter load, and ever since."""
        (lo, hi), (c1, c2) = self._normal.untouched, self.stick[0]
        return max(lo, c1), min(hi, c2)

    def normal_shear(self, x: Array) -> Array:
        return self._normal(x)

    def _tabulated_shear(self, x: Array) -> Array:
        return self._normal(x)

    # -- while the load grew -----------------------------------------------------------------------

    @cached_property
    def lighter(self) -> MovingSlip:  # type: ignore[override]
        """The state under a lighter load, under which much of the stick zone stuck."""
        before = self._normal.lighter
        return replace(self, step=before.step, zones=None, before=before)

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
