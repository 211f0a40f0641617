"""The families that a profile has."""

from __future__ import annotations

from typing import Any

from sie.profiles.base import Profile
from sie.profiles.row import asks_for_patches
from sie.profiles.shapes import Flat, Parabola, Power, RoundedFlat, Wedge

from .families import HERTZ, PUNCH, ROUNDED, TIP, Family, power
from .newton import TILTED
from .smooth import Smooth

MOST_BREAKS = 8  # of a slope that may be smooth between them
# Profiles with formulas, whose parameters may be arrays
SHAPES: dict[type, tuple[Family, ...]] = {
    Parabola: (HERTZ,), RoundedFlat: (ROUNDED, TILTED), Flat: (PUNCH,), Wedge: (TIP,), Power: (),
}  # fmt: skip


def families(profile: Any, names: tuple[str, ...]) -> tuple[Family | Smooth, ...]:
    """The families that answer for a profile, or for a slope with parameters of these names."""
    if not isinstance(profile, Profile):
        return (Smooth(profile, names),)
    if type(profile) in SHAPES:
        return SHAPES[type(profile)] or (power(profile.exponent),)  # type: ignore[attr-defined]
    inner = profile.pieces.breaks[1:-1]
    if asks_for_patches(profile) or len(inner) > MOST_BREAKS:
        return ()
    breaks, known = tuple(map(float, inner)), (profile.domain, profile.convex)
    return (Smooth(profile.pieces, (), profile.axis, breaks, *known),)
