"""The largest values of a measure of stress on the surface, edges and breaks included.

On the surface the derivative of the stress is Fp' there, and its sign changes are bracketed between
neighbouring columns of the scan, of which every edge and break is one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.root_finding import false_positions

from .half_plane import Tractions, hilbert_of_shear, potentials
from .scan_columns import Mesh

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Maxima of the scan below this part of the largest known value are not polished; a maximum of the
# scan is off by its curvature over a cell.
WORTH = 0.85
# The part of a cell that is left out at a mark, where the slope may be infinite.
AT_MARK = 1e-9


class Measure(NamedTuple):
    """A measure of the stress as a function of v = (s, D_r, D_i), arrays (3, ...).

    It has a value, a gradient (3, ...) and a Hessian (3, 3, ...).
    """

    value: Callable[[Array], Array]
    gradient: Callable[[Array], Array]
    hessian: Callable[[Array], Array]


class Maximum(NamedTuple):
    """A local maximum of a measure of stress, and its place.

    value    the maximum, a stress
    x, y     its place, lengths
    """

    value: float
    x: float
    y: float


def on_surface(tractions: Tractions, measure: Measure, mesh: Mesh, values: Array) -> list[Maximum]:
    """Local maxima along the surface that may be the largest, edges and breaks included.

    `values` are those of `surface_values` on the columns of the surface.
    """
    x, value = mesh.surface, measure.value(values)
    padded = np.concatenate(([-np.inf], value, [-np.inf]))
    best = value.max()
    if np.isinf(best):
        return [
            Maximum(float(v), float(at), 0.0) for v, at in zip(value, x, strict=True) if np.isinf(v)
        ]
    floor = best - (1.0 - WORTH) * float(np.abs(value[np.isfinite(value)]).max())
    top = np.flatnonzero((value >= padded[:-2]) & (value >= padded[2:]) & (value >= floor))
    columns = top
    # Between columns a concave top exceeds the middle value by no more than the fall to a neighbour
    fall = value[top] - np.minimum(padded[top], padded[top + 2])
    top = top[(fall > 0.0) & (value[top] + np.where(np.isfinite(fall), fall, np.inf) >= best)]
    left = np.unique(np.concatenate((top - 1, top)))
    left = left[(left >= 0) & (left < len(x) - 1)]
    lo, hi = x[left], x[left + 1]
    inset = np.maximum(AT_MARK * (hi - lo), np.spacing(np.maximum(np.abs(lo), np.abs(hi))))
    lo, hi = (
        lo + np.where(np.isin(lo, tractions.marks), inset, 0.0),
        hi - np.where(np.isin(hi, tractions.marks), inset, 0.0),
    )
    roots = false_positions(lambda t: slope(tractions, measure, t), lo, hi)
    at_root = measure.value(surface_values(tractions, roots))
    highest = np.full(len(x) + 1, -np.inf)  # of the roots between neighbouring columns
    np.maximum.at(highest, np.searchsorted(x, roots), at_root)
    tops = columns[value[columns] >= np.maximum(highest[columns], highest[columns + 1])]
    found = zip(np.append(value[tops], at_root), np.append(x[tops], roots), strict=True)
    return [Maximum(float(v), float(t), 0.0) for v, t in found]


def surface_values(tractions: Tractions, x: Array) -> Array:
    """(s, D_r, D_i) on the surface, (3, n); at the edges their limits from inside the contact."""
    p, q = tractions.pressure(x), tractions.shear(x)
    hilbert = hilbert_of_shear(tractions, x, p)
    for x_edge, limit in tractions.hilbert_at_edges:
        edge = (x == x_edge) & np.isfinite(p)
        p, q, hilbert = (
            np.where(edge, value, v) for value, v in ((0.0, p), (0.0, q), (limit, hilbert))
        )
    half = 0.5 * tractions.bulk_stress
    return np.stack((half - p - hilbert, hilbert - half, -q))


def slope(tractions: Tractions, measure: Measure, x: Array, inwards: bool = False) -> Array:
    """d/dx, or d/dy, of the measure on the surface, in units of the half-width.

    It is taken beside edges and breaks, by the limit of the potentials, y Φ' = 0.
    """
    x1, x2 = tractions.pressure.interval
    Phi, dPhi, Fq, dFq = (np.zeros(x.shape, dtype=complex) for _ in range(4))
    for density, p, q in tractions.combined:
        F, dF = density.potentials(x + 1j * tractions.depth_of_surface)
        Phi += (p - 1j * q) * F
        dPhi += (p - 1j * q) * dF
        Fq += q * F
        dFq += q * dF
    half = 0.5 * tractions.bulk_stress
    value: Array = np.stack((Phi.imag + half, Fq.real - half, Fq.imag))
    ds, dD = (dPhi.real, 1j * dFq - dPhi) if inwards else (dPhi.imag, dFq)
    derivative = 0.5 * (x2 - x1) * np.stack((ds, dD.real, dD.imag))
    return (measure.gradient(value) * derivative).sum(axis=0)


def values_inside(tractions: Tractions, z: Complex) -> Array:
    """(s, D_r, D_i) inside the body, (3, n)."""
    Phi, dPhi, Fq = potentials(tractions, z)
    D = Fq - z.imag * dPhi
    half = 0.5 * tractions.bulk_stress
    return np.stack((Phi.imag + half, D.real - half, D.imag))
