"""The largest value of a fatigue parameter over all planes through a point, and that plane.

The normal of a plane is n = (cos ψ cos θ, cos ψ sin θ, sin ψ), at the angle θ from x towards the
depth and ψ out of the plane. With φ = 2θ, s = (σ_xx + σ_yy)/2 and D = (σ_yy - σ_xx)/2 + i σ_xy

    σ_m = s - Re(D e^(iφ))                                      on the plane ψ = 0
    σ_n = σ_zz + cos²ψ (σ_m - σ_zz)
    τ   = (sin ψ cos ψ (σ_m - σ_zz), cos ψ Im(D e^(iφ)))        across n and in the x-y plane

The amplitude of the shear is half the longest chord of the path of τ, which for ψ = 0, where τ has
one component, is half the range.

Every parameter here is the upper envelope, over pairs and triples of states, of functions of (φ, ψ)
with known bounds M of their second derivatives. In a box of the widths w such a function exceeds
its largest value at the four corners by at most Σ M w²/8. Boxes are halved until none may hold more
than ACCURACY above the largest value found: that bound is rigorous. The plane is then polished.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import step_done

Array = NDArray[np.float64]
Index = NDArray[np.intp]

# What the largest value may lack before it is polished, relative to it. NEARLY is for a first look
# at many points. A value below OF_STRESSES of what its factors could give nearly cancels, and is
# known relative to that part.
ACCURACY, NEARLY, OF_STRESSES = 1e-5, 1e-3, 1e-2
# Nodes of the first grid, over φ and over ψ.
AROUND, UP = 16, 4
WIDE, HIGH = 2.0 * np.pi / AROUND, 0.5 * np.pi / UP
# Halvings of a box, for parameters that are the same on many planes.
MOST_HALVINGS = 26
# The first step of polishing, radians, and its rounds, each with so much shorter a step.
START, ROUNDS, SHORTER = 0.1, 44, 0.7
# Numbers in a temporary array.
PART = 2**20


@dataclass(frozen=True, eq=False)
class StressHistory:
    """The stresses of all states (first axis) at points (second axis).

    s, D, zz    as in the module's docstring
    """

    s: Array
    D: NDArray[np.complex128]
    zz: Array

    def at(self, k: Index | slice) -> StressHistory:
        """The history at some of the points."""
        return StressHistory(self.s[:, k], self.D[:, k], self.zz[:, k])

    def spread(self, axes: int) -> StressHistory:
        """The history with so many axes behind that of the points, along which planes vary."""
        more = (..., *[None] * axes)
        return StressHistory(self.s[more], self.D[more], self.zz[more])


class Bounds(NamedTuple):
    """Bounds of a function of (φ, ψ), and of its first and second derivatives.

    size            of the function
    first, second   of derivatives by φ and by ψ, (2, points)
    """

    size: Array
    first: Array
    second: Array

    def times(self, other: Bounds) -> Bounds:
        """The bounds of a product."""
        first = self.first * other.size + self.size * other.first
        second = (
            self.second * other.size + 2.0 * self.first * other.first + self.size * other.second
        )
        return Bounds(self.size * other.size, first, second)

    def plus(self, other: Bounds) -> Bounds:
        """The bounds of a sum."""
        return Bounds(*(a + b for a, b in zip(self, other, strict=True)))

    def scaled(self, factor: float) -> Bounds:
        """The bounds of a multiple."""
        return Bounds(*(factor * part for part in self))


class Planes(NamedTuple):
    """What acts on planes: the amplitude of shear or strain, and the largest normal stress."""

    amplitude: Array
    normal: Array


@dataclass(frozen=True)
class Parameter:
    """A fatigue parameter A + k σ_n,max, or A max(c + k σ_n,max, 0).

    A is the amplitude of the shear stress, or of the normal strain times Young's modulus.

    weight      k
    offset      c; None for the sum
    strain      whether A is of the normal strain
    poisson     Poisson's ratio, of the strain
    """

    weight: float
    offset: float | None = None
    strain: bool = False
    poisson: float = 0.0

    def of(self, planes: Planes) -> Array:
        """The value on planes."""
        if self.offset is None:
            return planes.amplitude + self.weight * planes.normal
        return planes.amplitude * np.maximum(self.offset + self.weight * planes.normal, 0.0)

    def planes(self, h: StressHistory, phi: Array, psi: Array) -> Planes:
        """What acts on one plane at each point of a history."""
        cos, sin, turn = np.cos(psi), np.sin(psi), np.exp(1j * phi)
        turned = h.D * turn
        across = h.s - turned.real - h.zz
        normal = h.zz + cos * cos * across
        if self.strain:
            strain = (1.0 + self.poisson) * normal - self.poisson * (2.0 * h.s + h.zz)
            return Planes(0.5 * np.ptp(strain, axis=0), normal.max(axis=0))
        up, along = cos * sin * across, cos * turned.imag
        chord = np.zeros(up.shape[1:])
        for k in range(1, len(up)):
            squares = (up[k:] - up[:-k]) ** 2 + (along[k:] - along[:-k]) ** 2
            np.maximum(chord, squares.max(axis=0), out=chord)
        return Planes(0.5 * np.sqrt(chord), normal.max(axis=0))

    def bounds(self, h: StressHistory) -> tuple[Bounds, Bounds, Bounds]:
        """The bounds of the parameter, of its amplitude and of what multiplies or adds to it."""
        amplitude, normal = self._amplitude(h), _normal(h).scaled(self.weight)
        if self.offset is None:
            return amplitude.plus(normal), amplitude, normal
        factor = normal._replace(size=normal.size + self.offset)
        return amplitude.times(factor), amplitude, factor

    def _amplitude(self, h: StressHistory) -> Bounds:
        middle = [0.5 * (part.max(axis=0) + part.min(axis=0)) for part in (h.D.real, h.D.imag)]
        D_range = 2.0 * np.abs(h.D - (middle[0] + 1j * middle[1])).max(axis=0)
        across = np.ptp(h.s - h.zz, axis=0) + D_range
        if self.strain:
            zz_range = np.ptp(h.zz, axis=0)
            whole = 2.0 * np.ptp(h.s, axis=0) + zz_range
            size = (1.0 + self.poisson) * (zz_range + across) + abs(self.poisson) * whole
            slopes = np.stack((D_range, across)) * (1.0 + self.poisson)
            curved = np.stack((D_range, 2.0 * across)) * (1.0 + self.poisson)
            return Bounds(size, slopes, curved).scaled(0.5)
        size = np.hypot(0.5 * across, D_range)
        slopes = np.stack((np.hypot(0.5, 1.0) * D_range, np.hypot(across, D_range)))
        curved = np.stack((slopes[0], np.hypot(2.0 * across, D_range)))
        return Bounds(size, slopes, curved).scaled(0.5)


def _normal(h: StressHistory) -> Bounds:
    """The bounds of the normal stress."""
    D = np.abs(h.D).max(axis=0)
    across = (np.abs(h.s - h.zz) + np.abs(h.D)).max(axis=0)
    slopes, curved = np.stack((D, across)), np.stack((D, 2.0 * across))
    return Bounds(np.abs(h.zz).max(axis=0) + across, slopes, curved)


class Worst(NamedTuple):
    """The worst plane at each point.

    value       of the parameter
    phi, psi    of the plane
    """

    value: Array
    phi: Array
    psi: Array


def on_grid(h: StressHistory, parameter: Parameter) -> Array:
    """The largest value on the planes of the first grid, at each point: a little too small."""
    return np.concatenate(
        [parameter.of(_on_grid(h.at(k), parameter)).max(axis=(1, 2)) for k in _parts(h)]
    )


def worst_planes(h: StressHistory, parameter: Parameter, accuracy: float = ACCURACY) -> Worst:
    """The worst plane at each point."""
    search = _Search(h, parameter, accuracy)
    search.halve()
    return search.polished()


def _parts(h: StressHistory) -> Iterator[slice]:
    """Parts of the points whose values on the first grid are no more than PART numbers."""
    size = max(PART // (len(h.s) * AROUND * (UP + 1)), 1)
    return (slice(k, k + size) for k in range(0, h.s.shape[1], size))


def _on_grid(h: StressHistory, parameter: Parameter) -> Planes:
    """What acts on the planes of the first grid, (points, AROUND, UP + 1)."""
    phi, psi = WIDE * np.arange(AROUND, dtype=float), HIGH * np.arange(UP + 1, dtype=float)
    return parameter.planes(h.spread(2), phi[:, None], psi)


class _Boxes(NamedTuple):
    """Boxes of planes.

    point       the point that each belongs to
    phi, psi    its corner of least φ and ψ
    wide, high  its widths in φ and ψ
    """

    point: NDArray[Any]
    phi: NDArray[Any]
    psi: NDArray[Any]
    wide: NDArray[Any]
    high: NDArray[Any]

    @property
    def corners(self) -> tuple[Array, Array]:
        """φ and ψ at the four corners of each box, (boxes, 4)."""
        phi = self.phi[:, None] + self.wide[:, None] * [0.0, 1.0, 0.0, 1.0]
        return phi, self.psi[:, None] + self.high[:, None] * [0.0, 0.0, 1.0, 1.0]


class _Search:
    """The search for the worst plane at each point."""

    def __init__(self, h: StressHistory, parameter: Parameter, accuracy: float) -> None:
        self.h, self.parameter, self.accuracy = h, parameter, accuracy
        self.bounds = parameter.bounds(h)
        count = h.s.shape[1]
        self.best = np.full(count, -np.inf)
        self.where = np.zeros(count), np.zeros(count)
        self.least = OF_STRESSES * self.bounds[0].size
        self.boxes = self._first()

    def halve(self) -> None:
        """Halve the boxes until none can hold a value above the accuracy."""
        size = max(PART // (8 * len(self.h.s)), 1)
        for _ in range(MOST_HALVINGS):
            step_done(0)
            count = self.boxes.point.size
            if not count:
                break
            parts = (_Boxes(*(a[k : k + size] for a in self.boxes)) for k in range(0, count, size))
            kept = [self._halved(part) for part in parts]
            self.boxes = _Boxes(*map(np.concatenate, zip(*kept, strict=True)))

    def _first(self) -> _Boxes:
        """The boxes of the first grid that may hold the largest value at their point."""
        grids = [_on_grid(self.h.at(k), self.parameter) for k in _parts(self.h)]
        planes = Planes(*map(np.concatenate, zip(*grids, strict=True)))
        value = self.parameter.of(planes)
        point, i, j = (k.ravel() for k in np.indices(value.shape))
        phi, psi = i * WIDE, j * HIGH
        self._note(point, phi, psi, value.ravel())

        def highest(a: Array) -> Array:
            around = np.maximum(a, np.roll(a, -1, axis=1))
            return np.maximum(around[..., :-1], around[..., 1:]).ravel()

        low = j < UP
        widths = np.full(low.sum(), WIDE), np.full(low.sum(), HIGH)
        boxes = _Boxes(point[low], phi[low], psi[low], *widths)
        return self._kept(boxes, highest(value), Planes(*map(highest, planes)))

    def _halved(self, boxes: _Boxes) -> _Boxes:
        """The halves of boxes that may hold the largest value at their point.

        A box is halved across the angle in which the parameter may be curved more.
        """
        curved = self.bounds[0].second[:, boxes.point]
        upwards = curved[1] * boxes.high**2 > curved[0] * boxes.wide**2
        wide = np.where(upwards, 1.0, 0.5) * boxes.wide
        high = np.where(upwards, 0.5, 1.0) * boxes.high
        low = boxes._replace(wide=wide, high=high)
        top = low._replace(
            phi=np.where(upwards, boxes.phi, boxes.phi + wide),
            psi=np.where(upwards, boxes.psi + high, boxes.psi),
        )
        halves = _Boxes(*map(np.concatenate, zip(low, top, strict=True)))
        at = np.repeat(halves.point, 4)
        phi, psi = (corner.ravel() for corner in halves.corners)
        planes = self.parameter.planes(self.h.at(at), phi, psi)
        value = self.parameter.of(planes)
        self._note(at, phi, psi, value)
        value, amplitude, normal = (a.reshape(-1, 4).max(axis=1) for a in (value, *planes))
        return self._kept(halves, value, Planes(amplitude, normal))

    def _note(self, point: Index, phi: NDArray[Any], psi: NDArray[Any], value: Array) -> None:
        """Keep the largest value at each point, and its plane."""
        order = np.lexsort((-value, point))
        first = order[np.unique(point[order], return_index=True)[1]]
        better = first[value[first] > self.best[point[first]]]
        self.best[point[better]] = value[better]
        for kept, new in zip(self.where, (phi, psi), strict=True):
            kept[point[better]] = new[better]

    def _kept(self, boxes: _Boxes, value: Array, corners: Planes) -> _Boxes:
        """The boxes, of these largest values at corners, that may hold more than the best."""
        squares = np.stack((boxes.wide, boxes.high)) ** 2 / 8.0
        whole, amplitude, other = (
            (squares * b.second[:, boxes.point]).sum(axis=0) for b in self.bounds
        )
        highest = value + whole
        weight, offset = self.parameter.weight, self.parameter.offset
        if offset is not None:
            factor = np.maximum(offset + weight * corners.normal + other, 0.0)
            highest = np.minimum(highest, (corners.amplitude + amplitude) * factor)
        best = np.abs(self.best)
        enough = self.best + self.accuracy * np.maximum(best, self.least)
        hopeful = highest > enough[boxes.point]
        return _Boxes(*(a[hopeful] for a in boxes))

    def polished(self) -> Worst:
        """The planes, each moved to the largest of its neighbours at smaller and smaller steps."""
        phi, psi = self.where
        value, step = self.best, START
        every = np.arange(len(value))
        i, j = (k.ravel() for k in np.meshgrid([0, -1, 1], [0, -1, 1]))
        spread = self.h.spread(1)
        for _ in range(ROUNDS):
            near_phi = phi[:, None] + i * step
            near_psi = np.clip(psi[:, None] + j * step, 0.0, 0.5 * np.pi)
            values = self.parameter.of(self.parameter.planes(spread, near_phi, near_psi))
            k = values.argmax(axis=1)
            value = values[every, k]
            phi, psi = near_phi[every, k], near_psi[every, k]
            step *= SHORTER
        return Worst(value, phi, psi)
