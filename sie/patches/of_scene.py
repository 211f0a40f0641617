"""The problem of a scene in units of E*/2, and the window in which its contact is looked for.

A problem is a profile, a load, and a tilt or a moment, which many tilts may lead to. It may have
no answer. Beyond the end of a trace nothing is known. And doubles of h tell no difference of two
depths below their rounding: where a load is so light that such a difference decides which valleys
touch, or how they share it, there is no answer. Nor is there one where two patches are about to
merge, and the search for them does not come to rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.contact.known_contact import refuse_end
from sie.contact.window import reach_of_load
from sie.errors import LoadError
from sie.numerics.chord import Chord
from sie.profiles.look import closer, falls, may_touch, values
from sie.profiles.of_profile import of_profile

from .start import Grid, grid_pressure
from .state import Effort, Given

if TYPE_CHECKING:
    from sie.problem.scene import Scene
    from sie.profiles.base import Profile
    from sie.profiles.pieces import Pieces
    from sie.profiles.slope import Slope

    from .operator import Found
    from .panels import Patches
    from .state import State


Array = NDArray[np.float64]

TOLERANCE = 1e-15  # to which functions are resolved
NARROWEST = 0.02  # of the window: what contact takes at least of a window that fits ...
# ... where the slope is resolved to rounding of its largest value there
FITTED = 0.18
COARSE = 512  # cells of the grid on which the window is sought
WINDOWS = 200
# lengths, and places on each side, at which a function without ends is looked at; beyond the last
# of them at which it falls valleys are looked for so many times as far
SCALES, PLACES, BEYOND = (1e-6, 1e9), 6000, 4.0
WIDER = 4.0  # windows that are added at an end
# of the load times the window: so near to the moment the tilt is found from there
NEARLY = 1e-3
DOUBLED, HALVED = 60, 24  # times that a step of the tilt is
WIDENED = 12  # times a window is widened, before the slope is said to rise too little
UNKNOWN = 1e-4  # part by which the rounding of h may change the load of a patch


@dataclass(frozen=True, eq=False)
class Problem:
    """A profile, the load, tilt or moment, and what the search has taken so far.

    `load` is P as it was given, which messages name.
    """

    profile: Profile
    given: Given
    load: float
    effort: Effort = field(default_factory=Effort)
    _known: dict[tuple[float, float], Pieces] = field(default_factory=dict)
    _grids: dict[tuple[float, tuple[float, float], int], Grid] = field(default_factory=dict)

    @property
    def slope(self) -> Slope:
        return self.profile.pieces

    @property
    def by_slope(self) -> bool:
        """Whether the slope is a function, and its height costs more."""
        return bool(self.slope.functions)

    @property
    def domain(self) -> tuple[float, float]:
        return self.slope.domain

    @property
    def chord(self) -> Chord:
        return Chord(self.profile.period)

    def pieces(self, window: tuple[float, float], cuts: Array | None = None) -> Pieces:
        """The slope without tilt, its functions resolved on a window between some cuts."""
        if cuts is not None:
            return of_profile(self.profile, window, TOLERANCE, cuts)
        if window not in self._known:
            self._known[window] = of_profile(self.profile, window, TOLERANCE)
        return self._known[window]

    def grid(self, tilt: float, window: tuple[float, float], cells: int) -> Grid:
        """The pressure on a grid of the window, at a tilt."""
        asked = tilt, window, cells
        if asked not in self._grids:
            height, load = self._tilted(tilt, window), self.given.load
            self._grids[asked] = grid_pressure(height, window, cells, load, self.chord.periodic)
        return self._grids[asked]

    def _tilted(self, tilt: float, window: tuple[float, float]) -> Callable[[Array], Array]:
        """The function h + tilt x on the window, up to a constant."""
        if not self.by_slope:
            return lambda x: self.profile.height(x) + tilt * x
        pieces = self.pieces(window)
        return lambda x: np.where(
            pieces.void[pieces.locate(x)],
            np.inf,
            pieces.rises(np.full(x.shape, window[0]), x) + tilt * x,
        )


def problem_of(scene: Scene) -> Problem:
    G = 0.5 * scene.Estar
    moment = None if scene.moment is None else scene.moment / G
    assert scene.normal_load is not None
    P = scene.normal_load
    return Problem(scene.profile, Given(P / G, scene.tilt, moment), P)


# -- the window and the tilts ---------------------------------------------------------------------


def fitted_window(problem: Problem) -> tuple[float, float]:
    """The interval of possible contact: the domain, or a part of it found on a coarse grid."""
    if problem.chord.periodic:
        return problem.domain[0], problem.domain[0] + problem.chord.period
    lo, hi = _first_window(problem)
    # the contact gets to the load by a tilt, and possibly by another indenter than the lowest
    centre = None
    if problem.given.moment is not None:
        centre = problem.given.moment / problem.given.load
        size = hi - lo
        lo = max(min(lo, centre - size), problem.domain[0]) if centre < lo else lo
        hi = min(max(hi, centre + size), problem.domain[1]) if centre > hi else hi
    fitted = problem.by_slope and centre is None
    widened, narrowest = 0, FITTED if fitted else NARROWEST
    for _ in range(WINDOWS):
        grid = problem.grid(problem.given.tilt, (lo, hi), COARSE)
        x = grid.x[grid.p > 0.0]
        a, b = x[0] - 0.5 * grid.dx, x[-1] + 0.5 * grid.dx
        left, right = (
            a - lo < 2.0 * grid.dx and lo > problem.domain[0],
            hi - b < 2.0 * grid.dx and hi < problem.domain[1],
        )
        if left or right:
            widened += 1
            if widened > WIDENED:
                break
            lo, hi = (lo - 2.0 * (hi - lo) if left else lo), (hi + 2.0 * (hi - lo) if right else hi)
            lo, hi = max(lo, problem.domain[0]), min(hi, problem.domain[1])
            continue
        if b - a >= narrowest * (hi - lo) or not a <= (b if centre is None else centre) <= b:
            return lo, hi
        lo, hi = max(lo, a - 2.0 * (b - a)), min(hi, b + 2.0 * (b - a))
    raise LoadError(
        f"the load {problem.load:.6g} makes contact reach beyond [{lo:.6g}, {hi:.6g}]: the slope "
        "rises too little, give a domain"
    )


def _first_window(problem: Problem) -> tuple[float, float]:
    """The domain where it is bounded.

    Otherwise the window extends about the breaks as far as the slope has to rise to carry the load.
    """
    lo, hi = problem.domain
    if np.isfinite(lo) and np.isfinite(hi):
        return lo, hi
    breaks = np.asarray(problem.profile.breaks)
    finite = breaks[np.isfinite(breaks)]
    first, last = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    tilted = problem.slope.tilted(problem.given.tilt)
    size = max(reach_of_load(tilted, problem.given.load, first, last), default=1.0)
    return max(lo, first - 4.0 * size), min(hi, last + 4.0 * size)


def whole_window(problem: Problem) -> tuple[float, float]:
    """An interval that holds all valleys of the profile: its domain, or of a function a part.

    A function without ends is looked at from place to place, at least as far as its breaks and as
    the load needs, and four times as far as it falls outwards.
    """
    lo, hi = problem.domain
    if problem.chord.periodic:
        return lo, lo + problem.chord.period
    if not problem.by_slope or (np.isfinite(lo) and np.isfinite(hi)):
        return lo, hi
    first, last = _first_window(problem)
    middle = 0.5 * (first + last)
    distance = np.geomspace(SCALES[0], SCALES[1], PLACES)
    ends = []
    for side, end, limit in ((-1.0, first, lo), (1.0, last, hi)):
        away = distance[distance <= side * (limit - middle)]

        def outward(away: Array, side: float = side) -> Array:
            return side * (values(problem.slope, middle + side * away) + problem.given.tilt)

        away = closer(away, falls(outward(away)))
        H = outward(away)
        low = np.flatnonzero(may_touch(away, H, NARROWEST * (last - first), problem.given.load))
        falling = np.flatnonzero((H[:-1] <= 0.0) | falls(H))
        fallen = away[falling[falling <= low.max(initial=0)]]
        reach = max(abs(end - middle), BEYOND * float(fallen.max(initial=0.0)))
        ends.append(min(max(middle + side * reach, lo), hi) if np.isinf(limit) else limit)
    return ends[0], ends[1]


def widened(P: Patches, problem: Problem, window: tuple[float, float]) -> tuple[float, float]:
    """A wider window where contact reaches the end of this one, and the indenter goes on."""
    (lo, hi), (first, last) = window, problem.domain
    more = WIDER * (hi - lo)
    if problem.chord.periodic:
        return window
    return (
        max(lo - more, first) if P.a[0] == lo else lo,
        min(hi + more, last) if P.b[-1] == hi else hi,
    )


def levels(problem: Problem, window: tuple[float, float]) -> tuple[float, float]:
    """The tilts between which the load has the given moment, on a coarse grid.

    M falls as the tilt grows. They are the same where one has it nearly.
    """
    load, wanted, (lo, hi) = problem.given.load, problem.given.moment, window
    assert wanted is not None
    nearly = NEARLY * load * (hi - lo)

    def excess(tilt: float) -> float:
        grid = problem.grid(tilt, window, COARSE)
        return float((grid.p * grid.x).sum() * grid.dx) - wanted

    now = excess(0.0)
    if abs(now) <= nearly:
        return 0.0, 0.0
    sign = np.sign(now)
    near, far = 0.0, sign * load / (hi - lo)
    for _ in range(DOUBLED):
        now = excess(far) * sign
        if now <= 0.0:
            break
        near, far = far, 2.0 * far
    for _ in range(HALVED):
        if abs(now) <= nearly:
            return (near, near) if now > 0.0 else (far, far)
        middle = 0.5 * (near + far)
        now = excess(middle) * sign
        near, far = (middle, far) if now > 0.0 else (near, middle)
    return near, far


# -- what is not known of an indenter --------------------------------------------------------------


def refuse_unknown_ends(state: State, problem: Problem) -> None:
    """Raises LoadError where contact reaches an end beyond which the indenter is not known."""
    if problem.chord.periodic:
        return
    edges = state.patches.edges[[0, -1]].tolist()
    for side, (edge, end) in enumerate(zip(edges, problem.domain, strict=True)):
        if edge == end:
            refuse_end(problem.profile, side)


def refuse_light(found: Found, problem: Problem) -> None:
    """Raises LoadError where the rounding of h decides which valleys touch, or what they carry."""
    P, seen, load = found.state.patches, found.findings, found.given.load
    shared = max(P.unknown_share(found.operator.pieces, load), seen.doubt / load)
    if shared > UNKNOWN:
        near = f"whether x = {seen.place:.6g} touches, or " if seen.doubt > UNKNOWN * load else ""
        raise LoadError(
            f"under normal_load = {problem.load:.6g} the rounding of h decides {near}what each "
            f"valley carries, to a part of {shared:.2g}: raise the load",
        )


def unsettled(problem: Problem, patches: int) -> LoadError:
    """The refusal of a load under which the search does not come to rest."""
    other = problem.given.moment is not None
    return LoadError(
        f"the patches of contact do not settle at normal_load = {problem.load:.6g}: two "
        "of them are about to merge, or one to appear; change the load"
        f"{' or the moment' * other} a little",
        patches=patches,
    )
