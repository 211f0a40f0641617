"""The answer: a lazy view over the stages. Nothing is computed until it is asked for, and `vars(solution)` shows what was."""

from __future__ import annotations

from collections.abc import Collection
from contextlib import suppress
from dataclasses import fields, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import arguments
from .cauchy.density import JacobiDensity
from .certificate.coupled_check import coupled_certificate
from .certificate.pressure_check import (
    RETREAT,
    Certificate,
    certificate,
    slope_rises,
    verify_inequalities,
)
from .certificate.shear_check import shear_certificate
from .certificate.trace_noise import TraceReport, trace_reports
from .contact.edges import Edges
from .contact.gap import gap
from .contact.normal import ECONOMY, Normal, normal_contact, pressure
from .errors import ContactError, LoadError
from .friction.coupled_contact import CoupledContact, coupled_contact, refuse_unsolved
from .friction.coupled_traction import CoupledTraction
from .friction.full_stick import Component, bonded_certificate, bonded_contact
from .friction.partial_slip import refuse_sliding, sheared, slip
from .friction.states import Slip, Step
from .problem.material import Elastic
from .problem.scene import Scene, refuse_no_scene
from .profiles.sampled import explained, traces_in
from .profiles.slope import Slope
from .stress.half_plane import Stress, Tractions
from .stress.yield_limit import Criterion, Peak, YieldPoint, elastic_limit, peak_tension
from .traction.base import ZERO, Density, on_line, zero_or_nan
from .traction.combination import scaled
from .traction.of_slope import SlopeDensity

Array = NDArray[np.float64]

_SCENE_FIELDS = frozenset(f.name for f in fields(Scene))
# What each stage depends on: `with_` keeps a stage whose fields of the scene stay the same.
_NORMAL_FIELDS = frozenset(
    {
        "profile",
        "body",
        "indenter",
        "modulus",
        "normal_load",
        "half_width",
        "tilt",
        "moment",
        "epsilon",
        "bonded",
        "coupled",
    }
)
# Fractions of a load that cannot be carried, at which a profile is looked at for a second patch of contact.
LIGHTER = (0.1, 1e-3)
_SHEAR_FIELDS = _NORMAL_FIELDS | {
    "friction",
    "tangential_load",
    "sliding",
    "bulk_stress",
    "dundurs",
}
# The nearest contact of dissimilar bodies that is covered: E*, the bodies' shares of it and their constants stay.
NEGLECTED = "give dundurs = 0 (in a scene file, under [pair]) to neglect β alone, which changes tractions by a part of about β"
_STAGES = dict.fromkeys(("normal", "pressure", "inequalities"), _NORMAL_FIELDS)
_STAGES |= dict.fromkeys(("bonded", "coupled", "tangential", "certificate"), _SHEAR_FIELDS)


