"""The largest value that a measure of the stress takes in the body: scanned on the scale of its singularities, polished by Newton.

Where the maxima can hide.  Fp and Fq are analytic in the body and, through every smooth part of the surface, beyond it; what is not smooth
are the edges and breaks of the tractions. So on a disc that keeps away from these by its own radius the stress is a fast convergent power
series, and a scan whose cells shrink in proportion to the distance from the nearest edge or break (columns gathered there, depths in
geometric progression) resolves it equally well at every scale: a rim of 1e-6 b has as many cells as the whole contact. Every local maximum
of the scan becomes a start, with its neighbours to both sides, because two maxima may lie on either side of a saddle under the centre.

Polishing.  Derivatives up to the third come from Cauchy's formula on a circle inside the body, with ρ = y/3 exact to 3^-N,

    F^(n)(z) = n!/(N ρ^n) Σ_j F(z + ρ ω^j) ω^(-nj),      ω = exp(2πi/N)

so that gradient and Hessian are those of the stress itself, no finite differences. On the surface the derivative is
Fp' there, and its sign changes are bracketed between neighbouring columns, of which every edge and break is one.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .field import Tractions, hilbert_of_shear, potentials

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

COLUMNS, SURFACE_COLUMNS = 9, 17  # on every part of the contact between neighbouring edges and breaks ...
FEWEST, MOST_COLUMNS = 3, 600  # ... fewer where there are many parts, whose length is then the finest scale
OUTSIDE = (0.003, 0.03, 0.12, 0.35, 0.8, 1.8)  # columns beside the contact, in half-widths
FAR = 1e3  # half-widths: the last column of the surface
SHALLOWEST, DEEPEST, RATIO = 0.02, 4.0, 1.45  # depths of the scan: of the shortest part, of the half-width; geometric ratio
SPACING = 0.15  # columns closer than this fraction of the depth are thinned out
WORTH = 0.85  # of the largest value known: maxima of the scan below it, which is off by its curvature over a cell, are not polished
MOST_STARTS = 48
CIRCLE = 32
STEPS, LONGEST = 60, 0.3  # Newton steps, the longest as a fraction of the depth
SETTLED = 1e-7  # of the depth: after it the step to come, its square, is below rounding
SAME_VALUE, STUCK = 4e-15, 1e-9  # rounding of a value; a trust region, as a fraction of the depth, in which it hides every gain
TOGETHER = 1e-3  # of the depth
LEFT = 0.5  # of the shallowest depth: what climbs beyond belongs to the surface
ROOT_STEPS, BISECT_AFTER = 80, 12
BENEATH = 1e-100  # half-widths: so near to where p is infinite that nothing else is left
ROOT_SETTLED = 1e-9  # of the bracket: the last step of a method that converges faster and faster leaves much less
# Maxima this close in value are tied, this close in place (of the half-width) the same.
TIED, SAME_PLACE = 1e-10, 1e-7


class Local(NamedTuple):
    """s, D_r, D_i and their derivatives in units of the depth, each with a first axis (s, D_r, D_i) of length 3."""

    value: Array
    x: Array
    y: Array
    xx: Array
    xy: Array
    yy: Array


class Measure(NamedTuple):
    """A measure of the stress as a function of v = (s, D_r, D_i), arrays (3, ...): its value, gradient (3, ...), Hessian (3, 3, ...)."""

    value: Callable[[Array], Array]
    gradient: Callable[[Array], Array]
    hessian: Callable[[Array], Array]


class Maximum(NamedTuple):
    value: float
    x: float
    y: float


def largest(tractions: Tractions, measure: Measure) -> tuple[Maximum, ...]:
    """The largest value in the body, with every place where it is taken (ties within TIED), those on the left first."""
    surface = [*on_surface(tractions, measure), *beneath_infinite_pressure(tractions, measure)]
    found = [*surface, *inside(tractions, measure, max(m.value for m in surface))]
    best = max(m.value for m in found)
    r = 0.5 * float(np.diff(tractions.pressure.interval)[0])
    ties: list[Maximum] = []
    for m in sorted(found, key=lambda m: -m.value):
        tied = m.value == best or m.value >= best * (1.0 - TIED)
        if tied and all(abs(m.x - t.x) + abs(m.y - t.y) > SAME_PLACE * r for t in ties):
            ties.append(m)
    return tuple(sorted(ties, key=lambda m: m.x))


# -- inside ------------------------------------------------------------------------------------------------------------


def inside(tractions: Tractions, measure: Measure, known: float) -> list[Maximum]:
    """Local maxima below the surface that may be larger than a known value."""
    if np.isinf(known):
        return []
    depths = _depths(tractions.marks)
    starts = _starts(tractions, measure, known, depths)
    if not starts.size:
        return []
    # The best of the scan stays, where all that climb from it leave: under a jump of h' the largest value is not taken anywhere
    z = np.concatenate((starts[:1], _climbed(tractions, measure, starts, LEFT * float(depths[0]))))
    values = measure.value(_values(tractions, z))
    return [Maximum(*row) for row in zip(values.tolist(), z.real.tolist(), z.imag.tolist(), strict=True)]


def _starts(tractions: Tractions, measure: Measure, known: float, depths: Array) -> Complex:
    """The local maxima of the scan and their neighbours left and right."""
    columns = _columns(tractions.marks, COLUMNS)
    levels = [_thinned(columns, SPACING * y) for y in depths]
    z = np.concatenate([x + 1j * y for x, y in zip(levels, depths, strict=True)])
    ends = np.cumsum([0, *map(len, levels)])
    value = measure.value(_values(tractions, z))
    rows = [value[i:j] for i, j in pairwise(ends)]
    starts: list[NDArray[np.intp]] = []
    floor = WORTH * max(value.max(), known)
    for k, row in enumerate(rows):
        if row.max() < floor:
            continue
        padded = np.concatenate(([-np.inf], row, [-np.inf]))
        top = np.flatnonzero((row >= padded[:-2]) & (row >= padded[2:]) & (row >= floor))
        for other in (k - 1, k + 1):
            if 0 <= other < len(rows) and top.size:
                top = top[row[top] >= rows[other][_nearest(levels[other], levels[k][top])]]
        if top.size:
            starts.append(ends[k] + np.unique(np.clip(np.concatenate((top - 1, top, top + 1)), 0, len(row) - 1)))
    found = np.concatenate(starts) if starts else np.zeros(0, dtype=np.intp)
    return z[found[np.argsort(-value[found])][:MOST_STARTS]]


def _climbed(tractions: Tractions, measure: Measure, z: Complex, shallow: float) -> Complex:
    """Where Newton's method for the gradient, turned uphill, comes to rest inside; starts that leave through the surface are dropped."""
    rest: list[Complex] = []
    before, value, trust = z, np.full(z.shape, -np.inf), np.full(z.shape, LONGEST)
    for _ in range(STEPS):
        if not z.size:
            break
        at = _local(tractions, z)
        here = measure.value(at.value)
        uphill = here >= value * (1.0 - SAME_VALUE)
        trust = np.where(uphill, np.minimum(2.0 * trust, LONGEST), 0.25 * trust)
        step = _newton(measure, at)
        length = np.abs(step)
        step *= z.imag
        done = uphill & (length <= SETTLED)
        rest.append((z + step)[done])
        step *= np.minimum(1.0, trust / np.maximum(length, 1e-300))
        # back to where it was better, and from there half as far as last time
        new = np.where(uphill, z + step, before + 0.25 * (z - before))
        before, value = np.where(uphill, z, before), np.where(uphill, here, value)
        stuck = trust <= STUCK
        rest.append(before[stuck & ~done])
        keep = ~done & ~stuck & (new.imag > shallow)
        z, before, value, trust = _distinct(new[keep], before[keep], value[keep], trust[keep])
    rest.append(z)
    return np.concatenate(rest)


