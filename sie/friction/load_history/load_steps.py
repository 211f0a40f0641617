"""The steps of a load path one after the other, and those of a steady cycle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Protocol, TypeVar

from sie.errors import ContactError
from sie.friction import loading
from sie.friction.load_step import Contacts, NotLayered, Step
from sie.friction.loading import LoadStep
from sie.friction.loads import Loads
from sie.friction.memory import Layer, LoadMemory, in_proportion, simple
from sie.friction.rates import Rates
from sie.numerics.interval import EPS
from sie.problem.load_limit import refuse_sliding
from sie.problem.load_path import Path
from sie.problem.scene import Scene
from sie.progress_bar import counted

from .turning_point import TurningPoint

Result = TypeVar("Result")


class Followable(Contacts, loading.Contacts, Protocol):
    """The contacts of a path that is followed.

    in_one_patch    whether the contact is one patch under every load
    in_parts        the turning point after a step that no layers answer
    """

    @property
    def in_one_patch(self) -> bool: ...
    def in_parts(self, before: TurningPoint, loads: Loads) -> TurningPoint: ...


def turning_points(scene: Scene, path: Path, contacts: Followable) -> tuple[TurningPoint, ...]:
    """The layers after each step of a path.

    Raises ContactError, with the step, where one is not covered.
    """
    f, found = scene.friction, []
    points = loads_of(path)
    for k, loads in enumerate(points):
        if f == 0.0 and loads.Q != 0.0:
            raise ValueError(
                f"Q of point {k} = {loads.Q:g} without friction: a frictionless contact carries "
                "none; give friction > 0"
            )
        if abs(loads.Q) > f * loads.P:
            named(k, loads, partial(refuse_sliding, f, loads.P, loads.Q))
    start = points[0]._replace(Q=0.0, sigma=0.0)
    state = TurningPoint(start, LoadMemory(contacts.level(start)))
    for k, loads in counted("load path", enumerate(points), len(points)):
        state = named(k, loads, partial(stepped if k else _first, contacts, state, loads))
        found.append(state)
    return tuple(found)


def _first(contacts: Followable, unsheared: TurningPoint, loads: Loads) -> TurningPoint:
    """The first turning point: P and the tilt, then Q and σ in proportion.

    Where zones of slip retreat on the way, and that is not covered, it is the state of a scene, in
    total displacements.
    """
    try:
        return stepped(contacts, unsheared, loads)
    except ContactError as problem:
        return replace(_layered(contacts, unsheared, loads), why=str(problem))


def loads_of(path: Path) -> list[Loads]:
    return [Loads(*point, turn) for point, turn in zip(path.points, path.turns, strict=True)]


def points_of_loads(path: Path) -> tuple[TurningPoint, ...]:
    """The points of a path at which nothing has to be remembered."""
    return tuple(TurningPoint(loads, LoadMemory(loads.P)) for loads in loads_of(path))


def named(
    k: int, loads: Loads, step: Callable[[], Result], place: str = "step {} of the path, to"
) -> Result:
    try:
        return step()
    except ContactError as problem:
        raise type(problem)(
            f"{place.format(k)} {loads}: {problem}", **problem.reached | {"step": k}
        ) from None


def steady_points(scene: Scene, path: Path, contacts: Followable) -> tuple[TurningPoint, ...]:
    """The turning points A, B, A of a steady cycle.

    The layers are those of the change from one to the other alone.

    What slips in one direction on the way to B slips back on the way to A. Hence q_A - q_B =
    s f (p_A + p_B) there, and in the stick zone, where that is 2 s f p^ less,

        Λ^ = [Λ_A + Λ_B - s (S_A - S_B)]/2,      s the sign of slip before A:

    below Λ^ nothing slips, whatever is locked in there.
    """
    first, second, last = loads_of(path)
    for k, loads in enumerate((first, second)):
        slides = partial(refuse_sliding, scene.friction, loads.P, loads.Q)
        named(k, loads, slides, f"the cycle at {'AB'[k]},")
    rise = simple(contacts.level(second) - contacts.level(first))
    pull = simple(contacts.shear(second) - contacts.shear(first))
    start = TurningPoint(first, LoadMemory(contacts.level(first)))
    there = Step(contacts, start, second, rise, pull)
    back = Step(contacts, replace(start, loads=second), first, -rise, -pull)
    upright = not (rise.imag or pull.imag)  # contacts are nested by their loads, in any patches
    sticks = abs(pull) <= abs(rise) if upright else there.sticks or back.sticks
    if not (rise or pull) or sticks:
        return start, TurningPoint(second, LoadMemory(contacts.level(second))), start
    turned = not rise and there.opposite
    s = -math.copysign(1.0, pull.imag if turned else pull.real)
    slipped = -0.5 * (rise + s * pull)
    memory = LoadMemory(start.memory.level, Layer(slipped, s, None, s * slipped, slipped))
    found = [replace(start, memory=memory, turned=turned)]
    for k, loads in ((1, second), (2, last)):
        sign, before = s if k == 2 else -s, found[-1]
        step = Step(contacts, before, loads, *((rise, pull) if k == 1 else (-rise, -pull)))
        turned_back = step.upright if upright else partial(step.reversed, sign)
        found.append(named(k, loads, turned_back, f"the cycle on the way to {'ABA'[k]},"))
    return tuple(found)


def stepped(contacts: Followable, before: TurningPoint, loads: Loads) -> TurningPoint:
    """The turning point after a step: by layers, and where these do not answer part by part.

    Raises ContactError where the step is not covered.
    """
    if before.parts:
        last = before.state.contact
        if before.loads.normal == loads.normal and contacts.sheared_by(loads) == (last.Q, last.tau):
            return replace(before, loads=loads)
        return replace(contacts.in_parts(before, loads), why="a step before was")
    try:
        found = _layered(contacts, before, loads)
    except NotLayered as problem:
        return replace(contacts.in_parts(before, loads), why=str(problem))
    if found.turned and found.straight and contacts.in_one_patch:
        known = before.memory.top is None or _advancing(contacts, before)
        if known and not _advancing(contacts, found):
            return replace(contacts.in_parts(before, loads), why="zones of slip retreat on the way")
    if found.turned and contacts.in_one_patch and _stops(contacts, before, found):
        return replace(contacts.in_parts(before, loads), why="a zone of slip retreats on the way")
    return found


def _stops(contacts: Followable, before: TurningPoint, point: TurningPoint) -> bool:
    """Whether an end of the stick zone has stopped on the way, while the pressure changed."""
    last, top = point.last, point.memory.top
    if last is None or top is None or before.loads.normal == point.loads.normal:
        return False
    state = contacts.first_loading(point.loads.normal, top.thickness, True)
    zones = [(lo, hi, sign * last.sign) for lo, hi, sign in state.slipped]
    if len(zones) != 2 or zones[0][2] == zones[1][2]:
        return False
    step, f = LoadStep(contacts, before.loads, point.loads), contacts.scene.friction
    rates = Rates.solved((state.contact[:2],), state.stick, zones, step.rates, friction=f)
    return bool((rates.signed_K < 0.0).any())


def _advancing(contacts: Followable, point: TurningPoint) -> bool:
    """Whether the zones of slip in two directions have only grown on the way to a point."""
    depth, _ = point.memory.deepest
    return contacts.first_loading(point.loads.normal, depth, True).advancing


def _layered(contacts: Followable, before: TurningPoint, loads: Loads) -> TurningPoint:
    """The turning point after a step that layers answer. Raises NotLayered where they do not."""
    memory = before.memory
    level, shear = contacts.level(loads), contacts.shear(loads)
    rise, pull = simple(level - memory.level), simple(shear - memory.total)
    if abs(pull) <= 4.0 * EPS * max(abs(shear), abs(memory.total)):
        pull = 0.0
    if not pull and memory.top is None:
        return TurningPoint(loads, LoadMemory(level))  # nothing was ever sheared
    if not (rise or pull):
        return replace(before, loads=loads, slips=())
    step = Step(contacts, before, loads, rise, pull)
    top = memory.top
    if not rise and (top is None or (before.straight and in_proportion(pull, top.depth))):
        return step.in_proportion()
    if before.turned and before.straight:
        step.refuse_retreat()
    tilted = rise.imag or pull.imag or (rise.real < 0.0 and isinstance(memory.total, complex))
    if not (before.turned or tilted):
        return step.upright()
    if before.loads.P == 0.0:
        raise NotLayered("the contact grows from nothing while bulk stress or tilt changes")
    if step.bared < 1.0:
        between = TurningPoint(before.loads.towards(loads, step.bared), step.without_top())
        return stepped(contacts, replace(between, turned=before.turned, straight=False), loads)
    return step.general()
