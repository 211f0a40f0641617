"""The families that a profile has."""

from __future__ import annotations

from functools import singledispatch
from typing import Any

import numpy as np

from sie.profiles.base import Profile
from sie.profiles.row import asks_for_patches
from sie.profiles.shapes import Flat, Parabola, Power, RoundedFlat, Wedge

from .closed import HERTZ, PUNCH, ROUNDED, TIP, Closed, power
from .families import Array, Family
from .newton import Tilted
from .smooth import Smooth

MOST_BREAKS = 8  # of a slope that may be smooth between them


@singledispatch
def families(profile: Profile, shape: tuple[int, ...]) -> tuple[Family, ...]:
    """The families that answer for a profile, with parameters of n scenes."""
    inner = profile.pieces.breaks[1:-1]
    if asks_for_patches(profile) or len(inner) > MOST_BREAKS:
        return ()
    breaks = tuple(float(b) for b in inner)
    return (Smooth(profile.pieces, {}, profile.axis, breaks, profile.domain, profile.convex),)


def _flat(shape: tuple[int, ...], *values: Any) -> tuple[Array, ...]:
    return tuple(np.broadcast_to(np.asarray(v, float), shape).ravel() for v in values)


@families.register
def _(profile: Parabola, shape: tuple[int, ...]) -> tuple[Family, ...]:
    return (Closed(HERTZ, _flat(shape, profile.radius), lambda tilt, R: -tilt * R),)


@families.register
def _(profile: RoundedFlat, shape: tuple[int, ...]) -> tuple[Family, ...]:
    both = _flat(shape, profile.half_flat, profile.radius)
    return Closed(ROUNDED, both), Tilted(*both)


@families.register
def _(profile: Flat, shape: tuple[int, ...]) -> tuple[Family, ...]:
    return (Closed(PUNCH, _flat(shape, profile.half_width)),)


@families.register
def _(profile: Wedge, shape: tuple[int, ...]) -> tuple[Family, ...]:
    return (Closed(TIP, _flat(shape, profile.rise)),)


@families.register
def _(profile: Power, shape: tuple[int, ...]) -> tuple[Family, ...]:
    return (Closed(power(profile.exponent), _flat(shape, profile.coefficient)),)