def _distinct(z: Complex, *others: Any) -> tuple[Any, ...]:
    """Without those that have come together: from there they would go the same way."""
    same = np.abs(z[:, None] - z) <= TOGETHER * z.imag
    first = same.argmax(axis=1) == np.arange(len(z)) if z.size else np.zeros(0, dtype=bool)
    return z[first], *(other[first] for other in others)


def _newton(measure: Measure, at: Local) -> Complex:
    """The step -H⁻¹ g to a maximum, in units of the depth; every eigenvalue of H is taken as negative: from anywhere it leads uphill."""
    g, G = measure.gradient(at.value), measure.hessian(at.value)
    gx, gy = (g * at.x).sum(axis=0), (g * at.y).sum(axis=0)
    Gx, Gy = (G * at.x).sum(axis=1), (G * at.y).sum(axis=1)
    hxx, hxy, hyy = ((g * second + u * Gv).sum(axis=0) for second, u, Gv in ((at.xx, at.x, Gx), (at.xy, at.x, Gy), (at.yy, at.y, Gy)))
    mean, half = 0.5 * (hxx + hyy), np.hypot(0.5 * (hxx - hyy), hxy)
    angle = 0.5 * np.arctan2(2.0 * hxy, hxx - hyy)
    cos, sin = np.cos(angle), np.sin(angle)
    along, across = gx * cos + gy * sin, gy * cos - gx * sin
    least = 1e-12 * (abs(mean) + half) + 1e-300
    a, b = along / np.maximum(abs(mean + half), least), across / np.maximum(abs(mean - half), least)
    step = np.empty(gx.shape, dtype=complex)
    step.real, step.imag = a * cos - b * sin, a * sin + b * cos
    return step


