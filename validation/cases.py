"""The contacts that are compared with the 40-digit reference.

Each is a profile of the package and, written separately, its slope for the reference.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

import sie
from oracles import normal_contact
from oracles.normal_contact import Pieces, mp, polynomials, smooth

INF = float("inf")


@dataclass(frozen=True)
class Case:
    """A scene without loads; `load` gives P with E* = 1, `width` the half-width; `sharp` the
    expected kind of edges.
    """

    name: str
    profile: sie.Profile
    pieces: Pieces
    load: float | None = None
    width: float | None = None
    tilt: float = 0.0
    symmetric: bool = False
    sharp: tuple[bool, bool] = (False, False)

    def __str__(self) -> str:
        given = f"P={self.load:g}" if self.load is not None else f"r={self.width:g}"
        return f"{self.name}-{given}" + (f"-tilt={self.tilt:g}" if self.tilt else "")

    @property
    def scene(self) -> sie.Scene:
        return sie.Scene(
            profile=self.profile,
            modulus=1.0,
            normal_load=self.load,
            half_width=self.width,
            tilt=self.tilt,
        )


@cache
def solved(case: Case) -> sie.Solution:
    return sie.solve(case.scene)


@cache
def exact(case: Case) -> normal_contact.Contact:
    """The answer in 40 digits; the solver's edges are only the start of Newton's method."""
    pieces = case.pieces.tilted(case.tilt) if case.tilt else case.pieces
    if all(case.sharp):
        assert case.load is not None
        return normal_contact.sharp_contact(pieces, 1.0, case.load)
    start = solved(case).edges
    return normal_contact.contact(
        pieces,
        1.0,
        start,
        load=case.load,
        half_width=case.width,
        symmetric=case.symmetric and not case.tilt,
        sharp=case.sharp,
    )


def rounded_slope(half_flat: float, radius: float) -> Pieces:
    a, R = mp.mpf(half_flat), mp.mpf(radius)
    return Pieces(
        (-mp.inf, -a, a, mp.inf), (lambda t: (t + a) / R, lambda t: 0 * t, lambda t: (t - a) / R)
    )


def power_slope(exponent: float, coefficient: float) -> Pieces:
    m, A = mp.mpf(exponent), mp.mpf(coefficient)
    return Pieces(
        (-mp.inf, mp.zero, mp.inf),
        (lambda t: -m * A * (-t) ** (m - 1), lambda t: m * A * t ** (m - 1)),
        kinks=(mp.zero,),
    )


def chain(seed: int, n: int) -> tuple[sie.Piecewise, Pieces]:
    """n linear pieces with exact coefficients, continuous, from -3/4 upwards."""
    rng = np.random.default_rng(seed)
    breaks = np.cumsum(rng.integers(8, 40, n - 1)) / 64 - n / 6
    curvatures = rng.integers(1, 32, n) / 8
    rows, value = [(-0.75 - curvatures[0] * breaks[0], curvatures[0])], -0.75
    for k, b in enumerate(breaks):
        rows.append((value - curvatures[k + 1] * b, curvatures[k + 1]))
        if k + 1 < len(breaks):
            value += curvatures[k + 1] * (breaks[k + 1] - b)
    pieces = [tuple(map(float, row)) for row in rows]
    inner = breaks.tolist()
    return sie.Piecewise(inner, pieces), polynomials((-INF, *inner, INF), pieces)


PUNCH = sie.RoundedFlat(0.5, 1.0)
# A flat whose corners have radii 2 and 1/2
CORNERS = sie.Piecewise((-0.5, 1.0), ((0.25, 0.5), (0.0,), (-2.0, 2.0)))
CORNERS_SLOPE = polynomials((-INF, -0.5, 1.0, INF), ((0.25, 0.5), (0.0,), (-2.0, 2.0)))
TWO_RADII = sie.Piecewise((0.0,), ((0.0, 1.0), (0.0, 3.0)))
TWO_RADII_SLOPE = polynomials((-INF, 0.0, INF), ((0.0, 1.0), (0.0, 3.0)))
BLUNT = sie.Wedge(0.25) + sie.Parabola(2.0)
BLUNT_SLOPE = polynomials((-INF, 0.0, INF), ((-0.25, 0.5), (0.25, 0.5)))
SINH = sie.FromFunction(np.sinh, domain=(-30.0, 30.0), parity="even")
BUMP = sie.FromFunction(lambda x: x * np.exp(-x * x / 2), domain=(-3.0, 3.0))
# h' is continuous at -1/4 and jumps up at 1/2
CUBIC = sie.Piecewise((-0.25, 0.5), ((0.0, 1.0), (0.1328125, 1.5, 0.0, 0.5), (0.0, 2.0)))
CUBIC_SLOPE = polynomials((-INF, -0.25, 0.5, INF), CUBIC.coefficients)
CUT = sie.FromFunction(np.sinh, domain=(-1.0, 0.5))
FOUR, SIX, EIGHT = (chain(seed, n) for seed, n in ((4, 4), (6, 6), (8, 8)))

SMOOTH_CASES = (
    Case("parabola", sie.Parabola(2.0), smooth(lambda t: t / 2), load=0.3, symmetric=True),
    Case("rounded", PUNCH, rounded_slope(0.5, 1.0), width=1.0, symmetric=True),
    Case("rounded", PUNCH, rounded_slope(0.5, 1.0), load=0.2, symmetric=True),
    Case("rounded", PUNCH, rounded_slope(0.5, 1.0), load=0.2, tilt=0.05),
    Case("rounded", PUNCH, rounded_slope(0.5, 1.0), width=1.0, tilt=-0.05),
    Case("sinh", SINH, smooth(mp.sinh), width=1.5, symmetric=True),
    Case("sinh", SINH, smooth(mp.sinh), load=1.0, symmetric=True),
    Case("bump", BUMP, smooth(lambda x: x * mp.exp(-x * x / 2)), width=0.75),
    Case("bump", BUMP, smooth(lambda x: x * mp.exp(-x * x / 2)), load=0.1, tilt=0.1),
    Case("corners", CORNERS, CORNERS_SLOPE, width=1.125),
    Case("corners", CORNERS, CORNERS_SLOPE, load=0.2),
    Case("two radii", TWO_RADII, TWO_RADII_SLOPE, width=0.25),
    Case("two radii", TWO_RADII, TWO_RADII_SLOPE, load=0.7),
    Case("blunt", BLUNT, BLUNT_SLOPE, width=1.0, symmetric=True),
    Case("blunt", BLUNT, BLUNT_SLOPE, load=0.4, symmetric=True),
    Case("blunt", BLUNT, BLUNT_SLOPE, width=1.0, tilt=0.125),
    Case("cubic", CUBIC, CUBIC_SLOPE, load=1.5),
    Case("four", *FOUR, load=0.9),
    Case("six", *SIX, width=0.8),
    Case("eight", *EIGHT, load=0.9),
    Case("|x|^2.5", sie.Power(2.5, 0.75), power_slope(2.5, 0.75), width=1.0, symmetric=True),
    Case("|x|^1.5", sie.Power(1.5, 0.75), power_slope(1.5, 0.75), load=0.3, symmetric=True),
    Case("|x|^7", sie.Power(7, 0.5), power_slope(7, 0.5), width=1.0, symmetric=True),
)
SHARP_CASES = (
    Case("flat", sie.Flat(1.0), polynomials((-1.0, 1.0), ((0.0,),)), load=1.0, sharp=(True, True)),
    Case("flat", sie.Flat(1.0), polynomials((-1.0, 1.0), ((0.0,),)), load=1.0, tilt=0.125,
         sharp=(True, True)),
    Case("flat", sie.Flat(1.0), polynomials((-1.0, 1.0), ((0.0,),)), load=1.0, tilt=1.5,
         sharp=(True, False)),
    Case("flat", sie.Flat(1.0), polynomials((-1.0, 1.0), ((0.0,),)), load=1.0, tilt=-1.5,
         sharp=(False, True)),
    Case("cut", CUT, smooth(mp.sinh, -1.0, 0.5), load=5.0, sharp=(True, True)),
    Case("cut", CUT, smooth(mp.sinh, -1.0, 0.5), load=0.6, sharp=(False, True)),
    Case("cut", CUT, smooth(mp.sinh, -1.0, 0.5), load=0.1),
    Case("cut", CUT, smooth(mp.sinh, -1.0, 0.5), width=0.625, sharp=(False, True)),
    Case("cut", CUT, smooth(mp.sinh, -1.0, 0.5), load=5.0, tilt=0.25, sharp=(True, True)),
    Case(
        "cut chain", sie.Piecewise((-1.0, 0.0, 0.5), ((0.0, 0.5), (0.0, 2.0))),
        polynomials((-1.0, 0.0, 0.5), ((0.0, 0.5), (0.0, 2.0))),
        load=2.0, sharp=(True, True),
    ),
)  # fmt: skip
CASES = SMOOTH_CASES + SHARP_CASES
QUICK = ("parabola", "rounded", "sinh", "blunt", "eight", "|x|^2.5", "flat")


def chosen(quick: bool) -> Iterator[Case]:
    """All, or the first of each of a few kinds."""
    seen: set[str] = set()
    for case in CASES:
        if not quick or (case.name in QUICK and case.name not in seen):
            seen.add(case.name)
            yield case


def points(case: Case) -> np.ndarray:
    """Points off every grid: across the contact, next to breaks, and to within 1e-3 r of the edges.

    Nearer to an edge p is rounding of the edge itself.
    """
    solution = solved(case)
    (x1, x2), r, m = solution.edges, solution.half_width, solution.centre
    x = [m + r * s for s in (-0.999, -0.71, -0.29, 0.013, 0.21, 0.57, 0.91, 0.999)]
    for b in case.profile.breaks:
        x += [b - 1e-6 * r, b + 1e-3 * r, b + 1e-6 * r]
    return np.array([t for t in x if x1 + 0.9e-3 * r < t < x2 - 0.9e-3 * r])
