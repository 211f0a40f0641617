"""The pressure on several patches: values, loads, potential.

    p(x) = (E*/2π) |T_i(x)| D_i(x) on patch i
    F(z) = (E*/2) (H(z) + θ - T_i(z) D_i(z)/π) anywhere

with H continued from the nearest piece, or any constant: F does not depend on it. Per period F is
1/λ ∫ p(t) cot(π(z - t)/λ) dt, the sum over all repetitions.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.numerics.chord import Points
from sie.progress_bar import reported
from sie.traction.base import Density, in_order, on_surface, reflected, zero_or_nan

from .measure import Targets
from .operator import Operator, at_edges, blocks, on_patches
from .rule import Rule, rule_of

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]

AROUND = 16  # points of a circle that give a derivative ...
NARROW = 0.125  # ... of this part of the distance to the nearest traction


@dataclass(frozen=True, eq=False)
class PatchPressure(Density):
    """The pressure of an operator whose edges are found.

    half_modulus    E*/2
    tilt            what is added to H
    load            ∫p dx over all patches, per period
    """

    operator: Operator
    half_modulus: float
    tilt: float
    load: float

    @property
    def period(self) -> float:
        return self.operator.patches.chord.period

    @property
    def interval(self) -> tuple[float, float]:
        P = self.operator.patches
        return float(P.a[0]), float(P.b[-1])

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        return self.operator.patches.zones

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return self.load

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        if self.operator.patches.chord.periodic:
            return float((self.rule.weight * self.at_rule) @ self.rule.points.x)
        return self.half_modulus * self.operator.resultants(self.tilt)[1]

    @cached_property
    def loads(self) -> tuple[float, ...]:
        """∫p over each patch."""
        loads = np.bincount(self.rule.patch, self.rule.weight * self.at_rule)
        return tuple(loads.tolist())

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        o = self.operator
        P = o.patches
        inner = [
            o.pieces.breaks[(o.pieces.breaks > a) & (o.pieces.breaks < b)] for a, b in self.patches
        ]
        return tuple(np.unique(np.concatenate((P.edges, *inner))).tolist())

    # -- on the line -------------------------------------------------------------------------------

    def placed(self, x: Array) -> tuple[Points, Index, NDArray[np.bool_]]:
        """The places x by the nearest edge of a patch.

        With them come the patch that each is nearest to, and whether it is on that.
        """
        P = self.operator.patches
        if P.chord.periodic:
            cut = P.a[0] - 0.5 * P.gaps[-1]
            x = x - P.chord.period * np.floor((x - cut) / P.chord.period)
        k = np.clip(np.searchsorted(P.a, x, side="right") - 1, 0, P.number - 1)
        following = np.minimum(k + 1, P.number - 1)
        inside = (x >= P.a[k]) & (x <= P.b[k])
        nearer = ~inside & (np.abs(P.a[following] - x) < np.abs(x - P.b[k]))
        k = np.where(nearer, following, k)
        anchor = np.where(x - P.a[k] < P.b[k] - x, P.a[k], P.b[k])
        return Points(anchor, x - anchor), k, inside

    def _sorted_out(self, x: Array) -> tuple[Array, Points, Index, Mask, Mask]:
        """Zeros, nan at nan; x by its nearest edge; its patch; whether it is on that, or beside."""
        finite = np.isfinite(x)
        points, k, inside = self.placed(np.where(finite, x, 0.0))
        return zero_or_nan(x), points, k, inside & finite, ~inside & finite

    def __call__(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        out, points, _, inside, _ = self._sorted_out(x.ravel())
        if inside.any():
            out[inside] = in_order(self._inside, points.x[inside])
        return np.asarray(out.reshape(x.shape))

    @reported("pressure")
    def _inside(self, x: Array) -> Array:
        o = self.operator
        points, k, _ = self.placed(x)
        piece = o.pieces.locate(points.x)
        at_end = points.x == o.patches.b[k]
        piece = np.where(at_end, o.pieces.locate(points.x, "left"), piece)
        p = self.at_points(points, k, piece)
        edges = points.offset == 0.0
        if edges.any():
            at = 2 * k[edges] + (points.anchor[edges] == o.patches.b[k[edges]])
            p[edges] = np.where(o.Y[at] != 0.0, np.inf, 0.0)
        return np.asarray(p)

    def at_points(self, points: Points, k: Index, piece: Index) -> Array:
        """p at points (m,) on patches k and pieces of the slope; no place is rounded."""
        with np.errstate(divide="ignore", invalid="ignore"):
            T, D = on_patches(self.operator, k, points, piece)
            return (self.half_modulus / np.pi) * T * D

    @cached_property
    def rules(self) -> tuple[Rule, Rule]:
        """The rule of the certificate, and places between its points."""
        return rule_of(self.operator)

    @property
    def rule(self) -> Rule:
        return self.rules[0]

    @cached_property
    def at_rule(self) -> Array:
        """p on the rule, infinite at a jump of H closer than doubles tell, there as beside it.

        With 0 there the rule would miss the load of that length, some ulps of x times p: a point
        charge to the places near the jump.
        """
        m = self.rule
        x, p = m.points.x, self.at_points(m.points, m.patch, m.piece)
        finite, infinite = np.isfinite(p), np.isinf(p)
        p = np.where(finite, p, 0.0)
        if infinite.any() and finite.any():
            beside = np.flatnonzero(finite)[np.argsort(x[finite])]
            p[infinite] = np.interp(x[infinite], x[beside], p[beside])
        return p

    def hilbert(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        out, points, k, inside, beside = self._sorted_out(x.ravel())
        if inside.any():
            out[inside] = self.half_modulus * (self._slope(points[inside], k[inside]) + self.tilt)
        if beside.any():
            out[beside] = in_order(self._beside, points.x[beside])
        return np.asarray(out.reshape(x.shape))

    def _slope(self, points: Points, k: Index) -> Array:
        """H on the patches k: the mean of both sides, at an edge that from inside."""
        pieces, b = self.operator.pieces, self.operator.patches.b[k]
        left, right = (
            pieces.value(pieces.locate(points.x, side), points.anchor, points.offset)
            for side in ("left", "right")
        )
        at_edge = np.where(points.anchor == b, left, right)
        return np.where(points.offset == 0.0, at_edge, 0.5 * (left + right))

    def _beside(self, x: Array) -> Array:
        points, k, _ = self.placed(x)
        return np.asarray(self._potential(points, k))

    # -- in the plane ------------------------------------------------------------------------------

    def _potential(self, z: Points, k: Index) -> Any:
        """F at points off the patches, k the nearest patch."""
        o = self.operator
        P, pieces = o.patches, o.pieces
        real = np.clip(np.real(z.x), P.a[k], P.b[k])
        piece = np.where(real == P.b[k], pieces.locate(real, "left"), pieces.locate(real))
        follows = o.follows(piece, z)
        reference = np.where(
            follows, pieces.value(piece, z.anchor, z.offset), pieces.value(piece, real, 0.0)
        )
        F = np.empty(z.offset.shape, dtype=np.result_type(z.offset, reference))
        at = blocks(k, np.real(z.x))
        i, place, value = k[at[:, 0]], z[at], reference[at]
        T, S = o.root(i, place)
        followed = np.where(follows, piece, -1)[at]
        D = o.D(Targets(i, np.arange(len(i)), place, value, followed, k[at], S))
        F[at] = self.half_modulus * (value + self.tilt - T * D / np.pi)
        return F

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._in_plane(partial(self._cauchy, side=side), z, side)

    def _cauchy(self, z: Complex, side: int) -> Complex:
        """By values on the surface, as off it."""
        out = np.empty(z.shape, dtype=complex)
        real = z.imag == 0.0
        if real.any():
            x = z.real[real]
            out[real] = on_surface(self.hilbert(x), self(x), side)
        if not real.all():
            out[~real] = reflected(self._off_axis, z[~real])
        return out

    def _off_axis(self, z: Complex) -> Complex:
        points, k, _ = self.placed(z.real)
        return np.asarray(self._potential(Points(points.anchor, points.offset + 1j * z.imag), k))

    @cached_property
    def steepness(self) -> PatchPressure | None:
        """p' as a traction of its own; None where p has jumps of the slope or is infinite.

        Shifting the profile and all edges shifts F: F' is that of H' with the point charges by
        which moving edges change F.
        """
        o = self.operator
        P = o.patches
        if o.Y.any() or o.pieces.jump_within(P.a, P.b).any():
            return None
        derived = Operator(P, o.pieces.derivative, -0.5 * at_edges(o))
        return PatchPressure(derived, self.half_modulus, 0.0, 0.0)

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._in_plane(partial(self._derivative, side=side), z, side, derivative=True)

    def _derivative(self, z: Complex, side: int) -> Complex:
        points, _, inside = self.placed(z.real)
        at_edge = inside & (z.imag == 0.0) & (points.offset == 0.0)
        out = np.full(z.shape, complex(np.inf, np.inf))
        if self.steepness is not None:
            out[~at_edge] = self.steepness._cauchy(z[~at_edge], side)
        else:
            out[~at_edge] = self._around(z[~at_edge], side)
        return out

    def _around(self, z: Complex, side: int) -> Complex:
        """The derivative by Cauchy's formula, on circles that touch no traction.

        In contact the values of p beside the place serve.
        """
        points, k, inside = self.placed(z.real)
        P = self.operator.patches
        off = np.maximum(np.maximum(P.a[k] - points.x, points.x - P.b[k]), 0.0)
        radius = NARROW * np.hypot(off, z.imag)[:, None]
        on = inside & (z.imag == 0.0)
        out = np.empty(z.shape, dtype=complex)
        if (~on).any():
            turn = np.exp(2j * np.pi * np.arange(AROUND) / AROUND)
            circle = z[~on, None] + radius[~on] * turn
            F = self._cauchy(circle.ravel(), 1).reshape(circle.shape)
            out[~on] = (F * turn.conj() / radius[~on]).mean(axis=1)
        if on.any():
            out[on] = self._derivative_inside(z.real[on], side)
        return out

    def _derivative_inside(self, x: Array, side: int) -> Complex:
        points, _, _ = self.placed(x)
        o = self.operator
        piece = o.pieces.locate(points.x)
        steep = self.half_modulus * o.pieces.curvature(piece, points.x)
        room = np.minimum(points.x - o.pieces.breaks[piece], o.pieces.breaks[piece + 1] - points.x)
        room = np.minimum(np.abs(points.offset), np.where(room > 0.0, room, np.inf))
        step = 0.05 * np.maximum(room, np.spacing(np.abs(points.x)))
        weights = np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
        places = points.x[:, None] + step[:, None] * np.array([-2.0, -1.0, 1.0, 2.0])
        return np.asarray(steep - 1j * side * (self(places) @ weights) / step)

    def _of_force(self, z: Any) -> Any:
        if self.period < np.inf:
            return -1j * np.sign(np.imag(z)) * self.load / self.period + 0.0 * z
        return super()._of_force(z)

    @cached_property
    def horizon(self) -> float:
        return np.inf if self.period < np.inf else super().horizon
