"""The steady state of a cycle of dissimilar bodies at constant P, found by following cycles.

Pressing shakes down: after a few cycles the states at both turning points repeat themselves.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.errors import ContactError
from sie.friction.load_steps import TurningPoint, points_of_loads, steady_points
from sie.problem.load_path import Path, loads_at, refuse_without_paths
from sie.problem.request import ECONOMY
from sie.problem.scene import Scene
from sie.solution import Solution
from sie.traction.base import Density
from sie.traction.combination import superposed

from .history import History
from .steady_state import SteadyCycle, SteadyState

Array = NDArray[np.float64]

TOUCHING = "the bodies must touch all along the cycle; give P > 0"
CYCLES = 12  # that are followed at most
REPEATED = 1e-9  # of the contact: what an end of the stick zone may still move


def steady_cycle(
    scene: Scene,
    A: Sequence[float],
    B: Sequence[float],
    tol: float = 1e-13,
    economy: Collection[str] = ECONOMY,
) -> SteadyCycle:
    """The steady state of a cycle in which all loads go from A to B and back in phase.

    Parameters
    ----------
    scene : Scene
        Profile, bodies, friction and tilt; its loads are replaced by those of A and B.
    A, B : sequence of float
        (P, Q, σ) or (P, Q, σ, tilt) at the two turning points, as in `Path`.
    tol : float, optional
        Relative accuracy, as in `solve`.
    economy : collection of str, optional
        What may be skipped, as in `solve`.

    Returns
    -------
    SteadyCycle
        Permanent stick zone, energy per cycle, ranges of slip and shear.

    Raises
    ------
    ValueError
        For values that are no loads, or a scene of full stick.
    ContactError
        For dissimilar bodies where P changes.
        Where the steady state is not that of one permanent stick zone which both ends of the slip
        reach at once; in several patches where slip has opposite directions at the same time; per
        period where σ changes.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(100.0), modulus=80e3, normal_load=50.0, friction=0.5)
    >>> cycle = sie.steady_cycle(scene, (55.0, 15.0, 30.0), (50.0, -5.0, -30.0))
    >>> [[round(end, 6) for end in zone] for zone in cycle.stick]
    [[-0.189932, 0.264932]]
    """
    points, tilts = zip(*(_point(name, p) for name, p in (("A", A), ("B", B))), strict=True)
    if isinstance(scene, Scene) and scene.coupled and not any(tilts):
        return DissimilarCycle(scene, points, tol)
    refuse_without_paths(scene)
    path = Path((*points, points[0]), tilt=(*tilts, tilts[0]) if any(tilts) else ())
    return SteadyCycle(History(scene, path, tol, economy, steps=steady_points))


def _point(name: str, point: Sequence[float]) -> tuple[tuple[float, ...], float]:
    values = arguments.listed(name, point, "(P, Q, σ) or (P, Q, σ, tilt)")
    if len(values) not in (2, 3, 4):
        raise ValueError(f"{name} = {point!r}: give (P, Q, σ) or (P, Q, σ, tilt)")
    loads = loads_at(name, values[:3], TOUCHING)
    if loads[0] == 0.0:
        raise ValueError(f"P of {name} = 0 is not positive: {TOUCHING}")
    return loads, arguments.measure(f"tilt of {name}", values[3]) if len(values) == 4 else 0.0


class Turns(NamedTuple):
    """The loads of a cycle."""

    turning_points: tuple[TurningPoint, ...]


class DissimilarCycle(SteadyCycle):
    """The steady state between two points (P, Q, σ) of equal P; `steady_cycle` makes it."""

    def __init__(self, scene: Scene, points: tuple[tuple[float, ...], ...], tol: float) -> None:
        (P, *_), (other, *_) = points
        if other != P:
            raise ContactError(
                f"a cycle of dissimilar bodies (β = {scene.beta:.4g}) with friction between P = "
                f"{P:.6g} and {other:.6g} is not solved: hold P at its mean, or give dundurs = 0"
            )
        self.scene, self.points, self.tol = scene, points, tol

    @cached_property
    def _followed(self) -> list[Solution]:
        """The turning points A, B, A ... until two states at A are the same."""
        P = self.points[0][0]
        alone = replace(
            self.scene, normal_load=P, half_width=None, tangential_load=0.0, bulk_stress=0.0
        )
        pressed = Solution(alone, self.tol)
        states = [self._after(pressed, pressed.pressed[1], 0)]
        for turn in range(1, 2 * CYCLES + 1):
            states.append(self._after(pressed, states[-1].coupled[1], turn % 2))
            if turn % 2 == 0:
                moved = np.abs(np.subtract(states[-3].stick, states[-1].stick)).max()
                if moved <= REPEATED * 2.0 * states[-1].half_width:
                    return states
        raise ContactError(
            f"the states at P = {P:.6g} do not repeat themselves within {CYCLES} cycles; follow "
            "the path (sie.follow)"
        )

    def _after(self, pressed: Solution, before: Any, index: int) -> Solution:
        _, Q, sigma = self.points[index]
        solution = pressed.with_(tangential_load=Q, bulk_stress=sigma)
        solution.go_on_from(before)
        return solution

    @cached_property
    def history(self) -> Turns:  # type: ignore[override]
        """The turning points A, B and A."""
        return Turns(points_of_loads(Path((*self.points, self.points[0]))))

    @property
    def _solutions(self) -> tuple[Solution, Solution]:
        """At A and at B."""
        return self._followed[-1], self._followed[-2]

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The permanent stick zone: what sticks at both turning points, lengths."""
        ((a, b),), ((c, d),) = (solution.stick for solution in self._solutions)
        return ((max(a, c), min(b, d)),)

    @property
    def energy(self) -> float:
        """The energy that friction dissipates in each cycle, force per length times length."""
        return self._followed[-1].energy_lost - self._followed[-3].energy_lost

    def _slip(self, x: Array) -> Array:
        at_A, at_B = (solution.slip(x) for solution in self._solutions)
        return at_B - at_A

    @property
    def shear_change(self) -> Density:
        """q_A - q_B, a `Density` in units of stress."""
        at_A, at_B = (solution.shear for solution in self._solutions)
        return superposed((1.0, at_A), (-1.0, at_B))

    @cached_property
    def _states(self) -> tuple[SteadyState, SteadyState]:
        at_A, at_B = (SteadyState(s.tractions, k, self) for k, s in enumerate(self._solutions))
        return at_A, at_B
