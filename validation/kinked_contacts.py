"""Random contacts whose right edge lies on or beside a break of the slope.

The slope is piecewise polynomial. The load at which the edge is on the break, or the half-width, is
missed by a relative 1e-15 to 1e-4 to either side, and the scene is given with its tilt or with its
moment. Only contacts with p > 0 and an open gap beside them are drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import sie
from oracles.polynomial_pieces import Exact, Number, Rows, mp

LEFT = mp.mpf(10) ** -45  # of the conditions, relative
SCANNED = 60  # points where the sign of the pressure is tested
CLOSED = 1e-3  # of the slopes in the contact times r: a smaller gap beside it may be none


@dataclass(frozen=True)
class Shape:
    """A profile of the package, its slope in exact numbers, and where h' jumps."""

    profile: sie.Profile
    breaks: tuple[Number, ...]
    rows: Rows
    jumps: frozenset[float] = frozenset()
    symmetric: bool = False

    def contact(self, x1: Number, x2: Number, tilt: Number = 0) -> Exact:
        rows = tuple((origin, (row[0] + tilt, *row[1:])) for origin, row in self.rows)
        return Exact(self.breaks, rows, x1, x2)


def rounded(rng: np.random.Generator) -> Shape:
    a, R = 10.0 ** rng.uniform(-1, 0.5, 2)
    profile = sie.RoundedFlat(a, R)
    rim, e = (mp.zero, 1 / mp.mpf(R)), mp.mpf(a)
    return Shape(profile, (-e, e), ((-e, rim), (mp.zero, (mp.zero,)), (e, rim)))


def chain(rng: np.random.Generator, *, degree: int = 1, jumps: bool = False) -> Shape:
    """2 to 6 pieces of random polynomials, that meet but for rounding, or jump upwards; the outer
    two are steep straight lines.
    """
    n = int(rng.integers(2, 7))
    breaks = np.sort(rng.uniform(-1.5, 1.5, n - 1)).tolist()
    rows: list[list[float]] = []
    value = -rng.uniform(0.0, 1.0)
    jumping = []
    for k in range(n):
        outer = k in (0, n - 1)
        c = [rng.uniform(0.3, 3.0)] if outer else [rng.choice([0.0, rng.uniform(0.0, 3.0)])]
        if not outer and degree > 1:
            c = [c[0], *rng.normal(0.0, 1.0, degree - 1)]
        b = breaks[0] if k == 0 else breaks[k - 1]
        if k and jumps and rng.random() < 0.6:
            value += rng.uniform(0.01, 1.0)
            jumping.append(b)
        rows.append(_through(b, value, c))
        if 0 < k < n - 1:
            value = float(np.polynomial.polynomial.polyval(breaks[k], rows[-1]))
    exact = tuple((mp.zero, tuple(map(mp.mpf, row))) for row in rows)
    return Shape(sie.Piecewise(breaks, rows), tuple(map(mp.mpf, breaks)), exact, frozenset(jumping))


def mirrored(rng: np.random.Generator) -> Shape:
    """A symmetric profile of straight pieces, whose edges leave two breaks at once; h' may jump
    there.
    """
    breaks = np.sort(rng.uniform(0.1, 1.5, int(rng.integers(1, 4)))).tolist()
    value, jumping = 0.0, []
    rows = [[0.0, rng.uniform(0.0, 1.0)]]
    for b in breaks:
        value = float(np.polynomial.polynomial.polyval(b, rows[-1]))
        if rng.random() < 0.5:
            value += rng.uniform(0.01, 1.0)
            jumping += [b, -b]
        rows.append(_through(b, value, [rng.uniform(0.1, 3.0)]))
    pieces = [[-row[0], row[1]] for row in rows[:0:-1]] + rows
    ends = [-b for b in breaks[::-1]] + breaks
    exact = tuple((mp.zero, tuple(map(mp.mpf, row))) for row in pieces)
    return Shape(
        sie.Piecewise(ends, pieces),
        tuple(map(mp.mpf, ends)),
        exact,
        frozenset(jumping),
        symmetric=True,
    )


def _through(b: float, value: float, c: Sequence[float]) -> list[float]:
    """Coefficients in x of value + Σ c_j (x - b)^(j+1)."""
    p = np.polynomial.Polynomial([value, *c])(np.polynomial.Polynomial([-b, 1.0]))
    return [float(v) for v in p.coef]


KINDS: dict[str, Callable[[np.random.Generator], Shape]] = {
    "rounded flat": rounded,
    "straight pieces": chain,
    "straight pieces, jumps of h'": lambda rng: chain(rng, jumps=True),
    "cubic pieces": lambda rng: chain(rng, degree=3),
    "quadratic pieces, jumps of h'": lambda rng: chain(rng, degree=2, jumps=True),
    "symmetric pieces": mirrored,
}
GIVEN = ("load, tilt", "load, moment", "half-width, tilt")
ASKED = (
    *((kind, given) for kind in KINDS for given in GIVEN if kind != "symmetric pieces"),
    ("symmetric pieces", "load, tilt"),
)


