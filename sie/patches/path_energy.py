"""The energy that friction dissipates along a load path.

Where only P and Q change, the layers that slip have their energy from the capacities of the
contacts under all loads (`friction.dissipation`, `patches.dissipation`), those of all steps at
once. With a bulk stress or a tilt it is that of states, f p times the slip at constant P and tilt,
and an integral over time where the pressure changes (`friction.moving_work`).
"""

from __future__ import annotations

from itertools import accumulate
from typing import Protocol

import numpy as np

from sie.errors import ContactError
from sie.friction.dissipation import Dissipation, dissipated
from sie.friction.memory import SlippedLayer
from sie.friction.moving_work import work
from sie.friction.slip_state import Slip
from sie.friction.turning_point import Loads, TurningPoint
from sie.problem.scene import Scene

from .dissipation import PatchDissipation


class Followed(Protocol):
    """A path that was followed, and its contacts.

    turning_points   the layers after each step
    in_one_patch     whether the contact is one patch under every load
    curved           whether the tilt follows from a moment
    level            Λ of loads
    first_loading    the state of a contact that was never sheared before S rose to a depth
    on_the_way       the same between two turning points
    dissipation      the energy of layers at one tilt, in one patch
    work_in_patches  the same in several patches
    """

    scene: Scene
    turning_points: tuple[TurningPoint, ...]

    @property
    def in_one_patch(self) -> bool: ...
    @property
    def curved(self) -> bool: ...
    def level(self, loads: Loads) -> complex: ...
    def first_loading(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def on_the_way(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def dissipation(self, turn: float) -> Dissipation: ...
    def work_in_patches(self, turn: float) -> PatchDissipation: ...


class PathEnergy:
    """The energy lost from the beginning of a path to its turning points, as far as asked for."""

    def __init__(self, path: Followed) -> None:
        self.path = path
        self._known: list[float] = []

    def until(self, index: int) -> float:
        """The energy lost from the beginning of the path to a turning point."""
        known = len(self._known)
        if index >= known:
            lost = self._in_steps(range(known, index + 1))
            self._known += list(accumulate(lost, initial=self._known[-1] if known else 0.0))[1:]
        return self._known[index]

    def _in_steps(self, steps: range) -> list[float]:
        """The energies lost in the steps that end at these points."""
        path, lost = self.path, dict.fromkeys(steps, 0.0)
        upright: dict[float, list[tuple[int, SlippedLayer]]] = {}
        for k in steps:
            state = path.turning_points[k]
            for event in state.slips:
                for o in event.layers:
                    depths = o.upper, o.lower, *o.surface
                    if state.turned or path.curved or any(depth.imag for depth in depths):
                        lost[k] += o.jump * self._of_states(k, o, event.timed)
                        continue
                    upright.setdefault(state.loads.turn, []).append((k, o))
        for turn, fronts in upright.items():
            owners, layers = zip(*fronts, strict=True)
            loads = [path.turning_points[k].loads.P for k in owners]
            work_of = path.dissipation(turn) if path.in_one_patch else path.work_in_patches(turn)
            works = np.array(work_of.of_fronts(loads, layers, path.scene.friction))
            for k, o, done in zip(owners, layers, works.tolist(), strict=True):
                lost[k] += o.jump * done
        return list(lost.values())

    def _of_states(self, index: int, o: SlippedLayer, timed: bool) -> float:
        """The energy that an overwritten layer dissipated, per jump, on a path with bulk stress or
        tilt.
        """
        path, state = self.path, self.path.turning_points[index]
        if not any(o.surface):
            return self._of_depth(state, o.lower) - self._of_depth(state, o.upper)
        self._refuse(index, timed)
        start, end = path.turning_points[index - 1].loads, state.loads
        rise = path.level(end) - path.level(start)
        first, last = (1.0 - (surface / rise).real for surface in o.surface)
        part = last - first

        def on_the_way(share: float) -> Slip:
            surface = o.surface[0] + share * (o.surface[1] - o.surface[0])
            depth = o.upper + share * (o.lower - o.upper) - surface
            loads = start.towards(end, first + share * part)
            return path.on_the_way(loads.normal, depth, state.turned)

        strain = 0.5 * path.scene.Estar * (end.turn - start.turn)
        return work(on_the_way, part * (end.P - start.P), part * strain)

    def _refuse(self, index: int, timed: bool) -> None:
        """Refuse steps in which the energy depends on more than the loads at both ends."""
        problem = ""
        if not timed:
            problem = (
                "one end of the stick zone is held up or passes an earlier one before the other "
                "while P or the tilt changes, and the energy lost meanwhile depends on the way; "
                "the state at its end does not"
            )
        elif self.path.curved:
            problem = (
                "the tilt follows from the moment, and the energy lost while it changes is not "
                "covered; give tilt in place of moment"
            )
        if problem:
            loads = self.path.turning_points[index].loads
            raise ContactError(f"step {index} of the path, to {loads}: {problem}", step=index)

    def _of_depth(self, state: TurningPoint, depth: complex) -> float:
        """The energy of a first loading to a depth at constant P and tilt."""
        if not depth:
            return 0.0
        found = self.path.first_loading(state.loads.normal, depth, state.turned)
        return dissipated(found)
