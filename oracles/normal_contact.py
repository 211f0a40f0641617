"""The normal contact in 40 digits, by quadrature alone: the reference for the solver.

Nothing here comes from the package under test. A profile is the list of its slope's pieces, each an
analytic function of an mpmath number; the contact is found by Newton's method on the conditions,
the pressure and its potential are one Gauss-Legendre quadrature:

    G = E*/2,  t = m + r sin φ,  w = r cos φ,  R(z) = sqrt(z - x1) sqrt(z - x2)
    e the piece next to z, continued to z

    both edges smooth    ∫H dφ = 0,  P = G r ∫H sin φ dφ
                         F(z) = G H_e(z) - G/π R(z) ∫ (H(t) - H_e(z)) / (t - z) dφ
    any edges            F(z) = G H_e(z) + 1/(π R(z)) [P - π G H_e(z) (z - m)
                                + G ∫ (H(t) - H_e(z)) w² / (t - z) dφ]
    M                    = m P - G ∫H w² dφ

and p = -Im F(x + i0). The first integrand is entire on the piece e and has a pole at z on the
others, towards which the panels are halved until the pole is half a panel away: 32 nodes then leave
1e-36. (Muskhelishvili 1953, §§ 107-113; ∫dt/(w(t-z)) = -π/R.)
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from itertools import pairwise
from typing import Any, NamedTuple

import mpmath

from oracles.ends import Between

mp = mpmath.mp.clone()
mp.dps = 40
NODES = 32
LONGEST = 0.6  # of a panel in φ, where only the slope's own analyticity counts
# Panels are halved down to this towards a break where the slope is not analytic from either side
KINK = mpmath.mpf(10) ** -14

KNOT = mpmath.mpf(10) ** -38  # the same towards a pole that is a break itself

Number = Any


@lru_cache(maxsize=4)
def gauss_legendre(n: int = NODES) -> tuple[list[Number], list[Number]]:
    """Nodes and weights on [0, 1] in the context's precision."""
    nodes, weights = [], []
    for k in range(n):
        x = mp.cos(mp.pi * (k + mp.mpf(3) / 4) / (n + mp.mpf(1) / 2))
        for _ in range(8):
            before, at = mp.one, x
            for j in range(2, n + 1):
                before, at = at, ((2 * j - 1) * x * at - (j - 1) * before) / j
            derivative = n * (before - x * at) / (1 - x * x)
            x -= at / derivative
        nodes.append((1 + x) / 2)
        weights.append(1 / ((1 - x * x) * derivative**2))
    return nodes, weights


@dataclass(frozen=True)
class Pieces:
    """A slope: `functions[k]` between `breaks[k]` and `breaks[k + 1]`; the outer breaks are the
    ends of the indenter, maybe infinite.
    """

    breaks: tuple[Number, ...]
    functions: tuple[Callable[[Number], Number], ...]
    # Breaks where a function itself is not analytic, like |x|^1.5 at 0
    kinks: tuple[Number, ...] = ()

    def tilted(self, tilt: float) -> "Pieces":
        return Pieces(
            self.breaks,
            tuple(partial(_tilted, f, mp.mpf(tilt)) for f in self.functions),
            self.kinks,
        )

    def __call__(self, x: Number) -> Number:
        return self.functions[self.index(x)](x)

    def index(self, x: Number) -> int:
        inner = self.breaks[1:-1]
        return sum(x > b for b in inner)


def _tilted(function: Callable[[Number], Number], tilt: Number, t: Number) -> Number:
    return function(t) + tilt


def polynomials(breaks: Sequence[float], rows: Sequence[Sequence[float]]) -> Pieces:
    """Pieces from coefficients in x, low order first."""
    exact = [[mp.mpf(c) for c in row] for row in rows]
    return Pieces(tuple(map(mp.mpf, breaks)), tuple(partial(_horner, c) for c in exact))


def smooth(function: Callable[[Number], Number], lo: float = -mp.inf, hi: float = mp.inf) -> Pieces:
    return Pieces((mp.mpf(lo), mp.mpf(hi)), (function,))


