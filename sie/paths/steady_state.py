"""The steady state of a cycle between two load points, without following a path to it.

In a state that repeats, a point that slips one way on the way to A slips back on the way to B.
Where it slips, q_A - q_B = s f (p_A + p_B); in the permanent stick zone the strain of q_A - q_B is
that of the bulk stresses. Neither the means of Q and σ, nor what is locked in, nor the way to the
steady state matter. At constant P and tilt q_A - q_B is twice the first loading by half of the
change; otherwise each way is followed from q = ± f p all over (`friction.load_steps`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.friction.load_steps import TurningPoint
from sie.friction.loading import Loads
from sie.friction.path_slip import CourseSlip, step_slip
from sie.friction.slip import Slip
from sie.numerics.zones import within
from sie.solution import Solution
from sie.stress.fretting import Cycle
from sie.stress.half_plane import Stress, Tractions
from sie.traction.base import Density, on_line
from sie.traction.combination import superposed

if TYPE_CHECKING:
    from .history import History

Array = NDArray[np.float64]


class SteadyCycle(Sequence["SteadyState"]):
    """The steady state of a cycle between two load points; `steady_cycle` makes it.

    Parameters
    ----------
    history : History
        The path from A to B and back.

    Notes
    -----
    A steady cycle is a sequence of its two turning points, which `sie.Cycle` takes. Ranges are
    those of the steady state. The mean of the shear in the permanent stick zone depends on how the
    steady state was reached: here it is that of a contact that comes to A by P and tilt first, then
    Q and σ.
    """

    def __init__(self, history: History) -> None:
        self.history = history

    def __getstate__(self) -> dict[str, Any]:
        """The question alone: states hold functions, which no pickle takes."""
        return {k: vars(self)[k] for k in ("history", "scene", "points", "tol") if k in vars(self)}

    def __len__(self) -> int:
        return 2

    def __getitem__(self, index: Any) -> Any:
        return self._states[index]

    @property
    def _reduced(self) -> Slip | None:
        """The first loading of A to the depth of slip, at constant P and tilt."""
        point = self.history.turning_points[0]
        if not point.memory.layers:
            return None
        depth = point.memory.layers[0][0]
        return self.history.first_loading(point.loads.normal, depth, point.turned)

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The permanent stick zone, ((lo, hi),) in lengths, or one for each of several patches."""
        if self._reduced is not None:
            return self._reduced.stick
        A, B = self._ends
        if B.parts:
            return B.state.stick
        first, second = (self.history.plain(*p.loads.normal) for p in (A, B))
        if max(len(first.patches), len(second.patches)) > 1:
            return min(first, second, key=lambda contact: contact.normal_load).patches
        (a, b), (c, d) = first.edges, second.edges
        return ((max(a, c), min(b, d)),)

    @property
    def energy(self) -> float:
        """The energy that friction dissipates in each cycle, force per length times length."""
        return self.history.energy(2)

    def slip_range(self, x: ArrayLike) -> Array:
        """The range of the slip in a cycle, as length, at positions x on the surface.

        Parameters
        ----------
        x : array_like of float
            Positions on the surface that do not leave the contact, length.

        Returns
        -------
        ndarray of float
            0 in the permanent stick zone and outside the contact.

        Raises
        ------
        ContactError
            For points that leave the contact in each cycle, in several patches or where the tilt
            follows from a moment.

        Notes
        -----
        What leaves the contact slips from when it comes back until it leaves again.
        """
        return on_line(lambda at: np.abs(self._slip(at)), x)

    def _slip(self, x: Array) -> Array:
        """The slip at B, counted from A; the range where x leaves the contact."""
        out = step_slip(self.history, 1, x)
        A, B = self._ends
        if B.parts:
            at_A, at_B = (
                within(x, self.history.plain(*p.loads.normal).patches, self.history.period)
                for p in (A, B)
            )
            leaves = at_A & ~at_B
            out[leaves] = -step_slip(self.history, 2, x[leaves])
        return out

    def shear_range(self, x: ArrayLike) -> Array:
        """|q_A - q_B|, the range of the shear traction in a cycle, as stress, at positions x.

        Parameters
        ----------
        x : array_like of float
            Positions on the surface, also those that leave the contact, length.

        Returns
        -------
        ndarray of float
            As stress; 0 outside the contacts.
        """
        return np.abs(self.shear_change(x))

    @cached_property
    def shear_change(self) -> Density:
        """q_A - q_B, a `Density` in units of stress."""
        A, B = self._ends
        if self._reduced is not None:
            return superposed((2.0 * A.memory.layers[0][1], self._reduced.shear))
        if B.parts:
            assert B.step is not None
            s = -B.state.slip[0][2]
            full = self.history.plain(*A.loads.normal).slope_density
            at_B = CourseSlip(self.history, 1).shear
            return superposed((s * self.history.scene.friction, full), (-1.0, at_B))
        return self._locked

    @property
    def _locked(self) -> Density:
        """q_A - q_B where nothing slips: in proportion to Δp where the loads are."""
        first, second = (end.loads for end in self._ends)
        (P, Q, *more), (P_B, Q_B, *more_B) = first, second
        if more == more_B and P != P_B:
            k = (Q - Q_B) / (P - P_B)
            on = [self.history.plain(*at.normal).slope_density for at in (first, second)]
            return superposed((k, on[0]), (-k, on[1]))
        return self._grown if first != second else superposed()

    @property
    def _grown(self) -> Density:
        """q_A - q_B where nothing slips, of a contact that grows and sticks from one to the other.

        What it was sheared by before does not matter: the rates of q follow from those of the loads
        alone where all of the contact sticks.
        """
        small, large = sorted((end.loads for end in self._ends), key=lambda loads: loads.P)
        start = small._replace(Q=0.0, sigma=0.0)
        end = large._replace(Q=large.Q - small.Q, sigma=large.sigma - small.sigma)
        point = self.history.in_parts(TurningPoint(start), end)
        grown = CourseSlip(self.history, state=point).shear
        return superposed((1.0 if large is self._ends[0].loads else -1.0, grown))

    @property
    def _ends(self) -> tuple[Any, Any]:
        first, second, _ = self.history.turning_points
        return first, second

    @cached_property
    def cycle(self) -> Cycle:
        """The stresses of the cycle, as `Cycle` gives them."""
        return Cycle(self)

    @cached_property
    def _states(self) -> tuple[SteadyState, SteadyState]:
        plain = [cast(Solution, self.history.plain(*p.loads.normal)) for p in self._ends]
        loads = [p.loads for p in self._ends]
        first = Solution(
            replace(plain[0].scene, tangential_load=loads[0].Q, bulk_stress=loads[0].sigma),
            self.history.tol,
            self.history.economy,
        ).shear
        shears = first, superposed((1.0, first), (-1.0, self.shear_change))
        at_A, at_B = (
            SteadyState(replace(p.tractions, shear=q, bulk_stress=load.sigma), index, self)
            for index, (p, q, load) in enumerate(zip(plain, shears, loads, strict=True))
        )
        return at_A, at_B


