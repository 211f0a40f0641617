"""The kinds of indenter that a scene file can name.

A new kind needs a class in this folder, a line here, and a commented example in
sie/examples/KIND.toml. From the class' parameters and their types follows what a scene file may
hold; the list of `sie example` and the laws of the tests follow from this table and the example.
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