@dataclass(frozen=True)
class Contact(Between):
    """The answer for a slope: edges, load, moment (about x = 0), G = E*/2; `sharp` tells whether an
    edge may be singular.
    """

    pieces: Pieces
    G: Number
    x1: Number
    x2: Number
    P: Number
    sharp: bool = False

    @property
    def M(self) -> Number:
        return self.m * self.P - self.G * self.integral(lambda t, w, H: H * w * w)

    def angle(self, x: Number) -> Number:
        if x in (self.x1, self.x2):  # the rounding of s would take the root of 1e-40 from the angle
            return -mp.pi / 2 if x == self.x1 else mp.pi / 2
        s = (x - self.m) / self.r
        return mp.asin(s) if mp.im(s) else mp.asin(min(max(s, -mp.one), mp.one))

    def integral(
        self,
        f: Callable[[Number, Number, Number], Number],
        pole: Number | None = None,
        free: int = -1,
    ) -> Number:
        """∫ f(t, w, H(t)) dφ over the contact."""
        return sum((weight * f(t, w, H) for t, w, H, weight in self.nodes(pole, free)), mp.zero)

    def nodes(self, pole: Number | None = None, free: int = -1) -> Iterator[tuple[Number, ...]]:
        """(t, w, H(t), weight) in φ across the contact; panels halved towards `pole`, except on the
        piece `free`, and towards kinks.
        """
        pole_angle = None if pole is None else mp.asin((pole - self.m) / self.r)
        poles = () if pole is None else (pole_angle, mp.pi - pole_angle)
        kinks = [self.angle(b) for b in self.pieces.kinks if self.x1 < b < self.x2]
        for k, (start, end) in enumerate(pairwise(self.pieces.breaks)):
            lo, hi = max(start, self.x1), min(end, self.x2)
            if lo < hi:
                for a, b in _panels(
                    self.angle(lo), self.angle(hi), () if k == free else poles, kinks
                ):
                    yield from self._nodes(k, a, b)

    @cached_property
    def _kept(self) -> dict[Any, list[tuple[Number, ...]]]:
        return {}

    def _nodes(self, k: int, a: Number, b: Number) -> list[tuple[Number, ...]]:
        """(t, w, H, weight) on a panel; the same panels serve many poles."""
        if (k, a, b) not in self._kept:
            rows = []
            for node, weight in zip(*gauss_legendre(), strict=True):
                cos, sin = mp.cos_sin(a + (b - a) * node)
                t = self.m + self.r * sin
                rows.append((t, self.r * cos, self.pieces.functions[k](t), (b - a) * weight))
            self._kept[k, a, b] = rows
        return self._kept[k, a, b]

    def pressure(self, x: float) -> Number:
        """p(x) inside, by the real form of F."""
        x = mp.mpf(x)
        e = self.pieces.index(x)
        H, left, right = self.pieces.functions[e](x), x - self.x1, self.x2 - x
        if left <= 0 or right <= 0:
            return mp.zero
        w = mp.sqrt(left * right)
        if not self.sharp:
            return self.G / mp.pi * w * self.integral(lambda t, w, Ht: (Ht - H) / (t - x), x, e)
        integral = self.integral(lambda t, w, Ht: (Ht - H) * w * w / (t - x), x, e)
        return (self.P - mp.pi * self.G * H * (x - self.m) + self.G * integral) / (mp.pi * w)

    def potential(self, z: complex) -> Number:
        """F(z) = 1/π ∫ p(t)/(z - t) dt off the contact (real z beside it included)."""
        z = mp.mpmathify(z)
        nearest = min(max(mp.re(z), self.x1), self.x2)
        e = self.pieces.index(
            nearest - self.r * mp.mpf("1e-30")
            if nearest == self.x2
            else nearest + self.r * mp.mpf("1e-30")
        )
        H = self.pieces.functions[e](z)
        # Far away no pole is to be subtracted, and a continued polynomial would grow.
        if abs(z - nearest) > self.r:
            H, e = mp.zero, -1
        root = mp.sqrt(z - self.x1) * mp.sqrt(z - self.x2)
        if not self.sharp:
            return self.G * H - self.G / mp.pi * root * self.integral(
                lambda t, w, Ht: (Ht - H) / (t - z), z, e
            )
        integral = self.integral(lambda t, w, Ht: (Ht - H) * w * w / (t - z), z, e)
        return self.G * H + (self.P - mp.pi * self.G * H * (z - self.m) + self.G * integral) / (
            mp.pi * root
        )

    def gap(self, x: float) -> Number:
        """∫ (H - F/G) from the nearer edge to x, in θ with x = edge ± 2 r sinh²(θ/2), where the
        root disappears.
        """
        x = mp.mpf(x)
        right = x > self.m
        distance = x - self.x2 if right else self.x1 - x
        end = 2 * mp.asinh(mp.sqrt(distance / (2 * self.r)))

        def at(theta: Number) -> Number:
            d = 2 * self.r * mp.sinh(theta / 2) ** 2
            s = self.x2 + d if right else self.x1 - d
            slope = self.pieces(s) - mp.re(self.potential(s)) / self.G
            return (slope if right else -slope) * self.r * mp.sinh(theta)

        cuts = [mp.zero, end]
        for b in self.pieces.breaks:
            d = b - self.x2 if right else self.x1 - b
            if mp.isfinite(b) and 0 < d < distance:
                cuts.append(2 * mp.asinh(mp.sqrt(d / (2 * self.r))))
        g, w = gauss_legendre(16)
        total, stack = mp.zero, list(pairwise(sorted(cuts)))
        while stack:
            a, b = stack.pop()
            if b - a > LONGEST:
                stack += [(a, (a + b) / 2), ((a + b) / 2, b)]
            else:
                total += (b - a) * sum(
                    weight * at(a + (b - a) * node) for node, weight in zip(g, w, strict=True)
                )
        return total