@dataclass(frozen=True, eq=False)
class SteadyState:
    """One of the two turning points of a steady cycle, as `Cycle` uses it.

    Parameters
    ----------
    tractions : Tractions
        Pressure, shear and bulk stress there.
    index : int
        0 for A and 1 for B.
    steady : SteadyCycle
        The cycle.
    """

    tractions: Tractions
    index: int
    steady: SteadyCycle

    @property
    def normal_load(self) -> float:
        """Normal load P, force per length."""
        return self._loads.P

    @property
    def tangential_load(self) -> float:
        """Tangential load Q, force per length."""
        return self._loads.Q

    @property
    def _loads(self) -> Loads:
        return self.steady.history.turning_points[self.index].loads

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zone, which at both turning points is the permanent one, lengths."""
        return self.steady.stick

    @property
    def pressure(self) -> Density:
        """The contact pressure, a `Density`."""
        return self.tractions.pressure

    @property
    def shear(self) -> Density:
        """The shear traction, a `Density`."""
        return self.tractions.shear

    def stress(self, x: ArrayLike, y: ArrayLike) -> Stress:
        """The stress at points of the body, as `Solution.stress`."""
        return Stress(self.tractions, x, y)

    def slip(self, x: ArrayLike) -> Array:
        """The slip at x, counted from A."""
        return on_line(self.steady._slip if self.index else np.zeros_like, x)