def _values(tractions: Tractions, z: Complex) -> Array:
    """(s, D_r, D_i) inside the body, (3, n)."""
    Phi, dPhi, Fq = potentials(tractions, z)
    D = Fq - z.imag * dPhi
    half = 0.5 * tractions.bulk_stress
    return np.stack((Phi.imag + half, D.real - half, D.imag))


def _local(tractions: Tractions, z: Complex) -> Local:
    """(s, D_r, D_i) and two derivatives of each, in units of the depth, at z (1-d): from the potentials on circles of radius y/3."""
    y = z.imag
    omega = np.exp(2j * np.pi * np.arange(CIRCLE) / CIRCLE)
    circle = (z[:, None] + (y / 3.0)[:, None] * omega).ravel()
    Phi, dPhi, Fq = (f.reshape(len(z), CIRCLE) for f in potentials(tractions, circle))
    n = np.arange(3)
    taylor = omega.conj()[:, None] ** n * (3.0**n * (1.0, 1.0, 2.0) / CIRCLE)
    (P0, P1, P2), (D1, D2, D3), (Q0, Q1, Q2) = (f.T for f in (Phi @ taylor, (y[:, None] * dPhi) @ taylor, Fq @ taylor))
    s = (P0.imag, P1.imag, P1.real, P2.imag, P2.real, -P2.imag)
    D = (Q0 - D1, Q1 - D2, -D1 - 1j * (D2 - Q1), Q2 - D3, -D2 - 1j * (D3 - Q2), -2j * D2 + D3 - Q2)
    half = 0.5 * tractions.bulk_stress
    rows = np.empty((len(s), 3, len(z)))
    for row, a, b in zip(rows, s, D, strict=True):
        row[0], row[1], row[2] = a, b.real, b.imag
    rows[0, 0] += half
    rows[0, 1] -= half
    return Local(*rows)


# -- on the surface ----------------------------------------------------------------------------------------------------


def on_surface(tractions: Tractions, measure: Measure) -> list[Maximum]:
    """Local maxima along the surface that may be the largest; edges and breaks are taken as they are."""
    x = _surface_columns(tractions.marks)
    value = measure.value(surface_values(tractions, x))
    padded = np.concatenate(([-np.inf], value, [-np.inf]))
    best = value.max()
    if np.isinf(best):
        return [Maximum(float(v), float(at), 0.0) for v, at in zip(value, x, strict=True) if np.isinf(v)]
    floor = best - (1.0 - WORTH) * max(abs(best), abs(value).max())
    top = np.flatnonzero((value >= padded[:-2]) & (value >= padded[2:]) & (value >= floor))
    columns = top
    # Between columns a concave top rises above the middle one by no more than that falls to a neighbour
    fall = value[top] - np.minimum(padded[top], padded[top + 2])
    top = top[value[top] + np.where(np.isfinite(fall), fall, np.inf) >= best]
    left = np.unique(np.concatenate((top - 1, top)))
    left = left[(left >= 0) & (left < len(x) - 1)]
    roots = _roots(lambda t: _slope(tractions, measure, t), x[left], x[left + 1])
    at_root = measure.value(surface_values(tractions, roots))
    highest = np.full(len(x) + 1, -np.inf)  # of the roots between neighbouring columns
    np.maximum.at(highest, np.searchsorted(x, roots), at_root)
    tops = columns[value[columns] >= np.maximum(highest[columns], highest[columns + 1])]
    places = ((value[tops], x[tops]), (at_root, roots))
    return [Maximum(float(v), float(t), 0.0) for values, at in places for v, t in zip(values, at, strict=True)]


def beneath_infinite_pressure(tractions: Tractions, measure: Measure) -> list[Maximum]:
    """What a measure of D alone (an incompressible body) tends to where p is infinite: on the surface itself D knows nothing of it.

    At a sharp edge D grows without limit. At a jump of h' Fp' ~ C/(z - x), and D tends to Fq - C sin θ e^(-iθ) in the direction θ, on a
    circle of diameter |C| through Fq: the largest |D| is |Fq + iC/2| + |C|/2.
    """
    x = tractions.marks
    x = x[np.isinf(tractions.pressure(x))]
    if not x.size:
        return []
    on = surface_values(tractions, x)
    unseen = np.isfinite(measure.value(on))
    if not unseen.any():
        return []
    x, on = x[unseen], on[:, unseen]
    Fq = on[1] + 1j * on[2]
    x1, x2 = tractions.pressure.interval
    beneath = _values(tractions, np.asarray(x + 1j * (BENEATH * 0.5 * (x2 - x1)), dtype=np.complex128))
    C = -1j * (beneath[1] + 1j * beneath[2] - Fq)
    largest_D = np.where((x == x1) | (x == x2), np.inf, np.abs(Fq + 0.5j * C) + 0.5 * np.abs(C))
    value = measure.value(np.stack((on[0], largest_D, np.zeros(len(x)))))
    return [Maximum(float(v), float(t), 0.0) for v, t in zip(value, x, strict=True)]


