"""The contact of a scene under its normal load: the stages of the work, and its edges and loads.

It is one patch, several, or one that repeats with the period of the profile.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING, cast

import numpy as np

from .contact.inequalities import slope_rises, slope_rises_far, verify_inequalities
from .contact.known_contact import Normal
from .contact.normal import falls_somewhere, normal_contact, of_one_patch, one_series
from .contact.pressure import pressure
from .errors import ContactError, InequalityError, LoadError, ResolutionError
from .problem.request import ECONOMY
from .problem.scene import Scene
from .profiles.placed_traces import explained, smoothing_remedy
from .profiles.row import asks_for_patches
from .profiles.slope import Slope
from .stages import stage as cached_property  # its first reading is logged
from .traction.of_slope import SlopeDensity

if TYPE_CHECKING:  # patches are imported where one patch is no answer
    from .patches.answer import SeveralPatches
    from .patches.full import FullContact

# of a patch: the pressure on more of them is more exact as that of several patches
MOST_PANELS = 128


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
        """The contact without shear, verified where the profile may not be convex."""
        if asks_for_patches(self.scene.profile):
            return self._in_patches()
        if self._of_waves is not None:
            return self.unverified if self._is_one_patch else self._of_waves
        try:
            return self.one_patch()
        except (InequalityError, LoadError, ResolutionError) as error:
            # Without a lowest point patches are no answer either, unless another tilt is found
            bottomless = "falls" in error.reached and self.scene.moment is None
            if self._may_be_in_patches and not bottomless:
                return self._in_patches(error)
            raise explained(error, self.scene.profile) from None
        except ContactError as error:
            raise explained(error, self.scene.profile) from None

    def one_patch(self) -> Normal:
        """The contact if it is one patch.

        Returns
        -------
        Normal
            Its edges, load, moment and tilt.

        Raises
        ------
        ContactError
            If it is not one patch.
        """
        if not (self.scene.profile.convex and "convexity" in self.economy):
            _ = self.inequalities
        return self.unverified

    def _in_patches(self, one_patch: ContactError | None = None) -> SeveralPatches | FullContact:
        """Contact in several patches; `one_patch` is why it is not one."""
        from .patches.answer import several_patches

        try:
            return several_patches(self.scene)
        except ContactError as error:
            told = one_patch if isinstance(one_patch, LoadError) and not error.reached else error
            if self.scene.half_width is not None:  # which patches have not, but for its limit
                told = one_patch if one_patch and "widest" in one_patch.reached else error
            raise explained(told, self.scene.profile) from None

    @property
    def _may_be_in_patches(self) -> bool:
        scene = self.scene
        return not scene.epsilon and not scene.profile.convex

    @property
    def as_one_patch(self) -> Normal:
        """The contact, for what is solved on one patch only. Raises ContactError for several."""
        found = self.normal
        if isinstance(found, Normal):
            return found
        number, period = len(found.patches), self.scene.profile.period
        where = f"in {number} patches" if number > 1 else "in one patch, merged from several"
        remedy = smoothing_remedy(self.scene.profile) or "give a convex profile"
        if np.isfinite(period):
            where, remedy = f"that repeats every {period:.6g}", "give the profile without period"
        raise ContactError(
            f"contact {where}: what is asked for is solved in one patch that grows from the first "
            f"touch on; {remedy}, set friction = 0, or give dundurs = 0 to neglect β"
        )

    @cached_property
    def in_patches(self) -> SeveralPatches | FullContact:
        """The contact as one in several patches, though it may be in one."""
        return self._several or self.patches_under(self.normal_load, self.tilt)

    def patches_under(self, load: float, tilt: float) -> SeveralPatches | FullContact:
        """The contact of the same profile under another load and tilt, in several patches.

        Parameters
        ----------
        load : float
            P, a force per unit length.
        tilt : float
            The tilt, a pure number.

        Returns
        -------
        SeveralPatches or FullContact
            The contact without shear.

        Raises
        ------
        ContactError
            If no patches are certified.
        """
        plain = replace(
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
        from .patches.answer import several_patches

        return several_patches(plain)

    @cached_property
    def _of_one_series(self) -> Normal | None:
        """The contact in which one series resolves the slope of a function."""
        return one_series(self.scene, self.tol, self.economy)

    @cached_property
    def _of_waves(self) -> SeveralPatches | FullContact | None:
        """The contact of a function whose slope falls: patches are then sought at once."""
        scene = self.scene
        may_be = self._may_be_in_patches and scene.profile.pieces.functions and scene.normal_load
        if not may_be or self._of_one_series is not None or not falls_somewhere(scene):
            return None
        from .patches.answer import several_patches

        try:
            return several_patches(scene)
        except ContactError:  # where they do not settle, one patch may be the answer
            return None

    @property
    def _is_one_patch(self) -> bool:
        if self._of_waves is None or len(self._of_waves.patches) > 1:
            return False
        found = cast("SeveralPatches", self._of_waves)  # no function has a period of its own
        return any(found.edges.sharp) or len(found.found.operator.panels.piece) <= MOST_PANELS

    @property
    def _several(self) -> SeveralPatches | FullContact | None:
        """The contact, if it is in several patches or per period."""
        return None if isinstance(self.normal, Normal) else self.normal

    @cached_property
    def unverified(self) -> Normal:
        """The contact that carries the load and the moment.

        Bodies may overlap there, or be in tension.
        """
        if self._of_one_series is not None:
            return self._of_one_series
        if self._of_waves and self._is_one_patch and not any(self._of_waves.edges.sharp):
            return of_one_patch(self._of_waves.edges, self.scene, self.tol, self.economy)
        return normal_contact(self.scene, self.tol, self.economy)

    @cached_property
    def density(self) -> SlopeDensity:
        """The pressure of this contact."""
        return pressure(self.unverified, self.scene, self.tol, self.economy)

    @cached_property
    def inequalities(self) -> bool:
        """True where p >= 0 and gap >= 0; otherwise InequalityError is raised."""
        found, density = self.unverified, self.density
        slope = found.slope(self.scene.profile)
        series = found.series is not None and slope_rises_far(density.contact, slope)
        rises = series or slope_rises(density, slope)
        if not ("convexity" in self.economy and rises):
            verify_inequalities(density, slope)
        return True

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
        return self.normal.edges.moment

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
