"""V and V' in the body of a slope with many pieces: the formulas of `potential`, at a cost close to linear in pieces plus points.

As in `batched`: far branches as sums of Cauchy kernels with their derivatives, near ones in arrays of pairs (piece, point). Where both
pieces at a break are near a point, the poles 1/(z - e) of their derivatives are taken together: they cancel but for a jump of the slope.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.cauchy_sums import add_pairs, chunks

from .many_panels import Index, place, within

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class Points(NamedTuple):
    """Points of the upper half-plane with z - x1, z - x2, the roots of both, R, (z - x1)(z - x2)/R, and that times R': here R, z - m."""

    z: Complex
    left: Complex
    right: Complex
    root1: Complex
    root2: Complex
    R: Complex
    divisor: Complex
    mean: Complex

    def at(self, where: Any) -> Points:
        return Points(*(values[where] for values in self))


class Frame(Protocol):
    """What a `Plane` knows of the edges' exponents."""

    panels: Any

    def points(self, z: Complex) -> Points: ...
    def weight(self, end: tuple[Any, Any, Any]) -> Any: ...
    def logarithm(self, end: tuple[Any, Any, Any], at: Points) -> Complex: ...


class _Series(NamedTuple):
    """Of every piece, as columns: H and the ends' polynomial in T_n(s), H', Q and Q' in U_n(s); see `potential`."""

    H: Array
    dH: Array
    ends: Array
    Q: Array
    dQ: Array


class _Poles(NamedTuple):
    """Of every piece: breaks and w there at (lo, hi), H entering at lo and leaving at hi, both 0 at an edge; the jump at hi."""

    e: Array
    w: Array
    entering: Array
    leaving: Array
    jump: Array


class BatchedPlane:
    """The near field of a `Plane` whose panels are many."""

    def __init__(self, plane: Frame) -> None:
        self.plane, self.panels = plane, plane.panels

    def near(self, z: Complex) -> tuple[Complex, Complex]:
        """(V, V') at z (1-d), Im z > 0."""
        V, dV = np.empty_like(z), np.empty_like(z)
        for part in chunks(len(z)):
            V[part], dV[part] = self._chunk(self.plane.points(z[part]))
        return V, dV

    def _chunk(self, at: Points) -> tuple[Complex, Complex]:
        pieces = self.panels.batched
        S, dS, k, i = pieces.sums.far_pair(at.z)
        s = place(pieces, k, at.z[i])
        near = within(pieces, k, s)
        beyond = ~near
        if beyond.any():
            self._add_quadrature(k[beyond], i[beyond], at.z, (S, dS))
        V, N, dV = at.R * S, at.mean * S + at.left * at.right * dS, np.zeros_like(S)
        self._add_closed(k[near], i[near], s[near], at, (V, dV, N))
        return V, dV + N / at.divisor

    def _add_quadrature(self, k: Index, i: Index, z: Complex, to: tuple[Complex, Complex]) -> None:
        pieces, g = self.panels.batched, self.panels.geometry
        pole = np.reciprocal(pieces.offset[k] - ((z[i] - g.ends[0][k]) - g.tails[0][k])[:, None])
        add_pairs(to[0], i, (pieces.charge[k] * pole).sum(axis=1))
        add_pairs(to[1], i, (pieces.charge[k] * (pole * pole)).sum(axis=1))

    def _add_closed(
        self, k: Index, i: Index, s: Complex, points: Points, to: tuple[Complex, Complex, Complex]
    ) -> None:
        V, dV, N = to
        c, at = self._series, points.at(i)
        J0 = self._angles(k, at)
        Q = chebyshev.evaluate_second_kind(c.Q[:, k], s)
        add_pairs(V, i, chebyshev.evaluate(c.H[:, k], s) * J0 + at.R * Q)
        add_pairs(dV, i, chebyshev.evaluate_second_kind(c.dH[:, k], s) * J0)
        steep = (
            at.mean * Q
            + chebyshev.evaluate(c.ends[:, k], s)
            + at.left * at.right * chebyshev.evaluate_second_kind(c.dQ[:, k], s)
        )
        add_pairs(N, i, steep + self._poles_at(k, i, at.z))

    def _angles(self, k: Index, at: Points) -> Complex:
        """L_hi - L_lo of each pair; at the edges they are 0 and π/cos πε."""
        g, last = self.panels.geometry, len(self.panels.series) - 1
        J0 = np.zeros(len(k), dtype=complex)
        for end, sign, edge in (
            (1, 1.0, last if g.cut_right else -1),
            (0, -1.0, 0 if g.cut_left else -1),
        ):
            inner = np.flatnonzero(k != edge)
            of = k[inner]
            J0[inner] += sign * self.plane.logarithm(
                (g.ends[end][of], g.root_left[end][of], g.root_right[end][of]), at.at(inner)
            )
        if g.cut_left:
            J0[k == 0] -= np.pi / self.panels.cos
        return J0

    def _poles_at(self, k: Index, i: Index, z: Complex) -> Complex:
        p = self._poles
        pair = i * (len(p.jump) + 1) + k
        known = np.sort(pair)

        def is_near(other: Index) -> NDArray[np.bool_]:
            place = np.minimum(np.searchsorted(known, other), len(known) - 1)
            found: NDArray[np.bool_] = known[place] == other
            return found

        with_next, with_previous = (
            is_near(pair + 1) & (k < len(p.jump) - 1),
            is_near(pair - 1) & (k > 0),
        )
        at_hi = np.where(with_next, p.jump[k], -p.leaving[k])
        at_lo = np.where(with_previous, 0.0, p.entering[k])
        out = np.zeros_like(z)
        for end, value in ((0, at_lo), (1, at_hi)):
            here = np.flatnonzero(value)
            out[here] += p.w[end][k[here]] * value[here] / (z[here] - p.e[end][k[here]])
        return out

    # -- what depends on the pieces only ------------------------------------------------------------------------------

    @cached_property
    def _poles(self) -> _Poles:
        p, g = self.panels, self.panels.geometry
        w = np.asarray(self.plane.weight((0.0, g.root_left, g.root_right)))
        entering, leaving = p.series @ (-1.0) ** np.arange(p.degree + 1), p.series.sum(axis=1)
        jump = np.append(entering[1:] - leaving[:-1], 0.0)
        jump[~np.isin(g.ends[1], [e for e, _ in p.jumps])] = 0.0  # equal but for rounding
        if g.cut_left:
            entering[0] = w[0, 0] = 0.0
        if g.cut_right:
            leaving[-1] = w[1, -1] = 0.0
        return _Poles(g.ends, w, entering, leaving, jump)

    @cached_property
    def _series(self) -> _Series:
        p = self.panels
        n, half = p.degree + 1, p.half_length[:, None]
        w = self._poles.w
        divided = [chebyshev.divided(np.eye(n), sign) for sign in (-1.0, 1.0)]
        ends = (
            w[0][:, None] * (p.series @ divided[0]) - w[1][:, None] * (p.series @ divided[1])
        ) / half
        dH = np.arange(1, n) * p.series[:, 1:] / half
        dQ = (
            p._continuation @ chebyshev.second_kind_derivative(np.eye(n - 1)) / half
            if n > 1
            else np.zeros((len(half), 0))
        )
        return _Series(
            p.series.T, dH.T, ends.T if n > 1 else np.zeros((1, len(half))), p._continuation.T, dQ.T
        )