@dataclass(frozen=True)
class Trial:
    """A scene, and the break beside which its right edge lies."""

    shape: Shape
    scene: sie.Scene
    at: float
    # The relative distance of the load or half-width from the one that puts the edge on the break
    missed: float


def trial(rng: np.random.Generator, shape: Shape, given: str) -> Trial | None:
    """None where one patch with that edge would be in tension or would need no load."""
    at = float(rng.choice([float(b) for b in shape.breaks if b > 0 or not shape.symmetric]))
    left = -at if shape.symmetric else at - 10.0 ** rng.uniform(-1.5, 0.7)
    bare = shape.contact(mp.mpf(left), mp.mpf(at))
    tilt = 0.0 if shape.symmetric else float(-bare.integral((1,))[0] / mp.pi)
    if bare.integral((0, 1))[0] <= 0.0:
        return None
    x1 = (
        mp.mpf(left)
        if shape.symmetric
        else _left_edge(shape, mp.mpf(left), mp.mpf(at), mp.mpf(tilt))
    )
    touched = shape.contact(x1, mp.mpf(at), mp.mpf(tilt))
    modulus = float(10.0 ** rng.uniform(-2, 2))
    G = mp.mpf(modulus) / 2
    I1, C2 = touched.integral((0, 1), (1, 0, -1))
    load = G * touched.r * I1
    moment = touched.m * load - G * touched.r**2 * C2
    if load <= 0 or not _presses(touched):
        return None
    missed = float(rng.choice((-1, 1)) * 10.0 ** rng.uniform(-15, -4))
    scene: dict[str, Any] = {
        "load, tilt": {"normal_load": float(load * (1 + missed)), "tilt": tilt},
        "load, moment": {"normal_load": float(load * (1 + missed)), "moment": float(moment)},
        "half-width, tilt": {"half_width": float(touched.r * (1 + missed)), "tilt": tilt},
    }[given]
    return Trial(shape, sie.Scene(profile=shape.profile, modulus=modulus, **scene), at, missed)


def _left_edge(shape: Shape, x1: Number, x2: Number, tilt: Number) -> Number:
    """x1 with ∫H dφ = 0, next to the given one: the tilt was rounded."""
    return mp.findroot(
        lambda x: shape.contact(x, x2, tilt).integral((1,))[0],
        (x1, x1 + (x2 - x1) * mp.mpf(10) ** -15),
        tol=LEFT**2,
    )


def _presses(contact: Exact) -> bool:
    """Whether p > 0 across the contact and the gap is open beside it, as one patch requires."""
    m, r = float(contact.m), float(contact.r)
    s = np.cos(np.pi * (np.arange(SCANNED) + 0.5) / SCANNED)
    if not all(contact.pressure(m + r * float(v), mp.mpf(1)) > 0 for v in s):
        return False
    reach = 2.0 * max(abs(float(b) - m) for b in contact.breaks) + r
    d = np.geomspace(1e-3 * r, reach, 10 * SCANNED)
    return all(bool((_gap(contact, m + side * (r + d)) > 0.0).all()) for side in (-1.0, 1.0))


def _gap(contact: Exact, x: np.ndarray) -> np.ndarray:
    """∫ g' dx outwards along ascending distances, g' = H + R/π ∫H/(t - x) dφ; to a few digits."""
    m, r = float(contact.m), float(contact.r)
    g, w = np.polynomial.legendre.leggauss(40)
    total = np.zeros_like(x)
    for lo, hi, c in contact.parts():
        phi = 0.5 * float(lo + hi) + 0.5 * float(hi - lo) * g
        s = np.sin(phi)
        H = np.polynomial.polynomial.polyval(s, [float(v) for v in c])
        total += (0.5 * float(hi - lo) * w * H) @ (1.0 / ((m + r * s)[:, None] - x))
    R = np.sign(x - m) * np.sqrt((x - m - r) * (x - m + r))
    k = np.searchsorted([float(b) for b in contact.breaks], x)
    scale = float(contact.integral((0, 1))[0]) / np.pi
    rows = [[float(c) for c in row] for _, row in contact.rows]
    H = np.array(
        [
            np.polynomial.polynomial.polyval(v - float(contact.rows[j][0]), rows[j])
            for v, j in zip(x, k, strict=True)
        ]
    )
    rises = np.append(0.0, H + R / np.pi * total)
    steps = np.diff(x, prepend=m + np.sign(x[0] - m) * r)
    return np.cumsum(0.5 * (rises[1:] + rises[:-1]) * steps) - CLOSED * scale * r * (
        np.abs(x - m) > 1.5 * r
    )


def drawn(seed: int, kind: str, given: str) -> Trial:
    """The first trial of a seed that has an answer."""
    rng = np.random.default_rng(seed)
    while True:
        asked = trial(rng, KINDS[kind](rng), given)
        if asked is not None:
            return asked
