"""The energy that friction dissipates along a load path.

Where only P and Q change, the layers that slip have their energy from the capacities of the
contacts under all loads (`friction.dissipation`, `patches.dissipation`), those of all steps at
once. With a bulk stress or a tilt it is that of states, f p times the slip at constant P and tilt,
and an integral over time where the pressure changes (`friction.step_energy`).
"""

from __future__ import annotations

from itertools import accumulate
from typing import Protocol

import numpy as np

from sie.errors import ContactError
from sie.friction.dissipation import Dissipation, dissipated
from sie.friction.load_history import changing_contact
from sie.friction.load_history.turning_point import TurningPoint
from sie.friction.memory import SlippedLayer
from sie.friction.slip_state import Slip
from sie.friction.step_energy import work
from sie.progress_bar import reported, step_done

from .dissipation import PatchDissipation


class Followed(changing_contact.Followed, Protocol):
    """A path that was followed, and its contacts.

    first_loading    the state of a contact that was never sheared before S rose to a depth
    dissipation      the energy of layers at one tilt, in one patch
    work_in_patches  the same in several patches
    by_parts         a turning point, with the parts of the step to it
    """

    def first_loading(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def dissipation(self, turn: float) -> Dissipation: ...
    def work_in_patches(self, turn: float) -> PatchDissipation: ...
    def by_parts(self, index: int) -> TurningPoint: ...


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

    @reported("dissipated energy, step")
    def _in_steps(self, steps: range) -> list[float]:
        """The energies lost in the steps that end at these points."""
        path, lost = self.path, dict.fromkeys(steps, 0.0)
        upright: dict[float, list[tuple[int, SlippedLayer]]] = {}
        for k in steps:
            step_done()
            state = path.turning_points[k]
            tilted = any(
                depth.imag for o in _layers(state) for depth in (o.upper, o.lower, *o.surface)
            )
            tilted = tilted or state.turned or path.curved
            moving = any(any(o.surface) for o in _layers(state))
            if state.parts or _untimed(state) or (tilted and moving):
                lost[k] += self._of_parts(k)
                continue
            for event in state.slips:
                for o in event.layers:
                    if tilted:
                        lost[k] += o.jump * self._of_states(k, o)
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

    def _of_parts(self, index: int) -> float:
        """The energy that a step dissipated, part by part.

        Layers may answer it at its end, but not on the way.
        """
        try:
            point = self.path.by_parts(index)
            assert point.step is not None
            return sum(work(part, point.step) for part in point.parts)
        except ContactError as problem:
            raise ContactError(
                f"step {index} of the path, to {self.path.turning_points[index].loads}: the energy "
                "lost depends on the way, which the state at its end does not; on it, "
                f"{problem}",
                step=index,
            ) from None

    def _of_states(self, index: int, o: SlippedLayer) -> float:
        """The energy that a layer overwritten at constant P and tilt dissipated, per jump.

        The path has bulk stress or tilt.
        """
        state = self.path.turning_points[index]
        return self._of_depth(state, o.lower) - self._of_depth(state, o.upper)

    def _of_depth(self, state: TurningPoint, depth: complex) -> float:
        """The energy of a first loading to a depth at constant P and tilt."""
        if not depth:
            return 0.0
        found = self.path.first_loading(state.loads.normal, depth, state.turned)
        return dissipated(found)


def _layers(state: TurningPoint) -> list[SlippedLayer]:
    """The layers overwritten in the step to a turning point."""
    return [o for event in state.slips for o in event.layers]


def _untimed(state: TurningPoint) -> bool:
    """Whether layers do not say how a step went on while the pressure changed."""
    return any(
        not event.timed and any(any(o.surface) for o in event.layers) for event in state.slips
    )