def surface_values(tractions: Tractions, x: Array) -> Array:
    """(s, D_r, D_i) on the surface, (3, n); at the edges of the contact their limits from inside."""
    p, q = tractions.pressure(x), tractions.shear(x)
    hilbert = hilbert_of_shear(tractions, x, p)
    if tractions.shear.interval == tractions.pressure.interval:
        for x_edge, limit in zip(tractions.shear.interval, tractions.shear.hilbert_at_edges, strict=True):
            edge = (x == x_edge) & np.isfinite(p)
            p, q, hilbert = np.where(edge, 0.0, p), np.where(edge, 0.0, q), np.where(edge, limit, hilbert)
    half = 0.5 * tractions.bulk_stress
    return np.stack((half - p - hilbert, hilbert - half, -q))


def _slope(tractions: Tractions, measure: Measure, x: Array) -> Array:
    """d/dx of the measure along the surface in units of the half-width, off edges and breaks: the potentials' limit, y Φ' = 0."""
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
    derivative = 0.5 * (x2 - x1) * np.stack((dPhi.imag, dFq.real, dFq.imag))
    return (measure.gradient(value) * derivative).sum(axis=0)


def _roots(slope: Callable[[Array], Array], lo: Array, hi: Array) -> Array:
    """Where the slope falls through 0 between lo and hi, of those pairs where it does (Illinois' method with bisection)."""
    nudge = 1e-9 * (hi - lo)  # off edges and breaks, where it may be infinite
    a, b = lo + nudge, hi - nudge
    fa, fb = slope(np.stack((a, b)).ravel()).reshape(2, -1)
    falls = (fa > 0.0) & (fb < 0.0)
    a, b, fa, fb = a[falls], b[falls], fa[falls], fb[falls]
    x, enough, last = 0.5 * (a + b), ROOT_SETTLED * (b - a), np.zeros(a.shape)
    for k in range(ROOT_STEPS if x.size else 0):
        before = x
        middle, secant = 0.5 * (a + b), b - fb * (b - a) / (fb - fa)
        x = np.where((secant > a) & (secant < b) & ((k < BISECT_AFTER) | (k % 2 == 0)), secant, middle)
        f = slope(x)
        up = f > 0.0
        again = np.where(last == np.where(up, 1.0, -1.0), 0.5, 1.0)  # an end kept twice loses weight
        fb, fa, last = np.where(up, again * fb, f), np.where(up, f, again * fa), np.where(up, 1.0, -1.0)
        a, b = np.where(up, x, a), np.where(up, b, x)
        if ((np.abs(x - before) <= enough) | (f == 0.0)).all():
            break
    return x


# -- where the scan looks ----------------------------------------------------------------------------------------------


def _columns(marks: Array, n: int) -> Array:
    """Ascending abscissae, gathered at edges and breaks, none of them on one, nor midway between two."""
    n = max(min(n, MOST_COLUMNS // (len(marks) - 1)), FEWEST)
    t = np.sin(0.5 * np.pi * (np.arange(n) + 0.47) / n) ** 2
    r = 0.5 * (marks[-1] - marks[0])
    parts = (marks[:-1, None] + np.diff(marks)[:, None] * t).ravel()
    beside = r * np.array(OUTSIDE)
    return np.unique(np.concatenate((marks[0] - beside, parts, marks[-1] + beside)))


def _surface_columns(marks: Array) -> Array:
    r = 0.5 * (marks[-1] - marks[0])
    far = r * np.geomspace(OUTSIDE[-1], FAR, 12)
    return np.unique(np.concatenate((marks[0] - far, _columns(marks, SURFACE_COLUMNS), marks, marks[-1] + far)))


def _depths(marks: Array) -> Array:
    first, last = SHALLOWEST * float(np.diff(marks).min()), DEEPEST * 0.5 * float(marks[-1] - marks[0])
    return np.geomspace(first, last, int(np.ceil(np.log(last / first) / np.log(RATIO))) + 1)


def _thinned(x: Array, spacing: float) -> Array:
    """A subset of x (ascending) with one of every cell of that width, so that depth decides how many columns there are."""
    cell = np.floor((x - x[0]) / spacing)
    return x[np.concatenate(([True], cell[1:] != cell[:-1]))]


def _nearest(x: Array, to: Array) -> NDArray[np.intp]:
    k = np.clip(np.searchsorted(x, to), 1, max(len(x) - 1, 1))
    if len(x) == 1:
        return np.zeros(len(to), dtype=np.intp)
    return k - (to - x[k - 1] < x[k] - to)
