"""The contact of a scene with its shear: the stages of the work, each computed when it is read.

Similar bodies have the pressure first and the shear from it; bodies that are bonded, and dissimilar
ones in partial slip, have both from one problem.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

from sie.contact.known_contact import Edges, Normal
from sie.contact.normal import normal_contact
from sie.contact.pressure import OnePatch, pressure
from sie.errors import InequalityError
from sie.problem.coverage import held_moment, sheared
from sie.problem.scene import Scene
from sie.traction.combination import ZERO, scaled
from sie.traction.of_slope import SlopeDensity

from .frictionless import Frictionless

if TYPE_CHECKING:  # what a stage needs is imported when it is computed
    from sie.cauchy.density import JacobiDensity
    from sie.certificate.result import Certificate, ShearCertificate
    from sie.friction.coupled.answer import CoupledContact
    from sie.friction.coupled.traction import OnPieces
    from sie.friction.full_stick import Component
    from sie.friction.slip import Slip, Touching
    from sie.patches.answer import SeveralPatches
    from sie.patches.full import FullContact
    from sie.patches.result import PatchCertificate
    from sie.traction.base import Density

FIELDS = frozenset(f.name for f in fields(Scene))
# The fields and properties of a scene that each stage depends on.
LOADS = ("normal_load", "half_width", "tilt", "moment")
NORMAL = frozenset(
    ("profile", "body", "indenter", "modulus", *LOADS, "epsilon", "bonded", "coupled")
)
TANGENTIAL = ("friction", "tangential_load", "sliding", "bulk_stress")
SHEAR = NORMAL | {*TANGENTIAL, "dundurs", "coupling"}
OF_NORMAL = ("rises", "unverified", "touching", "normal", "in_patches", "pressure")
OF_SHEAR = ("bonded", "coupled", "tangential", "dissipated", "certificate", "coupling_notes")
PRESSED = (NORMAL - {"coupled"}) | {"friction", "dundurs", "coupling"}
STAGES = {
    **dict.fromkeys(OF_NORMAL, NORMAL),
    **dict.fromkeys(OF_SHEAR, SHEAR),
    "pressed": PRESSED,
}

BALANCED = 1e-9  # of P times the half-width: a moment that needs no tilt


class Sheared(Frictionless):
    """The contact of a scene with its shear, as a lazy view; parameters are those of `solve`."""

    def _contact(self) -> Normal | SeveralPatches | FullContact:
        if self.scene.bonded:
            return Normal(self.bonded[0], False)
        if self.scene.coupled:
            return Normal(self.coupled[0], not (self.scene.tangential_load or self.scene.tau))
        return super()._contact()

    @property
    def _not_convex(self) -> Normal | SeveralPatches | FullContact:
        """The same; of dissimilar bodies that slide one patch, whose inequalities are verified."""
        if not self.scene.epsilon:
            return super()._not_convex
        from sie.certificate.pressure_check import certificate
        from sie.certificate.result import TOLERATED, shown

        found = self.unverified
        density = pressure(found, self.scene, self.tol, self.economy)
        measured = certificate(density, found.slope(self.scene.profile), self.tol)
        if min(measured.lowest_pressure, measured.lowest_gap) < -TOLERATED:
            where = shown(measured.tension or measured.overlap)
            raise InequalityError(
                f"one patch of contact {density.interval} would need tension, or overlap, at "
                f"{where}, and dissimilar bodies that slide are solved in one patch only; smooth "
                "the profile, or give dundurs = 0 to neglect β",
                edges=density.interval,
                tension=measured.tension,
                overlap=measured.overlap,
            )
        return found

    @cached_property
    def bonded(self) -> tuple[Edges, JacobiDensity]:
        """The edges of a flat punch in full stick, and p + i q."""
        from sie.friction.full_stick import full_stick_contact

        return full_stick_contact(self.scene, self.tol)

    @cached_property
    def coupled(self) -> tuple[Edges, CoupledContact]:
        """The edges and the state of dissimilar bodies in partial slip."""
        scene = self.scene
        if not (scene.tangential_load or scene.tau):
            return self.pressed
        state = self.pressed[1].under(scene.tangential_load, scene.tau)
        return replace(state.edges, tilt=scene.tilt), state

    def go_on_from(self, before: CoupledContact | None) -> None:
        """Goes on from another state under the same P, and not from that under P alone."""
        if before is not None:
            state = before.under(self.scene.tangential_load, self.scene.tau)
            self.__dict__["coupled"] = replace(state.edges, tilt=self.scene.tilt), state

    @cached_property
    def pressed(self) -> tuple[Edges, CoupledContact]:
        """The same under the normal load alone, from which Q and bulk stress lead to others."""
        from sie.friction.coupled.answer import CoupledContact
        from sie.friction.coupled.normal import coupled_contact

        scene = self._upright
        if not scene.profile.convex:
            P, b = scene.normal_load, scene.half_width
            plain = Scene(profile=scene.profile, modulus=scene.Estar, normal_load=P, half_width=b)
            _ = Frictionless(plain, self.tol).grown_as_one_patch
        state = CoupledContact.of(coupled_contact(scene, self._frictionless), scene)
        edges = state.edges
        lever = edges.normal_load * edges.contact.r
        if scene.moment is not None and abs(edges.moment - scene.moment) > BALANCED * lever:
            raise held_moment(self.scene)
        return replace(edges, tilt=self.scene.tilt), state

    @property
    def _upright(self) -> Scene:
        """The scene with its tilt in the profile."""
        scene = self.scene
        return replace(scene, profile=scene.profile.tilted(scene.tilt), tilt=0.0)

    def _frictionless(self, scene: Scene) -> Normal:
        return Frictionless(scene, self.tol).unverified

    @property
    def normal_and_shear(self) -> JacobiDensity:
        """The traction p + i q in full stick."""
        _ = self.normal
        return self.bonded[1]

    @cached_property
    def pressure(self) -> SlopeDensity | Component | OnPieces:
        """The contact pressure p, a `Density` in units of stress.

        Returns
        -------
        Density
            `pressure(x)` gives its values, `.resultant` and `.moment` its load, `.cauchy(z)` its
            Cauchy potential ∫p(t)/(t - z) dt up to a factor, and `.hilbert(x)` the principal value.

        Raises
        ------
        ContactError
            If the profile carries no such load.
        """
        if self.scene.bonded:
            from sie.friction.full_stick import Component

            return Component(self.normal_and_shear, imaginary=False)
        _ = self.normal
        if self.scene.coupled:
            return self.coupled[1].tractions[0]
        several = self._several
        return self.density if several is None else cast(SlopeDensity, several.pressure)

    @property
    def _loads(self) -> tuple[float, float]:
        return self.tangential_load, self.scene.tau if self.scene.friction else 0.0

    @property
    def sheared(self) -> bool:
        """Whether the shear is found after the pressure: partial slip, or similar bodies."""
        scene = self.scene
        elsewhere = scene.epsilon or scene.bonded or scene.coupled
        return sheared(scene, self.economy) and not elsewhere

    @property
    def carries_shear(self) -> bool:
        """Whether there is a shear traction, of partial slip, sliding or full stick."""
        scene = self.scene
        return self.sheared or bool(scene.epsilon) or scene.bonded or scene.coupled

    @cached_property
    def tangential(self) -> Slip:
        """Zones of stick and slip, and the shear."""
        _ = self.pressure  # a part of the shear
        return self.first_loading(self._loads, self.patches_under)

    def first_loading(
        self,
        loads: tuple[float, float],
        in_patches: Callable[[float, float], Touching],
        *,
        one_sign: bool = False,
    ) -> Slip:
        """The state after Q and τ on this contact without shear.

        `in_patches` is the contact in several patches as a function of load and tilt; with
        `one_sign` slip is positive at both edges, whatever Q and τ. ContactError if Q exceeds f P,
        or no zones of stick and slip meet all conditions.
        """
        from sie.friction.partial_slip import slip
        from sie.friction.slip import Step

        under = self._under if self._several is None else in_patches
        return slip(Step(self.scene, self.touching, *loads, self.economy, under), one_sign)

    def _under(self, load: float, tilt: float) -> Touching:
        """The contact of the profile under another load and tilt."""
        plain = self._without_shear(load, tilt)
        if not self.convex:
            return Frictionless(plain, self.tol, self.economy).touching
        normal = normal_contact(plain, self.tol, self.economy, self.as_one_patch.seen)
        return OnePatch(normal, self.scene, self.tol, self.economy)

    @cached_property
    def dissipated(self) -> float:
        """The energy dissipated by slip."""
        if self.scene.coupled:
            return self.coupled[1].energy
        return self.tangential.energy

    @cached_property
    def certificate(self) -> Certificate | PatchCertificate:
        """The certificate that `check` returns, measured once."""
        if self.scene.bonded:
            from sie.certificate.coupled_check import full_stick_certificate

            return full_stick_certificate(
                self.normal.edges, self.normal_and_shear, self.scene, self.tol
            )
        if self.scene.coupled:
            from sie.certificate.coupled_check import coupled_certificate

            return coupled_certificate(self.coupled[1], self._upright, self.tol)
        others = self.tangential.contacts if self.sheared else ()
        if others or self._several is not None:
            from sie.patches.result import worst_of

            each = [c.certificate(self.tol) for c in (self.in_patches, *others)]
            return replace(worst_of(each), shear=self._shear_certificate(each))
        from sie.certificate.pressure_check import certificate

        found = certificate(self.slope_density, self._slope, self.tol)
        return replace(found, shear=self._shear_certificate())

    def _shear_certificate(
        self, of_pressures: Sequence[PatchCertificate] = ()
    ) -> ShearCertificate | None:
        """The certificate of the shear, on several patches with those of its pressures."""
        if not self.sheared:
            return None
        from sie.certificate.shear_check import shear_certificate

        p: Density = self.pressure
        tol = min((c.tol for c in of_pressures), default=self.tol)
        state, slope = self.tangential, self._slope
        return shear_certificate(state, p, self._loads, slope, tol=tol, of_pressures=of_pressures)

    @property
    def slope_density(self) -> SlopeDensity:
        """The pressure, where it is not that of full stick."""
        return cast(SlopeDensity, self.pressure)

    # -- answers -----------------------------------------------------------------------------------

    @property
    def tangential_load(self) -> float:
        """Tangential load Q, force per length; ±f P in full sliding."""
        slides = self.scene.slides
        return (
            slides * self.scene.friction * self.normal_load
            if slides
            else self.scene.tangential_load
        )

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones, ((lo, hi), ...) in lengths.

        Returns
        -------
        tuple of tuple of float
            The whole contact where no tangential load was applied; () in full sliding and without
            friction.
        """
        if self.scene.epsilon:
            return ()
        if self.sheared:
            return self.tangential.stick
        if self.scene.coupled:
            return self.coupled[1].stick
        return self.patches if self.scene.friction else ()

    @property
    def shear(self) -> Density:
        """The shear traction q, which acts on the body along +x, a `Density` in units of stress.

        Returns
        -------
        Density
            As for `pressure`; zero everywhere without friction.
        """
        if self.scene.bonded:
            from sie.friction.full_stick import Component

            return Component(self.normal_and_shear, imaginary=True)
        if self.scene.epsilon:
            return scaled(self.scene.slides * self.scene.friction, self.pressure)
        if self.scene.coupled:
            _ = self.normal
            return self.coupled[1].tractions[1]
        return self.tangential.shear if self.sheared else ZERO