class Solution:
    """What a scene answers; see `solve`. Lengths, stresses and loads in the scene's units.

    edges        (x1, x2)              half_width, centre, normal_load, moment, tilt        floats
    pressure     Density: pressure(x), .resultant, .moment, .cauchy(z, side), .hilbert(x)
    shear        Density: the shear traction q;  stick: tuple of (lo, hi), () in full sliding;  slip(x), energy_lost, shift
    gap(x)       the gap between the deformed bodies, 0 in contact
    stress(x, y), surface_stress(x)             Stress in the body, y >= 0 the depth
    elastic_limit(), peak_tension()             YieldPoint, Peak: where it yields first, and the largest tension of the surface
    check()      Certificate
    trace_reports()     a TraceReport for each measured trace, with the error that its noise implies
    notes        sentences on what the equations leave out here: large slopes and pressures, zones
                 of slip that would retreat
    with_(...)   a new Solution of a changed scene, which keeps the stages that cannot have changed

    Asking raises ContactError where the scene has no answer that the package covers.
    """

    def __init__(
        self, scene: Scene, tol: float = 1e-13, economy: Collection[str] = ECONOMY
    ) -> None:
        self.scene = scene
        self.tol = tol
        self.economy = frozenset(economy)

    # -- stages -------------------------------------------------------------------------------------------------------

    @cached_property
    def normal(self) -> Normal:
        """Edges, load, moment and tilt. A profile that may not be convex is verified at once, and so fills two more stages."""
        if self.scene.bonded:
            return Normal(self.bonded[0], False)
        if self.scene.coupled:
            return Normal(self.coupled[0], True)
        try:
            return self._one_patch()
        except ContactError as error:
            raise explained(error, self.scene.profile) from None

    def _one_patch(self) -> Normal:
        try:
            found = normal_contact(self.scene, self.tol, self.economy)
        except LoadError:
            self._look_for_a_second_patch()
            raise
        if self._may_not_be_convex:
            self.__dict__["pressure"] = self._verified(self.scene, found)
            self.__dict__["inequalities"] = True
        return found

    @cached_property
    def bonded(self) -> tuple[Edges, JacobiDensity]:
        """Of a bonded punch: its edges, and p + i q."""
        return bonded_contact(self.scene, self.tol)

    @cached_property
    def coupled(self) -> tuple[Edges, CoupledContact]:
        """The edges and the state of dissimilar bodies in partial slip."""
        return coupled_contact(self.scene, self.tol)

    @property
    def normal_and_shear(self) -> JacobiDensity:
        """p + i q of a bonded punch."""
        _ = self.normal
        return self.bonded[1]

    @property
    def _may_not_be_convex(self) -> bool:
        return not (self.scene.profile.convex and "convexity" in self.economy)

    def _verified(self, scene: Scene, found: Normal) -> SlopeDensity:
        density = pressure(found, scene, self.tol, self.economy)
        slope = found.slope(scene.profile)
        rises = found.series is not None or slope_rises(density, slope)
        if not ("convexity" in self.economy and rises):
            verify_inequalities(density, slope)
        return density

    def _look_for_a_second_patch(self) -> None:
        """Where no patch carries the load, a lighter load may show why: InequalityError if it does.

        Of a trace the reason is known, and a rough one is expensive to search.
        """
        if (
            not self._may_not_be_convex
            or self.scene.normal_load is None
            or any(traces_in(self.scene.profile))
        ):
            return
        for fraction in LIGHTER:
            scene = replace(self.scene, normal_load=fraction * self.scene.normal_load)
            with suppress(LoadError):
                self._verified(scene, normal_contact(scene, self.tol, self.economy))

    @cached_property
    def pressure(self) -> SlopeDensity | Component | CoupledTraction:
        """The contact pressure p(x)."""
        if self.scene.bonded:
            return Component(self.normal_and_shear, imaginary=False)
        if self.scene.coupled:
            _ = self.normal
            return self.coupled[1].tractions[0]
        normal = self.normal
        verified: SlopeDensity | None = self.__dict__.get("pressure")
        return verified or pressure(normal, self.scene, self.tol, self.economy)

    @property
    def _loads(self) -> tuple[float, float]:
        return self.tangential_load, self.scene.tau if self.scene.friction else 0.0

    @property
    def sheared(self) -> bool:
        """Whether there is friction, and a load that shears, and not pressure and shear are one problem."""
        return sheared(self.scene, self.economy) and not (self.scene.epsilon or self.scene.bonded)

    @property
    def carries_shear(self) -> bool:
        """Whether there is a shear traction: of partial slip, or of bodies that slide or are bonded with their pressure."""
        return self.sheared or bool(self.scene.epsilon) or self.scene.bonded or self.scene.coupled

    @cached_property
    def tangential(self) -> Slip:
        """Zones of stick and slip, and the shear."""
        return slip(
            Step(self.scene, self.normal, self.slope_density, *self._loads, self.tol, self.economy)
        )

    @cached_property
    def certificate(self) -> Certificate:
        if self.scene.bonded:
            return bonded_certificate(
                self.normal.edges, self.normal_and_shear, self.scene, self.tol
            )
        if self.scene.coupled:
            return coupled_certificate(self.coupled[1], self.scene, self.tol)
        found = certificate(self.slope_density, self._slope, self.tol)
        if not self.sheared:
            return found
        return replace(
            found,
            shear=shear_certificate(
                self.tangential, self.slope_density, self._loads, self._slope, self.tol
            ),
        )

    @property
    def slope_density(self) -> SlopeDensity:
        """The pressure where it is not that of a bonded punch."""
        return cast(SlopeDensity, self.pressure)

    @property
    def _slope(self) -> Slope:
        return self.normal.slope(self.scene.profile)

    # -- answers ------------------------------------------------------------------------------------------------------

    @property
    def edges(self) -> tuple[float, float]:
        """(x1, x2), where contact begins and ends."""
        contact = self.normal.edges.contact
        return contact.x1, contact.x2

    @property
    def half_width(self) -> float:
        return self.normal.edges.contact.r

    @property
    def centre(self) -> float:
        return self.normal.edges.contact.m

    @property
    def normal_load(self) -> float:
        """P, force per length."""
        return self.normal.edges.normal_load

    @property
    def moment(self) -> float:
        """∫ p x dx about x = 0, force (per length times length)."""
        return self.normal.edges.moment

    @property
    def tilt(self) -> float:
        """What was added to the slope of the profile."""
        return self.normal.edges.tilt

    @property
    def sharp(self) -> tuple[bool, bool]:
        """Which edges are the indenter's own corners, where the pressure is square-root singular."""
        return self.normal.edges.sharp

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones as (lo, hi): the contact where no tangential load came, () in full sliding and without friction."""
        if self.scene.epsilon:
            return ()
        if self.sheared:
            return self.tangential.stick
        if self.scene.coupled:
            return self.coupled[1].stick
        return (self.edges,) if self.scene.friction else ()

    @property
    def shear(self) -> Density:
        """The shear traction q(x), which acts on the body in +x."""
        if self.scene.bonded:
            return Component(self.normal_and_shear, imaginary=True)
        if self.scene.epsilon:
            return scaled(self.scene.slides * self.scene.friction, self.pressure)
        if self.scene.coupled:
            _ = self.normal
            return self.coupled[1].tractions[1]
        return self.tangential.shear if self.sheared else ZERO

    @property
    def tangential_load(self) -> float:
        """Q, force per length."""
        slides = self.scene.slides
        return (
            slides * self.scene.friction * self.normal_load
            if slides
            else self.scene.tangential_load
        )

    def slip(self, x: ArrayLike) -> Array:
        """Tangential displacement of the indenter relative to the body, same shape as x: 0 in stick and outside the contact.

        Where dissimilar bodies are pressed together it is counted from when a point came into contact:
        what slipped first sticks later, and keeps its slip. It has the sign of q. In full sliding: what it
        is when the last point lets go. ContactError for dissimilar bodies that slide:
        that takes their partial slip before.
        """
        self._refuse_unknown_slip()
        if self.scene.coupled:
            return self.coupled[1].relative_slip(x)
        slipped: Array = on_line(self.tangential.slip if self.sheared else np.zeros_like, x)
        return slipped

    @property
    def energy_lost(self) -> float:
        """What friction turned into heat since the normal load was applied: force (per length of the line) times length."""
        self._refuse_unknown_slip()
        if self.scene.coupled:
            return self.coupled[1].energy
        return self.tangential.energy if self.sheared else 0.0

    @property
    def shift(self) -> float:
        """How far slip lets the indenter move along x, beyond what the same loads would move it if nothing slipped.

        The rest, Q times a constant, depends on where one stands: plane elasticity leaves it undetermined (Johnson 1985, § 2.2).
        """
        self._refuse_unknown_slip()
        return self.tangential.shift if self.sheared else 0.0

    def _refuse_unknown_slip(self) -> None:
        if self.scene.epsilon:
            raise ContactError(
                f"how far dissimilar bodies (β = {self.scene.beta:.4g}) slip before they slide is a matter of partial slip, "
                "which is not covered for them yet: pressure, shear and stresses are"
            )

    # -- in the body --------------------------------------------------------------------------------------------------

    @cached_property
    def tractions(self) -> Tractions:
        """What acts on the body (y > 0), and what it is made of: all that a stress depends on."""
        scene, body = self.scene, self.scene.body
        if body is not None and not isinstance(body, Elastic):
            raise ContactError(
                "the body is rigid: its stress is not determined; give the elastic one as body and the rigid as indenter"
            )
        if body is None:
            return Tractions(self.pressure, self.shear, scene.bulk_stress, scene.poisson)
        return Tractions(
            self.pressure, self.shear, scene.bulk_stress, body.poisson, body.plane, body
        )

    def stress(self, x: ArrayLike, y: ArrayLike) -> Stress:
        """The stress at points (x, y) of the body, y >= 0 the depth: a `Stress`, whose values are arrays of the broadcast shape."""
        return Stress(self.tractions, x, y)

    def surface_stress(self, x: ArrayLike) -> Stress:
        """The stress on the surface, in the contact and beside it."""
        return self.stress(x, 0.0)

    def elastic_limit(self, criterion: Criterion = "mises") -> YieldPoint:
        """Where the body yields first, and at which load, by criterion "mises" or "tresca"; see `YieldPoint`."""
        return elastic_limit(self.tractions, self.normal_load, criterion)

    def peak_tension(self) -> Peak:
        """(value, x): the largest σ_xx on the surface, in the contact or beside it, and where."""
        return peak_tension(self.tractions)

    def gap(self, x: ArrayLike) -> Array:
        """The gap between the deformed bodies, same shape as x: 0 in contact, inf beyond the ends of the indenter."""
        x = arguments.reals("x", x)
        if self.scene.bonded:
            return np.where((x < self.edges[0]) | (x > self.edges[1]), np.inf, zero_or_nan(x))
        if self.scene.coupled:
            return self.coupled[1].gap(x, self.scene.profile)
        return gap(x.ravel(), self.slope_density, self._slope).reshape(x.shape)

    @property
    def notes(self) -> tuple[str, ...]:
        """`strain_notes` and `slip_notes`: sentences on what the equations leave out here."""
        return *self.strain_notes, *self.slip_notes

    @property
    def slip_notes(self) -> tuple[str, ...]:
        """A sentence on zones of slip that would retreat, so that the way to the loads matters."""
        if not self.sheared or self.tangential.advancing:
            return ()
        return (f"note: slip is found in total displacements: {RETREAT}",)

    @property
    def strain_notes(self) -> tuple[str, ...]:
        """Sentences on strains that are not small: a slope above 0.2, a pressure above E*/4."""
        if self.scene.bonded or self.scene.coupled or "certificate" in self.__dict__:
            return self.certificate.notes
        return certificate(self.slope_density, self._slope, self.tol).notes

    def check(self) -> Certificate:
        """The certificate of this answer, measured on points that were not used to find it."""
        return self.certificate

    def trace_reports(self) -> tuple[TraceReport, ...]:
        """The measured traces in the profile: what was done with them, and what their noise implies.

        The error of the pressure that a report states is estimated from the misfit of the spline.
        The certificate is another thing: it says how well the equations are solved for the spline
        as it is. The cost is a smoothing by cross validation; no contact is solved again.

        Returns
        -------
        tuple of TraceReport
            One for each trace, () if the profile has none.
        """
        return (
            ()
            if self.scene.bonded or self.scene.coupled
            else trace_reports(self.scene, self.normal, self.slope_density)
        )

    def with_(self, **changes: Any) -> Solution:
        """The solution of the scene with these fields changed. normal_load and half_width replace each other, so do tilt and moment."""
        for name in changes:
            if name not in _SCENE_FIELDS:
                raise ValueError(
                    f"{name} is not a field of a scene: change {', '.join(sorted(_SCENE_FIELDS))}"
                )
        for one, other in (("normal_load", "half_width"), ("tilt", "moment")):
            for given, replaced in ((one, other), (other, one)):
                if changes.get(given) is not None and replaced not in changes:
                    changes[replaced] = 0.0 if replaced == "tilt" else None
        if "modulus" in changes and self.scene.body is not None:
            changes = {"body": None, "indenter": None, "dundurs": None} | changes
        new = Solution(replace(self.scene, **changes), self.tol, self.economy)
        _refuse_uncovered(new.scene)
        changed = {
            name
            for name in (*changes, "epsilon", "bonded", "coupled")
            if getattr(new.scene, name) != getattr(self.scene, name)
        }
        if self.scene.bonded and changed & _SHEAR_FIELDS:
            changed.add("bonded")
        if self.scene.coupled and changed & _SHEAR_FIELDS:
            changed.add("coupled")
        kept = [
            stage
            for stage, needs in _STAGES.items()
            if stage in self.__dict__ and not changed & needs
        ]
        new.__dict__.update({stage: self.__dict__[stage] for stage in kept})
        return new

    def __repr__(self) -> str:
        return f"Solution({self.scene!r}, tol={self.tol!r})"


def solve(scene: Scene, tol: float = 1e-13, economy: Collection[str] = ECONOMY) -> Solution:
    """The solution of a scene, as a lazy view: nothing is computed yet.

    tol       relative accuracy asked of functions' resolution and of the certificate
    economy   what may be skipped; () computes everything, with the same answer

    >>> import sie
    >>> solution = sie.solve(sie.Scene(profile=sie.Parabola(radius=100.0), modulus=80e3, normal_load=50.0))
    >>> round(solution.half_width, 6)
    0.282095
    """
    refuse_no_scene(scene)
    tol = arguments.tolerance(tol)
    for name in arguments.listed("economy", economy, "a set of names"):
        if not arguments.among(name, ECONOMY):
            raise ValueError(f"economy {name!r} is not known: choose among {sorted(ECONOMY)}")
    _refuse_uncovered(scene)
    return Solution(scene, tol, economy)


def _refuse_uncovered(scene: Scene) -> None:
    if scene.bonded and scene.bulk_stress == 0.0:
        return
    if scene.normal_load is not None and not scene.slides:
        refuse_sliding(scene.friction, scene.normal_load, scene.tangential_load)
    if scene.beta != 0.0 and scene.bulk_stress != 0.0 and scene.friction != 0.0:
        raise ContactError(
            f"bulk_stress = {scene.bulk_stress:g} under dissimilar bodies (β = {scene.beta:.4g}) with "
            f"friction: how it shifts their zones of stick is not solved; {NEGLECTED}; or set friction = 0"
        )
    if scene.coupled:
        refuse_unsolved(scene, NEGLECTED)
