"""Functions of the plane that are cut along the contact [-b, b]."""

import sys
from collections.abc import Callable
from functools import partial

import numpy as np

from analytic._core.numbers import Library, Number, larger, sign
from analytic._core.parameters import side_of_cut
from analytic._core.piecewise import pick

# Below this height over the cut, in units of the contact (and below the least normal float),
# quotients under- or overflow. The limit on the cut is then correct to all digits. (A context has
# no such bound.)
SHALLOW = 1e-290


def root(lib: Library, z: Number, b: Number) -> Number:
    """sqrt(z² - b²), cut along [-b, b] and ~ z far away, for z off the cut."""
    return lib.sqrt(z - b) * lib.sqrt(z + b)


def on_cut(lib: Library, z: Number, b: Number, low: Number = 0) -> Number:
    """Whether z is, in floats, a real point of the contact, where the limit depends on the side.

    The half-width is b + low, in case it has more digits than b.
    """
    height = larger(SHALLOW * b, sys.float_info.min, lib) if lib is np else 0
    return (abs(z.imag) <= height) & ((b - abs(z.real)) + low >= 0)


def seen_from(z: Number, side: int) -> Number:
    """The side of the cut that z is on, and `side` for real z."""
    own = sign(z.imag)
    return own + (own == 0) * side


def in_plane(
    lib: Library, cut: Number, side: int,
    limit: Callable[..., Number], value: Callable[..., Number], *args: Number,
) -> Number:  # fmt: skip
    """`limit(lib, *args, side=side)` on the cut, `value(lib, *args)` off it.

    ValueError for other sides.
    """
    return pick(lib, cut, partial(limit, side=side_of_cut(side)), value, *args)