def _horner(c: Sequence[Number], t: Number) -> Number:
    total = 0 * t
    for a in reversed(c):
        total = total * t + a
    return total


def _panels(
    lo: Number, hi: Number, poles: Sequence[Number], kinks: Sequence[Number]
) -> list[tuple[Number, Number]]:
    done, stack = [], [(lo, hi)]
    while stack:
        a, b = stack.pop()
        length = b - a
        near = min((_distance(p, a, b) for p in poles), default=mp.inf)
        kink = min((_distance(p, a, b) for p in kinks), default=mp.inf)
        if (
            length > LONGEST
            or (length > 2 * near and length > KNOT)
            or (length > 2 * kink and length > KINK)
        ):
            stack += [(a, (a + b) / 2), ((a + b) / 2, b)]
        else:
            done.append((a, b))
    return done


def _distance(p: Number, a: Number, b: Number) -> Number:
    return abs(p - min(max(mp.re(p), a), b))


def sharp_contact(pieces: Pieces, modulus: float, load: float) -> Contact:
    """The whole of an indenter with two ends."""
    return Contact(
        pieces, mp.mpf(modulus) / 2, pieces.breaks[0], pieces.breaks[-1], mp.mpf(load), sharp=True
    )


def contact(
    pieces: Pieces, modulus: float, guess: tuple[float, float], *,
    load: float | None = None, half_width: float | None = None,
    symmetric: bool = False, sharp: tuple[bool, bool] = (False, False),
) -> Contact:  # fmt: skip
    """Edges, load and moment from the conditions, to 30 digits: Newton from a guess, with the
    residual verified.

    symmetric    about x = 0: ∫H dφ = 0 holds by itself
    sharp        one end of the indenter is an edge; the other is smooth, P = G r ∫H (1 ± sin φ) dφ
    """
    sought = _Sought(
        pieces,
        mp.mpf(modulus) / 2,
        None if load is None else mp.mpf(load),
        None if half_width is None else mp.mpf(half_width),
        symmetric,
    )
    x1, x2 = map(mp.mpf, guess)
    if any(sharp):
        return sought.sharp_on_one_side(sharp[0], x2 if sharp[0] else x1)
    c = sought.about_axis((x2 - x1) / 2) if symmetric else sought.smooth(x1, x2)
    return sought.built(c.x1, c.x2, sought.carried(c) if sought.P is None else sought.P)


