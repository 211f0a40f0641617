"""Random contacts for hypothesis, all of them with an answer: lengths and slopes near 1 (the laws
of scaling do the rest).

Slopes of piecewise profiles are continuous, or jump upwards, exactly: breaks and coefficients are
multiples of powers of two.
"""

from fractions import Fraction
from typing import Any

import numpy as np
from hypothesis import strategies as st

import sie

Floats = st.SearchStrategy[float]


def between(lo: float, hi: float) -> Floats:
    """Numbers of a size that contacts have."""
    return st.floats(lo, hi, allow_nan=False).map(lambda v: v if abs(v) > 1e-100 else 0.0)


def log_between(lo: float, hi: float) -> Floats:
    return st.floats(np.log10(lo), np.log10(hi)).map(lambda e: float(10.0**e))


def dyadic(lo: float, hi: float, bits: int = 8) -> Floats:
    """Multiples of 2^-bits: their sums and products are exact."""
    return st.integers(round(lo * 2**bits), round(hi * 2**bits)).map(lambda n: n / 2**bits)


@st.composite
def chains(draw: st.DrawFn, jumps: bool = True) -> sie.Piecewise:
    """Convex, piecewise linear slope on 2 to 8 pieces: corners, flats, radii, wedges."""
    n = draw(st.integers(2, 8))
    gaps = draw(st.lists(dyadic(1 / 256, 1), min_size=n - 2, max_size=n - 2))
    inner = draw(
        st.lists(st.one_of(st.just(0.0), dyadic(1 / 16, 8)), min_size=n - 2, max_size=n - 2)
    )
    curvatures = [Fraction(c) for c in (draw(dyadic(1 / 8, 4)), *inner, draw(dyadic(1 / 8, 4)))]
    rises = [
        Fraction(draw(dyadic(0, 1))) if jumps and draw(st.integers(0, 4)) == 0 else Fraction(0)
        for _ in range(n - 1)
    ]
    breaks = [Fraction(draw(dyadic(-1, 1)))]
    for gap in gaps:
        breaks.append(breaks[-1] + Fraction(gap))
    value = Fraction(draw(dyadic(-1, 0)))
    rows = [(value - curvatures[0] * breaks[0], curvatures[0])]
    for k, (b, rise) in enumerate(zip(breaks, rises, strict=True)):
        value += rise
        rows.append((value - curvatures[k + 1] * b, curvatures[k + 1]))
        if k + 1 < len(breaks):
            value += curvatures[k + 1] * (breaks[k + 1] - b)
    return sie.Piecewise([float(b) for b in breaks], [tuple(map(float, row)) for row in rows])


def _sinh(x: Any) -> Any:
    return np.sinh(x)


def _wavy(x: Any) -> Any:
    return x + 0.4 * np.sin(2.0 * x)


def _runge(x: Any) -> Any:
    return x * (1.0 + 4.0 / (1.0 + 9.0 * x * x))


parabolas = st.builds(sie.Parabola, radius=log_between(0.1, 10))
rounded_flats = st.builds(
    sie.RoundedFlat, half_flat=log_between(0.01, 2), radius=log_between(0.1, 10)
)
wedges = st.builds(sie.Wedge, slope=log_between(0.1, 2))
exponents = st.one_of(between(1.5, 6.0), st.sampled_from([1, 1.5, 2, 2.5, 3, 4, 8]))
powers = st.builds(sie.Power, exponent=exponents, coefficient=log_between(0.1, 10))
polynomials = st.builds(
    lambda c1, c2, c3, c4: sie.Polynomial((0.0, c1, c2, c3 * np.sqrt(c2 * c4), c4)),
    between(-0.3, 0.3), log_between(0.1, 3), between(-1.5, 1.5), log_between(0.1, 3),
)  # fmt: skip
functions = st.builds(
    lambda f, lo, hi: sie.FromFunction(f, domain=(-lo, hi)),
    st.sampled_from([_sinh, _wavy, _runge]), between(20.0, 40.0), between(20.0, 40.0),
)  # fmt: skip
texts = st.sampled_from(
    [
        sie.FromFunction("sinh(x)", domain=(-30.0, 30.0), parity="even"),
        sie.FromFunction("x*abs(x) + x/8", breaks=(0.0,)),
    ]
)
round_profiles = st.one_of(
    parabolas, rounded_flats, wedges, powers, polynomials, chains(), functions, texts
)


@st.composite
def sharp_profiles(draw: st.DrawFn) -> sie.Profile:
    """Indenters with ends: contact reaches none, one or both of them."""
    kind = draw(st.sampled_from(["flat", "function", "chain"]))
    if kind == "flat":
        return sie.Flat(draw(log_between(0.1, 3)))
    if kind == "function":
        return sie.FromFunction(
            draw(st.sampled_from([_sinh, _wavy])),
            domain=(-draw(log_between(0.05, 3)), draw(log_between(0.05, 3))),
        )
    lo, hi = draw(dyadic(-2, -1 / 16)), draw(dyadic(1 / 16, 2))
    c, d = draw(dyadic(0, 4)), draw(dyadic(0, 4))
    return sie.Piecewise((lo, 0.0, hi), ((0.0, c), (0.0, d)))


@st.composite
def profiles(draw: st.DrawFn) -> sie.Profile:
    """Any kind, a sum of two, moved, mirrored."""
    profile = draw(round_profiles)
    if draw(st.integers(0, 3)) == 0:
        profile = profile + draw(round_profiles).shifted(draw(dyadic(-0.5, 0.5)))
    if draw(st.integers(0, 3)) == 0:
        profile = profile.mirrored()
    if draw(st.integers(0, 3)) == 0:
        profile = profile.shifted(draw(dyadic(-1, 1)))
    return profile


@st.composite
def scenes(draw: st.DrawFn, profile: sie.Profile | None = None, sharp: bool = True) -> sie.Scene:
    """A profile, a load, and a tilt that the profile's slopes can bear."""
    if profile is None and sharp and draw(st.integers(0, 4)) == 0:
        E, P, tilt = draw(log_between(0.1, 10)), draw(log_between(1e-3, 3)), draw(dyadic(-0.2, 0.2))
        return sie.Scene(profile=draw(sharp_profiles()), modulus=E, normal_load=P, tilt=tilt)
    profile = profile or draw(profiles())
    tilt = draw(st.one_of(st.just(0.0), dyadic(-1 / 16, 1 / 16)))
    E = draw(log_between(0.1, 10))
    return sie.Scene(
        profile=profile, modulus=E, normal_load=E * draw(log_between(1e-3, 3)), tilt=tilt
    )
