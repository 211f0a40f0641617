"""The steady state of a cycle between two load points, without following a path to it.

In a state that repeats, a point that slips one way on the way to A slips back on the way to B.
Where it slips, q_A - q_B = s f (p_A + p_B); in the permanent stick zone the strain of q_A - q_B is
that of the bulk stresses. Subtracting leaves a normal problem once more,

    q_A - q_B = s f (p_A + p_B - 2 p^),      s the sign of Q_A - Q_B,

p^ the pressure of the same profile under P^ = [P_A + P_B - |Q_A - Q_B|/f]/2 at the tilt
(θ_A + θ_B)/2 - s (τ_A - τ_B)/(f E*), and its contact is the permanent stick zone. Neither the means
of Q and σ nor the way to the steady state matter. A large bulk stress makes the edges slip in
opposite directions: then, at constant P and tilt, twice the first loading by half of the change.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.errors import ContactError
from sie.friction.load_history.changing_contact import ChangingContact
from sie.friction.load_history.path_slip import CourseSlip, step_slip
from sie.friction.load_history.turning_point import TurningPoint
from sie.friction.loads import Loads
from sie.friction.memory import LoadMemory
from sie.friction.slip_state import Slip
from sie.numerics.zones import within
from sie.solution import Solution
from sie.stress.fretting import Cycle
from sie.stress.half_plane import Stress, Tractions
from sie.traction.base import Density, on_line
from sie.traction.combination import superposed

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

    def __len__(self) -> int:
        return 2

    @overload
    def __getitem__(self, index: int) -> SteadyState: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[SteadyState]: ...
    def __getitem__(self, index: int | slice) -> SteadyState | Sequence[SteadyState]:
        return self._states[index]

    @property
    def _slipping(self) -> bool:
        return self.history.turning_points[0].memory.top is not None

    def _reduced(self, index: int) -> Slip:
        """The first loading of A or B to the depth of slip."""
        point = self.history.turning_points[index]
        assert point.memory.top is not None
        depth = point.memory.top.thickness
        return self.history.first_loading(point.loads.normal, depth, point.turned)

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The permanent stick zone, ((lo, hi),) in lengths, or one for each of several patches."""
        if self._slipping:
            return self._reduced(1).stick
        first, second = (self.history.plain(*p.loads.normal) for p in self._ends)
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
        if not self._slipping:
            return out
        at_A, at_B = (
            within(x, self.history.plain(*p.loads.normal).patches, self.history.period)
            for p in self._ends
        )
        for wider, coming in ((at_A & ~at_B, 2), (at_B & ~at_A, 1)):
            if wider.any():
                comes, leaves = (ChangingContact(self.history, k) for k in (coming, 3 - coming))
                slip = np.abs(comes.slip_of_new(x[wider]))
                back = np.abs(leaves.slip_of_left(x[wider]))
                out[wider] = -self._sign * np.maximum(slip, back)
        return out

    @property
    def _sign(self) -> float:
        """The direction of slip on the way to A."""
        top = self.history.turning_points[0].memory.top
        return math.copysign(1.0, top.k) if top else 0.0

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
        top = self.history.turning_points[0].memory.top
        if top is None:
            return self._locked
        return superposed(*((top.k, self._reduced(index).shear) for index in (0, 1)))

    @property
    def _locked(self) -> Density:
        """q_A - q_B where nothing slips: the layers that come and go carry a multiple of p."""
        first, second = self._ends
        rise, pull = (
            end(first.loads) - end(second.loads) for end in (self.history.level, self.history.shear)
        )
        if not (rise or pull):
            return superposed()
        if pull and (abs((pull / rise).imag) > 1e-12 * abs(pull / rise)):
            return self._grown
        k = self.history.scene.friction * (pull / rise).real
        on = [self.history.plain(*p.loads.normal).slope_density for p in self._ends]
        return superposed((k, on[0]), (-k, on[1]))

    @property
    def _grown(self) -> Density:
        """q_A - q_B where nothing slips, of a contact that grows and sticks from one to the other.

        What it was sheared by before does not matter: the rates of q follow from those of the loads
        alone where all of the contact sticks.
        """
        if not self.history.in_one_patch:
            raise ContactError(
                "nothing slips in this cycle, while Q, bulk stress and tilt do not change in "
                "proportion to P: the shear that comes and goes is solved in a contact that is one "
                "patch under every load; change them in proportion"
            )
        small, large = sorted((end.loads for end in self._ends), key=lambda loads: loads.P)
        start = small._replace(Q=0.0, sigma=0.0)
        end = large._replace(Q=large.Q - small.Q, sigma=large.sigma - small.sigma)
        level = self.history.level(start)
        point = self.history.in_parts(TurningPoint(start, LoadMemory(level)), end)
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
        plain = [self.history.plain(*p.loads.normal) for p in self._ends]
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
