"""The kinds of indenter that a scene file can name.

A new kind needs a class in this folder, a line here, and a commented example in
sie/examples/KIND.toml. The parameters of the class and their types determine what a scene file may
hold. This table and the example determine the list of `sie example` and the profiles that the tests
cover.
"""

from __future__ import annotations

from collections.abc import Callable

from .base import Profile
from .from_function import FromFunction
from .polynomials import Piecewise, Polynomial
from .sampled import Sampled
from .shapes import Flat, Parabola, Power, RoundedFlat, Wedge

KINDS: dict[str, Callable[..., Profile]] = {
    "parabola": Parabola,
    "rounded-flat": RoundedFlat,
    "flat": Flat,
    "wedge": Wedge,
    "power": Power,
    "polynomial": Polynomial,
    "piecewise": Piecewise,
    "function": FromFunction,
    "sampled": Sampled,
}