# -- what a change of the scene keeps --------------------------------------------------------------


def changed_scene(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """The scene with other values of some fields.

    `normal_load` and `half_width` replace each other, and so do `tilt` and `moment`, and `modulus`
    and the bodies.
    """
    for name in changes:
        if name not in FIELDS:
            raise ValueError(
                f"{name} is not a field of a scene: change {', '.join(sorted(FIELDS))}"
            )
    replaced: dict[str, Any] = {}
    for one, other in (("normal_load", "half_width"), ("tilt", "moment")):
        for given, taken_out in ((one, other), (other, one)):
            if changes.get(given) is not None:
                replaced[taken_out] = 0.0 if taken_out == "tilt" else None
    if "modulus" in changes and scene.body is not None:
        replaced |= {"body": None, "indenter": None, "dundurs": None}
    return replace(scene, **(replaced | dict(changes)))


def kept_stages(old: Scene, new: Scene) -> frozenset[str]:
    """The stages that depend on nothing in which the scenes differ."""
    pairs = ((name, getattr(new, name), getattr(old, name)) for name in SHEAR)
    changed = {name for name, now, before in pairs if now is not before and now != before}
    # One equation then gives pressure and shear: what changes the one changes the other.
    if changed:
        changed |= {name for name in ("bonded", "coupled") if getattr(old, name)}
    return frozenset(stage for stage, needs in STAGES.items() if not changed & needs)
