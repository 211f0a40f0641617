"""The contact of a scene under its normal load: the stages of the work, and its edges and loads.

Where the slope of the profile rises, the contact is one patch by theorem (`contact.convexity`). All
other contacts are found as patches, and one patch among them is solved as such.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from sie.contact.convexity import may_have_merged, rises, rises_beside, turns_away
from sie.contact.known_contact import Normal, not_one_patch
from sie.contact.normal import by_pieces, of_one_patch, one_series
from sie.contact.pressure import OnePatch
from sie.contact.window import window_of
from sie.errors import ContactError
from sie.problem.request import ECONOMY
from sie.profiles.lowest_points import lowest_points
from sie.profiles.placed_traces import explained, smoothing_remedy

if TYPE_CHECKING:  # patches are imported where one patch is no answer
    from sie.patches.answer import SeveralPatches
    from sie.patches.full import FullContact
    from sie.problem.scene import Scene
    from sie.profiles.slope import Slope
    from sie.traction.of_slope import SlopeDensity

# of a patch: the pressure on more of them is more exact as that of several patches
MOST_PANELS = 128
MERGED = "in one patch, merged from several"
SAME = 1e-6  # of a half-width: patches that differ by more from one patch are others


class Frictionless:
    """The contact of a scene without shear, as a lazy view; parameters are those of `solve`."""

    def __init__(
        self, scene: Scene, tol: float = 1e-13, economy: Collection[str] = ECONOMY
    ) -> None:
        self.scene = scene
        self.tol = tol
        self.economy = frozenset(economy)

    # -- stages ------------------------------------------------------------------------------------

    @cached_property
    def normal(self) -> Normal | SeveralPatches | FullContact:
        """Edges, load, moment and tilt."""
        return self._contact()

    def _contact(self) -> Normal | SeveralPatches | FullContact:
        """The contact without shear."""
        try:
            return self.unverified if self.convex else self._not_convex
        except ContactError as error:
            raise explained(error, self.scene.profile) from None

    @property
    def _not_convex(self) -> Normal | SeveralPatches | FullContact:
        """The contact of a profile whose slope falls somewhere."""
        return self._of_half_width if self.scene.half_width is not None else self._in_patches

    @property
    def convex(self) -> bool:
        """Whether the profile is known to be convex, or its slope rises where it was looked at."""
        known = self.scene.profile.convex and "convexity" in self.economy
        return known or self.rises

    @cached_property
    def rises(self) -> bool:
        """Whether the slope rises from place to place of the indenter."""
        profile, series = self.scene.profile, self._of_one_series
        if profile.of_several:
            return False
        if series is not None:
            contact = series.edges.contact
            return rises_beside((contact.x1, contact.x2), series.slope(profile))
        window = window_of(self.scene)
        return rises(profile.pieces, (window.lo, window.hi))

    @property
    def _in_patches(self) -> Normal | SeveralPatches | FullContact:
        """The contact as patches; as one patch where a profile without walls touches in one."""
        from sie.patches.answer import several_patches

        slope = self.scene.profile.pieces.tilted(self.scene.tilt)
        if not slope.functions and self.scene.moment is None:
            lowest_points(slope)  # raises LoadError where there are none, and no contact
        found = several_patches(self.scene)
        if self.scene.profile.of_several or len(found.patches) > 1:
            return found
        patch = cast("SeveralPatches", found)  # a contact without edges is periodic
        panels = len(patch.found.operator.panels.piece)
        many = bool(slope.functions) and panels > MOST_PANELS
        if many or turns_away(slope, patch.patches[0]):
            return found
        return of_one_patch(patch.edges, self.scene, self.tol, self.economy)

    @property
    def _of_half_width(self) -> Normal:
        """The one patch of a half-width, if its load makes it the only one."""
        found = self.unverified
        edges = found.edges
        loaded = replace(self.scene, half_width=None, normal_load=edges.normal_load)
        patches = Frictionless(loaded, self.tol, self.economy).patches
        apart = np.abs(np.subtract(patches, edges.contact[:2])).max()
        merged = turns_away(self.scene.profile.pieces, patches[0])
        if len(patches) > 1 or merged or apart > SAME * edges.contact.r:
            raise not_one_patch(self.scene)
        return found

    @property
    def as_one_patch(self) -> Normal:
        """The contact, for what is solved on one patch only. Raises ContactError for several."""
        if isinstance(self.normal, Normal):
            return self.normal
        number = len(self.normal.patches)
        raise self._not_grown(f"in {number} patches" if number > 1 else MERGED)

    @property
    def grown_as_one_patch(self) -> Normal:
        """The contact, for what is solved on one patch from the first touch on.

        Raises ContactError where several have touched, or may have.
        """
        found = self.as_one_patch
        contact = found.edges.contact
        if may_have_merged(found.slope(self.scene.profile), (contact.x1, contact.x2)):
            raise self._not_grown(MERGED)
        return found

    def _not_grown(self, where: str) -> ContactError:
        period = self.scene.profile.period
        remedy = smoothing_remedy(self.scene.profile) or "give a convex profile"
        if np.isfinite(period):
            where, remedy = f"that repeats every {period:.6g}", "give the profile without period"
        return ContactError(
            f"contact {where}: what is asked for is solved in one patch that grows from the first "
            f"touch on; {remedy}, set friction = 0, or give dundurs = 0 to neglect β"
        )

    @cached_property
    def in_patches(self) -> SeveralPatches | FullContact:
        """The contact as one in several patches, though it may be in one."""
        return self._several or self.patches_under(self.normal_load, self.tilt)

    def patches_under(self, load: float, tilt: float) -> SeveralPatches | FullContact:
        """The contact of the same profile under another load and tilt, in several patches.

        ContactError if no patches are certified.
        """
        from sie.patches.answer import several_patches

        return several_patches(self._without_shear(load, tilt))

    def _without_shear(self, load: float, tilt: float) -> Scene:
        """The scene without shear under another load and tilt."""
        return replace(
            self.scene,
            normal_load=load,
            half_width=None,
            tilt=tilt,
            moment=None,
            friction=0.0,
            tangential_load=0.0,
            sliding=0,
            bulk_stress=0.0,
        )

    @cached_property
    def _of_one_series(self) -> Normal | None:
        """The contact in which one series resolves the slope of a function."""
        return one_series(self.scene, self.tol, self.economy)

    @property
    def _several(self) -> SeveralPatches | FullContact | None:
        """The contact, if it is in several patches or per period."""
        return None if isinstance(self.normal, Normal) else self.normal

    @cached_property
    def unverified(self) -> Normal:
        """The contact that carries the load and the moment if it is one patch."""
        return self._of_one_series or by_pieces(self.scene, self.tol, self.economy)

    @cached_property
    def touching(self) -> OnePatch | SeveralPatches | FullContact:
        """The contact with its pressure and gap."""
        found = self.normal
        if isinstance(found, Normal):
            return OnePatch(found, self.scene, self.tol, self.economy)
        return found

    @property
    def density(self) -> SlopeDensity:
        """The pressure of the contact in one patch."""
        return cast("SlopeDensity", self.touching.pressure)

    @property
    def _slope(self) -> Slope:
        return self.normal.slope(self.scene.profile)

    # -- answers -----------------------------------------------------------------------------------

    @property
    def edges(self) -> tuple[float, float]:
        """The edges of the contact, (x1, x2), lengths.

        Returns
        -------
        tuple of float
            The edges rounded to doubles. The solution itself keeps them more exactly.
        """
        contact = self.normal.edges.contact
        return contact.x1, contact.x2

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        """The patches of contact as (x1, x2), ascending; per period those of one period."""
        return (self.edges,) if self._several is None else self._several.patches

    @property
    def patch_loads(self) -> tuple[float, ...]:
        """∫p over each patch, force per length."""
        return (self.normal_load,) if self._several is None else self._several.pressure.loads

    @property
    def contact_length(self) -> float:
        """The real length of contact, of all patches together; per period that of one period."""
        return sum(x2 - x1 for x1, x2 in self.patches)

    @property
    def gap_volume(self) -> float:
        """∫ of the gap between the patches, or over one period, where there is an indenter.

        A fluid would fill this volume per length of the line of contact.
        """
        several = self._several
        return several.gap_volume if several is not None else 0.0

    @property
    def half_width(self) -> float:
        """Half-width of the contact, length.

        Of several patches it is half the distance of the outermost two edges; per period half of
        the shortest interval that has all patches of a period, and half the period in full contact.
        """
        return self.normal.edges.contact.r

    @property
    def centre(self) -> float:
        """Centre of the contact, length."""
        return self.normal.edges.contact.m

    @property
    def normal_load(self) -> float:
        """Normal load P, force per length."""
        return self.normal.edges.normal_load

    @property
    def moment(self) -> float:
        """Moment of the pressure ∫p x dx about x = 0, force per length times length."""
        several = self._several
        return self.normal.edges.moment if several is None else several.moment

    @property
    def tilt(self) -> float:
        """Tilt of the indenter, the angle that is added to the slope of the profile."""
        return self.normal.edges.tilt

    @property
    def sharp(self) -> tuple[bool, bool]:
        """Whether each edge is a corner of the indenter, (left, right).

        Returns
        -------
        tuple of bool
            True where the contact ends at an end of the profile's domain. The pressure is infinite
            there.
        """
        return self.normal.edges.sharp
