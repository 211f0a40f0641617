"""Contacts in closed form, and how near two values are, for tests of `analytic`."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import mpmath
import numpy as np
from hypothesis import strategies as st

from analytic import flat, hertz, rounded_flat, wedge

EPS = float(np.finfo(float).eps)
UNIT = {"radius": 1.0, "modulus": 1.0}
mp = mpmath.MPContext()  # references
mp.dps = 50
# References from formulas that cancel to the third power of a rim of 1e-12
deep = mpmath.MPContext()
deep.dps = 120
coarse = mpmath.MPContext()  # quadrature, where doubles are what is checked
coarse.dps = 20


class Rounded(NamedTuple):
    """A rounded flat's contact as a caller gives it, and the exact numbers it stands for."""

    given: dict[str, float]
    a: Any
    b: Any

    @property
    def rim(self) -> float:
        return float(self.b - self.a)


def with_half_width(a: float, b: float = 1.0) -> Rounded:
    return Rounded({"half_flat": a, "half_width": b}, deep.mpf(a), deep.mpf(b))


def with_rim(rim: float, a: float = 1.0) -> Rounded:
    return Rounded({"half_flat": a, "rim": rim}, deep.mpf(a), deep.mpf(a) + deep.mpf(rim))


tiny_to_one = st.floats(-12, -0.01).map(lambda e: 10.0**e)  # 1e-12 to 0.98
rounded = st.one_of(
    tiny_to_one.map(with_half_width),
    tiny_to_one.map(lambda d: with_half_width(1.0 - d)),
    tiny_to_one.map(with_rim),
)


def relative(value: Any, exact: Any) -> float:
    """The largest relative error, where 0 must be 0."""
    errors = [
        abs(v - e) / abs(e) if e else abs(v) for v, e in zip(np.atleast_1d(value).tolist(), exact)
    ]
    return float(max(errors))


class Potential(NamedTuple):
    """An indenter with a potential: everything a law needs, with b = 1 and E* = 3."""

    name: str
    module: Any
    given: dict[str, Any]  # of the pressure and the potential
    load: float
    slope: Callable[[float], float]
    prefix: str = ""

    def pressure(self, x: Any, lib: Any = np) -> Any:
        return getattr(self.module, self.prefix + "pressure")(x, **self.given, lib=lib)

    def potential(self, z: Any, **options: Any) -> Any:
        return getattr(self.module, self.prefix + "potential")(z, **self.given, **options)


def rounded_case(ratio: float) -> Potential:
    given = {"half_flat": ratio, "half_width": 1.0, "radius": 2.0, "modulus": 3.0}
    slope = lambda x: float(rounded_flat.slope(x, half_flat=ratio, radius=2.0))  # noqa: E731
    return Potential(
        f"rounded {ratio}", rounded_flat, given, float(rounded_flat.load(**given)), slope
    )


def flat_case(P: float, M: float) -> Potential:
    given = {"half_width": 1.0, "normal_load": P, "moment": M}
    prefix = "" if abs(M) <= P / 2 else "partial_"
    tilt = getattr(flat, prefix + "tilt")(**given, modulus=3.0)
    return Potential(f"flat {P} {M}", flat, given, P, lambda x: float(tilt), prefix)


HERTZ = {"half_width": 1.0, "radius": 2.0, "modulus": 3.0}
WEDGE = {"half_width": 1.0, "slope": 0.5, "modulus": 3.0}
POTENTIALS = [
    *(rounded_case(ratio) for ratio in (0.0, 1e-6, 0.4, 0.999)),
    Potential("hertz", hertz, HERTZ, float(hertz.load(**HERTZ)), lambda x: x / 2.0),
    Potential("wedge", wedge, WEDGE, float(wedge.load(**WEDGE)), lambda x: math.copysign(0.5, x)),
    *(flat_case(2.0, M) for M in (0.0, 0.7, -1.0)),
    *(flat_case(2.0, M) for M in (1.3, -1.8)),
]
