"""The largest value of a fatigue parameter over all planes through a point, and that plane.

The normal of a plane is n = (cos ψ cos θ, cos ψ sin θ, sin ψ), at the angle θ from x towards the
depth and ψ out of the plane. With φ = 2θ, s = (σ_xx + σ_yy)/2 and D = (σ_yy - σ_xx)/2 + i σ_xy

    σ_m = s - Re(D e^(iφ))                                      on the plane ψ = 0
    σ_n = σ_zz + cos²ψ (σ_m - σ_zz)
    τ   = (sin ψ cos ψ (σ_m - σ_zz), cos ψ Im(D e^(iφ)))        across n and in the x-y plane

The amplitude of the shear is half the longest chord of the path of τ, which for ψ = 0, where τ has
one component, is half the range.

Every parameter here is the upper envelope, over pairs and triples of states, of functions of the
lowest frequencies in 2φ and 4ψ, whose hills are wide. The highest hills on a grid of planes are
climbed, all directions at once, with shorter and shorter steps. In 25,200 random histories of 2
to 20 states five results were too small by more than 1e-4, and none by more than 1.3e-3.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import step_done

Array = NDArray[np.float64]
Index = NDArray[np.intp]

# Planes of the grid, over φ and over ψ, and the highest hills on it that are climbed.
AROUND, UP, HILLS = 64, 16, 6
WIDE, HIGH = 2.0 * np.pi / AROUND, 0.5 * np.pi / UP
# The first step of climbing, radians, the rounds, and the part of a step that is taken at a top.
START, ROUNDS, SHORTER = 0.05, 40, 0.5
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


class Planes(NamedTuple):
    """What acts on planes: the amplitude of shear or strain, and the largest normal stress."""

    amplitude: Array
    normal: Array


@dataclass(frozen=True)
class Parameter:
    """A fatigue parameter A + k σ_n,max, or A max(c + k σ_n,max, 0).

    A is the amplitude of the shear stress or strain, or of the normal strain.

    weight      k
    offset      c; None for the sum
    stiffness   by which the stress of the amplitude is divided
    poisson     Poisson's ratio, where A is of the normal strain
    """

    weight: float
    offset: float | None = None
    stiffness: float = 1.0
    poisson: float | None = None

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
        if self.poisson is not None:
            strain = (1.0 + self.poisson) * normal - self.poisson * (2.0 * h.s + h.zz)
            return Planes(0.5 / self.stiffness * np.ptp(strain, axis=0), normal.max(axis=0))
        up, along = cos * sin * across, cos * turned.imag
        chord = np.zeros(up.shape[1:])
        for k in range(1, len(up)):
            squares = (up[k:] - up[:-k]) ** 2 + (along[k:] - along[:-k]) ** 2
            np.maximum(chord, squares.max(axis=0), out=chord)
        return Planes(0.5 / self.stiffness * np.sqrt(chord), normal.max(axis=0))


class Worst(NamedTuple):
    """The worst plane at each point.

    value       of the parameter
    phi, psi    of the plane
    """

    value: Array
    phi: Array
    psi: Array


def worst_planes(h: StressHistory, parameter: Parameter) -> Worst:
    """The worst plane at each point."""
    parts = (_climbed(h.at(k), parameter) for k in _parts(h))
    return Worst(*map(np.concatenate, zip(*parts, strict=True)))


def on_grid(h: StressHistory, parameter: Parameter) -> Array:
    """The largest value on the planes of the grid, at each point: a little too small."""
    parts = (_grid(h.at(k), parameter).max(axis=(1, 2)) for k in _parts(h))
    return np.concatenate(list(parts))


def _parts(h: StressHistory) -> Iterator[slice]:
    """Parts of the points whose values on the grid are no more than PART numbers."""
    size = max(PART // (len(h.s) * AROUND * (UP + 1)), 1)
    return (slice(k, k + size) for k in range(0, h.s.shape[1], size))


def _grid(h: StressHistory, parameter: Parameter) -> Array:
    """The parameter on the planes of the grid, (points, AROUND, UP + 1)."""
    step_done(0)
    phi, psi = WIDE * np.arange(AROUND, dtype=float), HIGH * np.arange(UP + 1, dtype=float)
    return parameter.of(parameter.planes(h.spread(2), phi[:, None], psi))


def _climbed(h: StressHistory, parameter: Parameter) -> Worst:
    """The highest plane near the highest hills of the grid."""
    value = _grid(h, parameter)
    around = np.maximum(np.roll(value, 1, axis=1), np.roll(value, -1, axis=1))
    beside = np.pad(value, ((0, 0), (0, 0), (1, 1)), mode="edge")
    hill = (value >= around) & (value >= beside[..., :-2]) & (value >= beside[..., 2:])
    hill[..., UP] = False  # all one plane, whose normal is z
    hill[:, 0, UP] = value[:, 0, UP] >= value[..., UP - 1].max(axis=1)
    heights = np.where(hill, value, -np.inf).reshape(len(value), -1)
    k = np.argpartition(-heights, HILLS, axis=1)[:, :HILLS]
    phi, psi = WIDE * (k // (UP + 1)), HIGH * (k % (UP + 1))
    i, j = (k.ravel() for k in np.meshgrid([0, -2, -1, 1, 2], [0, -2, -1, 1, 2]))
    spread, step = h.spread(2), np.full((*k.shape, 1), START)
    for _ in range(ROUNDS):
        near_phi = phi[..., None] + i * step
        near_psi = np.clip(psi[..., None] + j * step, 0.0, 0.5 * np.pi)
        values = parameter.of(parameter.planes(spread, near_phi, near_psi))
        best = values.argmax(axis=-1)[..., None]
        phi, psi, top = (
            np.take_along_axis(a, best, axis=-1)[..., 0] for a in (near_phi, near_psi, values)
        )
        step = np.where(best == 0, SHORTER * step, step)
    best = top.argmax(axis=1)[:, None]
    return Worst(*(np.take_along_axis(a, best, axis=1)[:, 0] for a in (top, phi, psi)))
