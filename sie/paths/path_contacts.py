"""The contacts of a load path, without shear and in first loading, each solved once.

The solution at each turning point, and every step between two of them, is made of contacts under
other loads: those of the path itself, those of the layers in its memory, and those on the way. A
step that no layers answer is followed part by part (`friction.course`).
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from sie.answers.sheared import Sheared
from sie.errors import ContactError, LoadError
from sie.friction.course import course
from sie.friction.load_steps import TurningPoint, nearly_sliding, sheared_all_over
from sie.friction.loading import Loads, LoadStep
from sie.friction.partial_slip import refuse_stretch
from sie.numerics.interval import EPS, Interval
from sie.patches.full import FullContact
from sie.problem.load_path import Path, unsheared

if TYPE_CHECKING:
    from sie.friction.slip import Slip
    from sie.friction.state import State
    from sie.patches.answer import SeveralPatches
    from sie.problem.scene import Scene

UNSEEN = 1e-9  # of f P: a smaller step of P is not followed part by part ...
UNTOLD = 1e-11  # ... and a smaller one at constant P
# P, and what is added to the scene's tilt or moment.
Under = tuple[float, float]


class PathContacts:
    """The contacts that the points of a load path share.

    scene      the scene of the path without shear
    path       its turning points
    tol        as in `solve`
    economy    as in `solve`
    largest    the largest P of the path
    """

    def __init__(self, scene: Scene, path: Path, tol: float, economy: Collection[str]) -> None:
        self.scene, self.path = unsheared(scene, path), path
        self.tol, self.economy = tol, frozenset(economy)
        self.largest = max(P for P, _, _ in path.points)
        self._first = path.first_contact
        self._plain: dict[Under, Sheared] = {}
        self._first_loadings: dict[tuple[Under, complex], Slip] = {}
        self._in_patches: dict[tuple[float, float], SeveralPatches | FullContact] = {}

    def solution(self, scene: Scene) -> Sheared:
        """The solution of a scene; `History` makes it one that has all answers."""
        return Sheared(scene, self.tol, self.economy)

    @cached_property
    def _tau(self) -> float:
        """τ of a unit of bulk stress."""
        return replace(self.scene, bulk_stress=1.0).tau

    @cached_property
    def arm(self) -> float:
        """The length by which bulk stress and tilt are made forces.

        It is about π times the half-width of the first contact, and a power of 2, which does not
        round.
        """
        return 2.0 ** round(math.log2(math.pi * self.plain(*self._first).half_width))

    @property
    def by_moment(self) -> bool:
        """Whether moments are added along the path, not tilts."""
        return bool(self.path.moment)

    @cached_property
    def curved(self) -> bool:
        """Whether the tilt follows from a moment that is carried at changing places."""
        path, scene = self.path, self.scene
        if not path.moment and (scene.moment is None or scene.moment == 0.0 == scene.profile.axis):
            return False
        normal = {(P, turn) for (P, _, _), turn in zip(path.points, path.turns, strict=True)}
        return len(normal) > 1

    def shear(self, loads: Loads) -> complex:
        """Q, with the strain of the bulk stress as imaginary part."""
        return complex(loads.Q, loads.sigma * self._tau * self.arm) if loads.sigma else loads.Q

    def contact(self, loads: Loads) -> Interval:
        """The contact under these loads, which is one patch."""
        return self.plain(*loads.normal).as_one_patch.edges.contact

    def plain(self, P: float, turn: float = 0.0) -> Sheared:
        """The contact under P and what is added to the scene's tilt or moment, without shear."""
        if (P, turn) not in self._plain:
            self._plain[P, turn] = self._frictionless(P, turn)
        return self._plain[P, turn]

    def pressed(self, loads: Loads) -> tuple[tuple[tuple[float, float], ...], Any]:
        """The patches and the pressure under loads; they are kept at turning points."""
        found = self._plain.get(loads.normal) or self._frictionless(*loads.normal)
        if self.in_one_patch:
            pressure = found.slope_density
            return (pressure.interval,), pressure
        return found.patches, found.in_patches.pressure

    def sheared_by(self, loads: Loads) -> tuple[float, float]:
        """Q and τ of loads."""
        return loads.Q, loads.sigma * self._tau

    def _frictionless(self, P: float, turn: float) -> Sheared:
        if P == 0.0:
            raise LoadError("the path is at P = 0 here: nothing touches; ask for a later point")
        scene = replace(self.scene, normal_load=P)
        if self.path.moment:
            scene = replace(scene, moment=(scene.moment or 0.0) + turn)
        elif turn:
            scene = replace(scene, tilt=scene.tilt + turn)
        return self.solution(scene)

    def first_loading(self, normal: Under, depth: complex, turned: bool) -> Slip:
        """The state of a contact that was never sheared after S has risen to a depth.

        `turned`: slip may have opposite directions at the two edges.
        """
        key = (normal, depth)
        if key not in self._first_loadings:
            plain = self.plain(*normal)
            f, P, Q = self.scene.friction, plain.normal_load, depth.real
            if abs(Q) >= f * P * (1.0 - 4.0 * EPS):
                Q = math.copysign(f * P, Q)
            tau = depth.imag / self.arm if depth.imag else 0.0
            found = plain.first_loading((Q, tau), self.under, one_sign=not turned)
            self._first_loadings[key] = found
        return self._first_loadings[key]

    def under(self, load: float, tilt: float) -> SeveralPatches | FullContact:
        """The contact in several patches under a load at a tilt."""
        if (load, tilt) not in self._in_patches:
            any_load = self.plain(self.largest, self._first[1])
            self._in_patches[load, tilt] = any_load.patches_under(load, tilt)
        return self._in_patches[load, tilt]

    @property
    def period(self) -> float:
        """The period of the profile, inf if it does not repeat itself."""
        return self.scene.profile.period

    @cached_property
    def in_one_patch(self) -> bool:
        """Whether the contact is one patch under every load of the path, by a slope that rises."""
        return self.plain(self.largest, self._first[1]).convex

    # -- steps followed part by part ---------------------------------------------------------------

    def followed(self, start: State, first: Loads, loads: Loads) -> TurningPoint:
        """The turning point after a step from a state, part by part."""
        if first.sigma != loads.sigma:
            refuse_stretch(self.period)
        for at in (first, loads):
            found = self.plain(*at.normal)
            if any(found.sharp):
                raise ContactError(
                    "P, the tilt or the proportion of Q and σ changes in this step, and a contact "
                    "with sharp edges is not followed through it: the shear is infinite there; "
                    "round its corners (sie.RoundedFlat)"
                )
            if isinstance(found.normal, FullContact):
                raise ContactError(
                    "P, the tilt or the proportion of Q and σ changes in this step, and full "
                    "contact is not followed through it; change Q at constant P"
                )
        almost = nearly_sliding(self.scene.friction, first, loads)
        step = LoadStep(self, first, almost, {0.0: start.contact})
        slides = None if almost is loads else sheared_all_over(self, loads, loads.Q)
        return TurningPoint(loads, parts=course(start, step), step=step, slides=slides)

    def _refuse_unseen(self, first: Loads, loads: Loads) -> None:
        """Refuse a step that rounding hides."""
        f, arm = self.scene.friction, self.scene.Estar * self.arm
        same, limit = first.normal == loads.normal, UNTOLD
        change = max(abs(self.shear(loads) - self.shear(first)), f * abs(loads.P - first.P))
        if same:
            change = max(change, abs(loads.sigma - first.sigma) / self.scene.Estar * first.P)
        else:
            before, now = (self.plain(*at.normal).tilt for at in (first, loads))
            change, limit = max(change, f * arm * abs(now - before)), UNSEEN
        if change <= limit * f * loads.P:
            raise ContactError(
                f"all loads change by less than {limit:g} of f P, which rounding hides: drop "
                "this point of the path" + ("" if same else ", or keep P and the tilt in it")
            )
