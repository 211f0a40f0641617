"""A contact whose edges are known: every search for edges ends with it, every pressure begins."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.errors import LoadError

if TYPE_CHECKING:
    from sie.numerics.interval import Interval
    from sie.problem.scene import Scene
    from sie.profiles.base import Profile
    from sie.profiles.slope import Slope

Array = NDArray[np.float64]

PLACES = 64.0  # fewer places in a half-width do not show the pressure
SIZE = 1e120  # bounds a half-width and a pressure, whose squares are multiplied again
MOMENT = 1e304  # bounds a moment
NEARER = (
    "choose other units, or lessen what moves the contact away from x = 0, tilt, moment or shift"
)


@dataclass(frozen=True)
class Edges:
    """The contact, load, moment about x = 0 and tilt; which edges are sharp, and their k1, k2.

    k1 and k2 are stresses.
    """

    contact: Interval
    normal_load: float
    moment: float
    tilt: float
    sharp: tuple[bool, bool]
    k1: float
    k2: float
    I0: float
    evaluations: int


@dataclass(frozen=True)
class Normal:
    """The contact, and whether its symmetry halved the search.

    `series` are Chebyshev coefficients of a slope that is smooth there, and rises where seen.
    """

    edges: Edges
    symmetric: bool
    series: Array | None = field(default=None, compare=False, repr=False)
    seen: tuple[float, ...] = ()  # breaks that a function's slope needs beside the declared ones

    def slope(self, profile: Profile) -> Slope:
        """H of the profile as it is pressed: with these breaks, and tilted."""
        return with_breaks(profile.pieces, self.seen).tilted(self.edges.tilt)


def with_breaks(slope: Slope, places: tuple[float, ...]) -> Slope:
    for x in places:
        slope = slope.split_at(x)
    return slope


def refuse_unresolved(edges: Edges, scene: Scene) -> None:
    """Raises LoadError where doubles cannot hold the contact."""
    refuse_narrow(edges.contact.x1, edges.contact.x2)
    refuse_out_of_scale(edges.contact.r, edges.normal_load, scene.Estar)


def refuse_narrow(x1: float, x2: float) -> None:
    """Raises LoadError for a contact in which doubles are too few to show the pressure."""
    apart = math.ulp(max(abs(x1), abs(x2)))
    if not 0.5 * (x2 - x1) >= PLACES * apart:
        raise LoadError(
            f"the contact at x = {0.5 * (x1 + x2):.6g} is {x2 - x1:.6g} wide, where doubles are "
            f"{apart:.2g} apart: raise the load, {NEARER}"
        )


def refuse_out_of_scale(r: float, load: float, Estar: float) -> None:
    """Raises LoadError for a contact of half-width r with sizes whose products are no doubles."""
    sizes = (
        ("half-width", r, SIZE),
        ("mean traction", 0.5 * load / r, SIZE),
        ("E* r²", Estar * r * r, MOMENT),
    )
    for name, size, largest in sizes:
        if not 1.0 / largest <= size <= largest:
            raise LoadError(
                f"the contact's {name} is {size:.6g}, whose products leave the range of doubles: "
                f"{arguments.REMEDY}"
            )


def refuse_infinite_slope(profile: Profile, side: int) -> None:
    """Raises LoadError where the slope is infinite at the left end of the indenter, or right (1).

    No series resolves the slope towards such an end.
    """
    end = profile.domain[side]
    if math.isfinite(end) and not math.isfinite(float(profile.pieces(end))):
        raise LoadError(
            f"the slope is infinite at the end x = {end:.6g} of its domain, which the contact "
            "comes near: narrow the domain"
        )


def refuse_end(profile: Profile, side: int) -> None:
    """Raises LoadError for contact at an end beyond which the indenter is not known."""
    refuse_infinite_slope(profile, side)
    if not profile.ends_are_corners[side]:
        end = profile.domain[side]
        raise LoadError(
            f"the contact reaches the end of the trace at x = {end:.6g}, and what the indenter is "
            "like beyond is not known: lower the load or the tilt, repeat the trace by "
            "sie.Periodic(trace, period), or measure further out",
            end=end,
        )


def not_one_patch(scene: Scene) -> LoadError:
    return LoadError(
        f"half_width = {scene.half_width:.6g} is not that of one patch of contact, and the load of "
        "several patches is not sought from it: give normal_load instead"
    )
