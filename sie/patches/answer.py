"""Contact in several patches as the answer to a scene: edges, pressure, gap, certificate."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.contact.known_contact import Edges, not_one_patch, refuse_narrow
from sie.errors import ContactError, LoadError
from sie.numerics.interval import Interval

from .certificate import certificate, unseen
from .density import PatchPressure
from .full import FullContact, full_contact
from .gap import gap, gap_volume
from .of_scene import Problem, problem_of
from .operator import Found, Operator
from .solver import contact

if TYPE_CHECKING:
    from sie.problem.scene import Scene
    from sie.profiles.base import Profile
    from sie.profiles.slope import Slope

    from .result import PatchCertificate

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SeveralPatches:
    """The found patches, with the outermost edges, loads and tilt as of one contact.

    edges      of the outermost two edges, and load, moment and tilt of all patches
    pressure   on all of them
    notes      sentences on the profile
    """

    edges: Edges
    pressure: PatchPressure = field(compare=False, repr=False)
    problem: Problem = field(compare=False, repr=False)
    found: Found = field(compare=False, repr=False)
    notes: tuple[str, ...] = ()
    symmetric: bool = False

    def slope(self, profile: Profile) -> Slope:
        return profile.pieces.tilted(self.edges.tilt)

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        return self.pressure.patches

    def gap(self, x: Array) -> Array:
        """The gap at x (1-d), also beyond the window in which contact was sought."""
        o, (lo, hi), domain = self.found.operator, self.window, self.problem.domain
        inside = x[np.isfinite(x) & (x >= domain[0]) & (x <= domain[1])]
        first, last = float(inside.min(initial=lo)), float(inside.max(initial=hi))
        if (first < lo or last > hi) and not self.problem.chord.periodic:
            o = Operator(o.patches, self.problem.pieces((min(first, lo), max(last, hi))), o.Y)
        return gap(o, x)

    @property
    def window(self) -> tuple[float, float]:
        return self.found.operator.pieces.domain

    @cached_property
    def moment(self) -> float:
        """The moment of the pressure about x = 0; of a periodic contact that of one period."""
        return self.pressure.moment if math.isnan(self.edges.moment) else self.edges.moment

    @property
    def gap_volume(self) -> float:
        return gap_volume(self.found.operator)

    def certificate(self, tol: float) -> PatchCertificate:
        missed = unseen(self.found, self.problem)
        height = self.problem.profile.height
        found = certificate(self.found, self.pressure, height, tol, missed)
        return replace(found, notes=found.notes + self.notes)


OUT_OF_RANGE = f"the search for the patches left the range of doubles: {arguments.REMEDY}"
MOST_STEEP = 1e250  # of the load over E*/2 and the square of a width


def several_patches(scene: Scene) -> SeveralPatches | FullContact:
    """The contact of a scene in several patches.

    Raises ContactError where no patches are certified, or the scene asks for what is not covered.
    """
    _refuse_uncovered(scene)
    try:
        with np.errstate(all="ignore"):  # what that leaves is no certified contact
            problem = problem_of(scene)
            found = whole(problem, scene) or answered(problem, contact(problem), scene)
    except np.linalg.LinAlgError:
        raise LoadError(
            "the conditions of the edges became singular on the way to this load, as they are "
            "where patches merge: change the load a little"
        ) from None
    except ArithmeticError:
        raise LoadError(OUT_OF_RANGE) from None
    if isinstance(found, SeveralPatches):
        refuse_narrow(*max(found.patches, key=lambda patch: patch[1] - patch[0]))
        # The certificate forms p/root at distances down to rounding from the narrowest edges.
        narrowest = min(x2 - x1 for x1, x2 in found.patches)
        if not found.problem.given.load < MOST_STEEP * narrowest * narrowest:
            raise LoadError(OUT_OF_RANGE)
    return found


def whole(problem: Problem, scene: Scene) -> FullContact | None:
    """Full contact of a periodic profile under a load, if that is the answer."""
    if not problem.chord.periodic:
        return None
    G, start, period = 0.5 * scene.Estar, problem.domain[0], problem.chord.period
    return full_contact(
        problem.pieces((start, start + period)), start, period, G, G * problem.given.load
    )


def answered(problem: Problem, found: Found, scene: Scene) -> SeveralPatches:
    state, P, G = found.state, found.state.patches, 0.5 * scene.Estar
    pressure = PatchPressure(found.operator, G, state.tilt, G * problem.given.load)
    singular = (-float(state.charge[0]), float(state.charge[-1]))
    moment = scene.moment
    if moment is None:  # of a period it takes as long as the search, and few ask for it
        moment = math.nan if P.chord.periodic else pressure.moment
    assert scene.normal_load is not None
    edges = Edges(
        Interval(float(P.a[0]), float(P.b[-1])),
        scene.normal_load,
        moment,
        state.tilt,
        (bool(state.sharp[0]), bool(state.sharp[-1])),
        G * singular[0],
        G * singular[1],
        0.0,
        found.steps,
    )
    profile = scene.profile
    notes = (profile.joint,) if profile.joint else ()
    return SeveralPatches(edges, pressure, problem, found, notes)


def _refuse_uncovered(scene: Scene) -> None:
    if scene.half_width is not None:
        raise not_one_patch(scene)
    if scene.epsilon or scene.bonded:
        what = "bonded surfaces" if scene.bonded else "dissimilar bodies that slide"
        raise ContactError(
            f"{what} on several patches of contact are not covered: set friction = 0, or dundurs "
            "= 0"
        )
    if scene.profile.period < np.inf and (scene.moment is not None or scene.tilt != 0.0):
        raise ContactError("a periodic profile keeps level: leave out tilt and moment")
