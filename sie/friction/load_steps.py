"""The steps of a load path one after the other, and those of a steady cycle.

At constant P and tilt, with Q and σ in one proportion since nothing was sheared, layers answer
(`friction.memory`). All other steps are followed part by part (`friction.course`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from typing import Any, Protocol, TypeVar

from sie.errors import ContactError
from sie.numerics.graded_panels import Pieces
from sie.numerics.interval import EPS, Interval
from sie.problem.coverage import refuse_sliding
from sie.problem.load_path import Path
from sie.problem.scene import Scene
from sie.progress_bar import counted

from .finite_step import Part
from .loading import Contacts, Loads, LoadStep, contact_under
from .memory import LoadMemory, SlippedLayer, in_proportion, simple
from .onset import Motion, onset
from .slip import Slip
from .state import State, alike

Result = TypeVar("Result")

ROUNDED = 4.0 * EPS  # of S: less is no change of it
SHARES = (0.0, 0.05, 0.25, 0.5, 0.75, 1.0)  # of a step at which it is tested that all sticks
SLIDES, STICKS = 1e-14, 1e-9  # of f P, that Q is below it: where nothing sticks, and where little
SAME = 1e-7  # of a contact: so much alike are the stick zones at both turning points of a cycle
UNSTEADY = (
    "the steady state is not that of one permanent stick zone which both ends of the slip reach at "
    "once, which is all that is covered; change P, Q, σ and tilt in other proportions"
)


@dataclass(frozen=True)
class TurningPoint:
    """A turning point of a path.

    loads       the loads there
    memory      the layers there, where P and the tilt have not changed since S was 0
    sign        that of the slip since the last turning point
    slipped     the layers that it overwrote, from the top down
    turned      whether slip has opposite signs at the two edges
    parts       the parts of the last step in the order of time, where no layers answer it
    step        that step
    slides      that at its end, if |Q| = f P there: all sticks again; the parts end just before
    why         why they do not
    """

    loads: Loads
    memory: LoadMemory = field(default_factory=LoadMemory)
    sign: float = 1.0
    slipped: tuple[SlippedLayer, ...] = ()
    turned: bool = False
    parts: tuple[Part, ...] = ()
    step: LoadStep | None = None
    slides: State | None = None
    why: str = ""

    @property
    def state(self) -> State:
        """What the next step starts from."""
        return self.slides or self.parts[-1].state


class Followable(Contacts, Protocol):
    """The contacts of a path that is followed.

    shear           S
    arm             the length by which a bulk stress is made a force
    in_one_patch    whether the contact is one patch under every load
    contact         the contact under loads, in one patch
    first_loading   the state of a contact that was never sheared before S rose to a depth
    in_parts        the turning point after a step that no layers answer
    followed        the same from any state
    plain           the solution under P and a tilt, without shear
    shift_of_step   the shift that slip adds in one step
    """

    turning_points: tuple[TurningPoint, ...]

    @property
    def period(self) -> float: ...

    def shear(self, loads: Loads) -> complex: ...
    @property
    def arm(self) -> float: ...
    @property
    def in_one_patch(self) -> bool: ...
    def contact(self, loads: Loads) -> Interval: ...
    def first_loading(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def in_parts(self, before: TurningPoint, loads: Loads) -> TurningPoint: ...
    def followed(self, start: State, first: Loads, loads: Loads) -> TurningPoint: ...
    def plain(self, P: float, turn: float) -> Any: ...
    def shift_of_step(self, index: int) -> float: ...


def turning_points(scene: Scene, path: Path, contacts: Followable) -> tuple[TurningPoint, ...]:
    """The points of a path that is followed from P and the tilt alone.

    Raises ContactError, with the step, where one is not covered.
    """
    f = scene.friction
    found: list[TurningPoint] = []
    points = loads_of(path)
    for k, loads in enumerate(points):
        if f == 0.0 and loads.Q != 0.0:
            raise ValueError(
                f"Q of point {k} = {loads.Q:g} without friction: a frictionless contact carries "
                "none; give friction > 0"
            )
        if abs(loads.Q) > f * loads.P:
            named(k, loads, partial(refuse_sliding, f, loads.P, loads.Q))
    state = TurningPoint(points[0]._replace(Q=0.0, sigma=0.0))
    for k, loads in counted("load path", enumerate(points), len(points)):
        repeated = _repeated(found, loads)
        state = repeated or named(k, loads, partial(stepped, contacts, state, loads))
        found.append(state)
    return tuple(found)


def _repeated(found: list[TurningPoint], loads: Loads) -> TurningPoint | None:
    """The point after an earlier step between the same loads, if q was then what it is now."""
    for before, after in pairwise(found):
        same = (before.loads, after.loads) == (found[-1].loads, loads)
        if same and before.parts and after.parts and alike(before.state, found[-1].state):
            return after
    return None


def loads_of(path: Path) -> list[Loads]:
    return [Loads(*point, turn) for point, turn in zip(path.points, path.turns, strict=True)]


def points_of_loads(path: Path) -> tuple[TurningPoint, ...]:
    """The points of a path at which nothing has to be remembered."""
    return tuple(TurningPoint(loads) for loads in loads_of(path))


def named(
    k: int, loads: Loads, step: Callable[[], Result], place: str = "step {} of the path, to"
) -> Result:
    try:
        return step()
    except ContactError as problem:
        raise type(problem)(
            f"{place.format(k)} {loads}: {problem}", **problem.reached | {"step": k}
        ) from None


def stepped(contacts: Followable, before: TurningPoint, loads: Loads) -> TurningPoint:
    """The turning point after a step: by layers, and where these do not answer part by part.

    Raises ContactError where the step is not covered.
    """
    same, memory = before.loads.normal == loads.normal, before.memory
    if before.parts:
        last = before.state.contact
        if same and contacts.sheared_by(loads) == (last.Q, last.tau):
            return replace(before, loads=loads)
        return replace(contacts.in_parts(before, loads), why="a step before was")
    shear = contacts.shear(loads)
    pull = simple(shear - memory.total)
    if abs(pull) <= ROUNDED * max(abs(shear), abs(memory.total)):
        pull = 0.0
    if not pull and (same or not memory.layers):
        return replace(before, loads=loads, slipped=())
    why = "P or the tilt changes"
    if same:
        why = "Q and bulk stress change in another proportion"
        if not memory.layers or in_proportion(pull, memory.depth):
            point = layered(contacts, before, loads, pull)
            if point:
                return point
            why = "a zone of slip retreats on the way"
    return replace(contacts.in_parts(before, loads), why=why)


def layered(
    contacts: Followable, before: TurningPoint, loads: Loads, pull: complex
) -> TurningPoint | None:
    """The point after S has changed by `pull`, in proportion; None if slip zones retreat.

    Where the bulk stress pulls the edges in opposite directions, that is seen by first loadings.
    """
    if pull.imag and not contacts.in_one_patch:
        return None
    turned = bool(pull.imag) and (
        math.pi * contacts.contact(loads).r * abs(pull.imag) > contacts.arm * abs(pull.real)
    )
    sign = math.copysign(1.0, pull.imag if turned else pull.real)
    memory, slipped = before.memory.changed(sign * pull, sign)
    depths = [depth for depth, _ in memory.corners] if turned else []
    if not all(contacts.first_loading(loads.normal, d, True).advancing for d in depths):
        return None
    return TurningPoint(loads, memory, sign, slipped, turned)


# -- steady cycles ---------------------------------------------------------------------------------


def steady_points(scene: Scene, path: Path, contacts: Followable) -> tuple[TurningPoint, ...]:
    """The turning points A, B, A of a steady cycle.

    What slips in one direction on the way to B slips back on the way to A. Hence q_A - q_B =
    s f (p_A + p_B) there, s the sign of slip before A, and what is locked in where nothing slips
    does not matter. At constant P and tilt that is slip to a depth of (S_A - S_B)/2. Otherwise the
    cycle is followed from q = s f p all over to B, and from q = -s f p to A; the stick zones are
    the same if the state is steady.
    """
    first, second, _ = loads_of(path)
    for k, loads in enumerate((first, second)):
        slides = partial(refuse_sliding, scene.friction, loads.P, loads.Q)
        named(k, loads, slides, f"the cycle at {'AB'[k]},")
    start, end = TurningPoint(first), TurningPoint(second)
    pull = simple(contacts.shear(second) - contacts.shear(first))
    found = _at_constant_pressure(contacts, start, second, pull) if pull else None
    if found:
        return found
    if (first.normal == second.normal and not pull) or all_sticks(contacts, first, second):
        return start, end, start
    s = -math.copysign(1.0, pull.real)
    points = [start]
    for k, (begin, to, sign) in enumerate(((first, second, s), (second, first, -s)), 1):
        slid = sheared_all_over(contacts, begin, sign * scene.friction * begin.P)
        there = partial(contacts.followed, slid, begin, to)
        points.append(named(k, to, there, f"the cycle on the way to {'ABA'[k]},"))
    named(1, second, partial(_refuse_unsteady, points[1:], s), "the cycle on the way to B,")
    return tuple(points)


def _at_constant_pressure(
    contacts: Followable, start: TurningPoint, second: Loads, pull: complex
) -> tuple[TurningPoint, ...] | None:
    """The points at constant P and tilt, if layers answer them."""
    if start.loads.normal != second.normal:
        return None
    there = layered(contacts, start, second, pull)
    half = layered(contacts, start, second, 0.5 * pull)
    if there is None or half is None:
        return None
    s = -there.sign
    memory, _ = LoadMemory().changed(-0.5 * s * pull, s)
    found = [replace(start, memory=memory, turned=there.turned)]
    for sign, loads in ((-s, second), (s, start.loads)):
        memory, slipped = found[-1].memory.changed(-s * pull, sign)
        found.append(TurningPoint(loads, memory, sign, slipped, there.turned))
    return tuple(found)


def all_sticks(contacts: Followable, first: Loads, second: Loads) -> bool:
    """Whether nothing slips between two loads: the contact grows and sticks at all edges."""
    small, large = sorted((first, second), key=lambda loads: loads.P)
    step = LoadStep(contacts, small, large)
    f = contacts.scene.friction
    return all(
        end.motion is Motion.GROWS
        for share in SHARES
        for end in onset(State.untouched(step.at(share)), step.rates, f).ends
    )


def nearly_sliding(f: float, start: Loads, end: Loads) -> Loads:
    """The loads at the end of a step, or where next to nothing sticks if there nothing does.

    Nothing slips where Q grows with f P. Raises ContactError where the bodies slide all the way.
    """
    slips = abs(end.Q - start.Q) > f * (end.P - start.P) * (1.0 + SLIDES)
    if not slips or abs(end.Q) <= (1.0 - SLIDES) * f * end.P:
        return end
    if start.Q * end.Q > 0.0 and abs(start.Q) > (1.0 - SLIDES) * f * start.P:
        raise ContactError(
            "|Q| is f P at the start and at the end, and P falls: the bodies slide all the way; "
            f"begin or end the step below it, as at Q = {0.999 * end.Q:.6g}"
        )
    return end._replace(Q=math.copysign((1.0 - STICKS) * f * end.P, end.Q))


def sheared_all_over(contacts: Contacts, loads: Loads, Q: float) -> State:
    """The state in which q is in proportion to p and carries Q, and all sticks."""
    contact = contact_under(contacts, loads)
    share = Q / (contacts.scene.friction * loads.P)
    q = Pieces(contact.limit.ends, share * contact.limit.series)
    return State(contact, contact.patches, (), q)


def _refuse_unsteady(found: list[TurningPoint], s: float) -> None:
    """Refuse stick zones that are not the same at both points, and slip in two directions."""
    there, back = (point.state for point in found)
    room = SAME * there.contact.width
    ways = {sense for *_, sense in there.slip} == {-s} and {sense for *_, sense in back.slip} == {s}
    alike = len(there.stick) == len(back.stick) and all(
        abs(a - b) <= room
        for one, other in zip(there.stick, back.stick)
        for a, b in zip(one, other)
    )
    if not (ways and alike):
        raise ContactError(UNSTEADY)
