"""The energy that friction dissipates along a load path.

Where only P and Q change, the layers that slip have their energy from the capacities of the
contacts under all loads (`friction.dissipation`, `patches.dissipation`), those of all steps at
once. With a bulk stress or a tilt it is that of states, f p times the slip at constant P and tilt,
and an integral over time where the pressure changes (`friction.moving_work`).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import accumulate
from typing import Protocol

import numpy as np

from sie.errors import ContactError
from sie.friction.dissipation import Dissipation, dissipated
from sie.friction.load_history import changing_contact
from sie.friction.load_history.changing_contact import ChangingContact
from sie.friction.load_history.moving_work import work
from sie.friction.load_history.turning_point import TurningPoint
from sie.friction.loads import Loads
from sie.friction.memory import SlippedLayer
from sie.friction.slip_state import Slip
from sie.friction.step_conditions import TESTED
from sie.numerics.interval import Interval
from sie.progress_bar import reported, step_done

from .dissipation import PatchDissipation


class Followed(changing_contact.Followed, Protocol):
    """A path that was followed, and its contacts.

    first_loading    the state of a contact that was never sheared before S rose to a depth
    dissipation      the energy of layers at one tilt, in one patch
    work_in_patches  the same in several patches
    march            the turning point after a step that no layers answer
    """

    def first_loading(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def dissipation(self, turn: float) -> Dissipation: ...
    def work_in_patches(self, turn: float) -> PatchDissipation: ...
    def march(self, before: TurningPoint, loads: Loads) -> TurningPoint: ...


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
            if state.marched or _untimed(state):
                lost[k] += self._of_march(k)
                continue
            for event in state.slips:
                for o in event.layers:
                    depths = o.upper, o.lower, *o.surface
                    if state.turned or path.curved or any(depth.imag for depth in depths):
                        lost[k] += o.jump * self._of_states(k, o, event.sign)
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

    def _of_march(self, index: int) -> float:
        """The energy that a step dissipated, by marching.

        Layers may answer it at its end, but not on the way.
        """
        before, state = self.path.turning_points[max(index - 1, 0)], self.path.turning_points[index]
        try:
            if not (state.marched or self.path.in_one_patch):
                raise ContactError(
                    "one end of a stick zone is held up; that is followed only in a "
                    "contact that is one patch under every load"
                )
            parts = state.marched or self.path.march(before, state.loads).marched
            return sum(part.work for part in parts)
        except ContactError as problem:
            raise ContactError(
                f"step {index} of the path, to {state.loads}: the energy lost depends on the way, "
                f"which the state at its end does not; on it, {problem}",
                step=index,
            ) from None

    def _of_states(self, index: int, o: SlippedLayer, sign: float) -> float:
        """The energy that an overwritten layer dissipated, per jump.

        The path has bulk stress or tilt.
        """
        path, state = self.path, self.path.turning_points[index]
        if not any(o.surface):
            return self._of_depth(state, o.lower) - self._of_depth(state, o.upper)
        step = ChangingContact(path, index)
        if path.in_one_patch or path.curved:
            step.refuse("the energy lost meanwhile depends on the way, not so the state at its end")
        first, last = step.shares(o)
        load = (last - first) * (state.loads.P - path.turning_points[index - 1].loads.P)

        def on_the_way(time: float) -> Slip:
            return step.state_at(o, sign, first + time * (last - first))

        if not path.in_one_patch:
            _refuse_births(step, on_the_way)

        def strain(contact: Interval) -> float:
            return (last - first) * step.strain(contact)

        return work(on_the_way, load, strain)

    def _of_depth(self, state: TurningPoint, depth: complex) -> float:
        """The energy of a first loading to a depth at constant P and tilt."""
        if not depth:
            return 0.0
        found = self.path.first_loading(state.loads.normal, depth, state.turned)
        return dissipated(found)


def _refuse_births(step: ChangingContact, on_the_way: Callable[[float], Slip]) -> None:
    """Refuse a front on the way of which stick zones appear, merge or vanish.

    The power of friction has a kink there, next to which it is found in halves of the time only.
    """
    numbers = [len(on_the_way(time).stick) for time in TESTED]
    if len(set(numbers)) > 1:
        raise ContactError(
            f"step {step.index} of the path, to {step.end}: the number of stick zones changes on "
            f"the way, from {numbers[0]} to {numbers[-1]}, and of it the state at the end "
            "is solved, not the energy; change bulk stress and tilt at another time than P",
            step=step.index,
        )


def _untimed(state: TurningPoint) -> bool:
    """Whether layers do not say how a step went on while the pressure changed."""
    return any(
        not event.timed and any(any(o.surface) for o in event.layers) for event in state.slips
    )