class _Sought(NamedTuple):
    """A contact given by its load or by its half-width, and what it carries."""

    pieces: Pieces
    G: Number
    P: Number | None
    r: Number | None
    symmetric: bool

    def built(self, x1: Number, x2: Number, load: Number = mp.zero, sharp: bool = False) -> Contact:
        return Contact(self.pieces, self.G, x1, x2, load, sharp)

    def integrals(self, c: Contact) -> tuple[Number, Number]:
        """∫H dφ and ∫H sin φ dφ."""
        I0 = mp.zero if self.symmetric else c.integral(lambda t, w, H: H)
        return I0, c.integral(lambda t, w, H: H * (t - c.m)) / c.r

    def carried(self, c: Contact, sign: int = 0) -> Number:
        """G r ∫H (sin φ + sign) dφ, the load of a contact whose edge on that side is smooth."""
        I0, I1 = self.integrals(c)
        return self.G * c.r * (I1 + sign * I0)

    def sharp_on_one_side(self, left: bool, start: Number) -> Contact:
        end, sign = (self.pieces.breaks[0], 1) if left else (self.pieces.breaks[-1], -1)

        def up_to(edge: Number, load: Number = mp.zero) -> Contact:
            return self.built(*((end, edge) if left else (edge, end)), load, sharp=True)

        if self.r is not None:
            edge = end + 2 * self.r * sign
            return up_to(edge, self.carried(up_to(edge), sign))
        (edge,) = _root(lambda v: [self.carried(up_to(v[0]), sign) / self.P - 1], [start])
        return up_to(edge, self.P)

    def about_axis(self, start: Number) -> Contact:
        r = self.r
        if r is None:
            (r,) = _root(lambda v: [self.carried(self.built(-v[0], v[0])) / self.P - 1], [start])
        return self.built(-r, r)

    def smooth(self, x1: Number, x2: Number) -> Contact:
        if self.r is not None:
            r = self.r
            balance = lambda v: [self.integrals(self.built(v[0] - r, v[0] + r))[0]]  # noqa: E731
            (m,) = _root(balance, [(x1 + x2) / 2], scale=r)
            return self.built(m - r, m + r)
        slope = max(abs(self.pieces(x1)), abs(self.pieces(x2)))

        def conditions(v: Sequence[Number]) -> list[Number]:
            I0, I1 = self.integrals(c := self.built(*v))
            return [I0 / slope, self.G * c.r * I1 / self.P - 1]

        return self.built(*_root(conditions, [x1, x2], scale=(x2 - x1) / 2))


def _root(
    function: Callable[[Sequence[Number]], list[Number]], start: list[Number], scale: Number = 0
) -> list[Number]:
    """Newton with finite differences in 40 digits; the last step must be below 1e-28 of the
    scale.
    """
    v = list(start)
    scale = scale or max(abs(x) for x in v)
    for _ in range(60):
        f = function(v)
        h = scale * mp.mpf(10) ** -16
        columns = []
        for j in range(len(v)):
            moved = list(v)
            moved[j] += h
            columns.append([(a - b) / h for a, b in zip(function(moved), f, strict=True)])
        J = mp.matrix(len(f), len(v))
        for j, column in enumerate(columns):
            for i, value in enumerate(column):
                J[i, j] = value
        step = mp.lu_solve(J, -mp.matrix(f))
        v = [x + s for x, s in zip(v, step, strict=True)]
        # The convergence is quadratic, with a slope known to 1e-16: what is left is below 1e-33.
        if max(abs(s) for s in step) < scale * mp.mpf(10) ** -20:
            return v
    raise AssertionError(f"the reference did not converge from {start}")
