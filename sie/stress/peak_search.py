"""The largest value of a measure of stress in the body: scanned at every scale, polished by Newton.

Scan.  Fp and Fq are analytic in the body and, through every smooth part of the surface, beyond it:
cells as large as a fraction of the distance from what is not smooth resolve them (`scan_columns`).
The scan goes from the depth up to the surface. It leaves out windows where the values, at one scale
and on the surface, are too small for a maximum at a finer scale. Every local maximum of the scan is
a start, and so are its neighbours on both sides, because two maxima may lie on either side of a
saddle under the centre. Points beneath a maximum of the surface (`surface_peaks`) from which the
measure grows inwards are starts too.

Polishing.  Derivatives up to the third come from Cauchy's formula on a circle inside the body, with
ρ = y/400 exact to 400^-N,

    F^(n)(z) = n!/(N ρ^n) Σ_j F(z + ρ ω^j) ω^(-nj),      ω = exp(2πi/N)

so that gradient and Hessian are those of the stress itself, without finite differences.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import reported, step_done

from .half_plane import Tractions, potentials
from .scan_columns import FAR_COLUMNS, RATIO, Mesh, mesh_of, thinned
from .surface_peaks import (
    WORTH,
    Maximum,
    Measure,
    on_surface,
    slope,
    surface_values,
    values_inside,
)

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Row = tuple[float, Array, Array]  # of the scan: the depth, and ascending abscissae with values

# A column begins at this part of the scale s of its place.
SHALLOW = 0.06
# The largest depth of the scan in half-widths.
DEEPEST = 4.0
# Depths between two decisions on which columns to leave out.
LEVELS = 6
# Columns nearer to a mark, in depths, are left out, and columns nearer to each other.
SPACING = 0.15
CELL = 0.03
# Columns farther apart, in depths, are no neighbours.
ALONE = 8.0
# Columns whose values are below HOPELESS times the largest one within WINDOW depths are left out.
HOPELESS = 0.8
WINDOW = 4.0
# So are those where so many oscillations of the surface values do not reach the largest one.
SWINGS = 4.0
MOST_STARTS = 48
# A top of the scan is a start if the best value is no farther above it than this times its falls.
SAFETY = 2.0
# Points on a circle, and the depth over its radius: seven digits of the third derivative are good.
CIRCLE = 4
RADIUS = 400.0
# After PATIENCE steps a start goes on only if its value is at least CLOSE times the highest.
PATIENCE = 6
CLOSE = 0.99
# Newton steps, and the longest one in depths.
STEPS = 60
LONGEST = 0.3
# After a step that is so short, in depths, the next one, its square, is below rounding.
SETTLED = 1e-7
# Rounding of a value, and a trust region in depths in which it exceeds every gain.
SAME_VALUE = 4e-15
STUCK = 1e-9
# Starts nearer to each other, in depths, are one.
TOGETHER = 1e-3
# A path that rises above this part of the depth of its start, or of the shallowest start there,
# belongs to the surface.
LEFT = 0.25
# Depths of starts beneath a maximum of the surface, in units of the scale s there.
INWARDS = 0.3 ** np.arange(1.0, 14.0)
# Maxima whose values are this close are tied, and at places this close, in half-widths, the same.
TIED = 1e-10
SAME_PLACE = 1e-7


class Local(NamedTuple):
    """s, D_r, D_i and their derivatives in units of the depth.

    Each array has a first axis (s, D_r, D_i) of length 3.
    """

    value: Array
    x: Array
    y: Array
    xx: Array
    xy: Array
    yy: Array


@reported("largest stress")
def largest(tractions: Tractions, measure: Measure) -> tuple[Maximum, ...]:
    """The largest value in the body, and every place where it is reached, from the left.

    Values within TIED of it count as equal.
    """
    mesh = mesh_of(tractions)
    surface = surface_values(tractions, mesh.surface)
    found = on_surface(tractions, measure, mesh, surface)
    found += inside(tractions, measure, mesh, surface[:, FAR_COLUMNS:-FAR_COLUMNS], found)
    best = max(m.value for m in found)
    r = 0.5 * float(np.diff(tractions.pressure.interval)[0])
    tied = [m for m in found if m.value == best or m.value >= best * (1.0 - TIED)]
    ties: list[Maximum] = []
    for m in sorted(tied, key=lambda m: (m.y > 0.0, -m.value)):
        if all(abs(m.x - t.x) + abs(m.y - t.y) > SAME_PLACE * r for t in ties):
            ties.append(Maximum(best, m.x, m.y))
    return tuple(sorted(ties, key=lambda m: m.x))


# -- inside ----------------------------------------------------------------------------------------


def inside(
    tractions: Tractions, measure: Measure, mesh: Mesh, above: Array, known: list[Maximum]
) -> list[Maximum]:
    """Local maxima below the surface that may be larger than the known ones.

    `above` holds the values on the surface over the columns.
    """
    best = max(m.value for m in known)
    if np.isinf(best):
        return []
    rows = _rows(tractions, measure, mesh, above, best)
    best = max(best, *(value.max() for _, _, value in rows))
    floor = WORTH * best
    beneath = [m.x for m in known if m.value >= floor]
    starts = np.concatenate((_starts(rows, best), _beneath(tractions, measure, mesh, beneath)))
    if not starts.size:
        return []
    z = _climbed(tractions, measure, mesh, starts, best)
    values = measure.value(values_inside(tractions, z))
    return [
        Maximum(*row) for row in zip(values.tolist(), z.real.tolist(), z.imag.tolist(), strict=True)
    ]


def _starts(rows: list[Row], best: float) -> Complex:
    """The local maxima of the scan that may exceed the best value, and neighbours left and right.

    Between the places of a scan a concave top exceeds the middle value in each direction by no more
    than the fall to a neighbour.
    """
    starts, values = [np.zeros(0, dtype=complex)], [np.zeros(0)]
    for k, (y, x, value) in enumerate(rows):
        if value.max() < WORTH * best:
            continue
        apart = np.concatenate(([True], np.diff(x) > ALONE * y, [True]))
        left = np.where(apart[:-1], -np.inf, np.append(-np.inf, value[:-1]))
        right = np.where(apart[1:], -np.inf, np.append(value[1:], -np.inf))
        top = np.flatnonzero((value >= left) & (value >= right) & (value >= WORTH * best))
        if not top.size:
            continue
        falls = value[top] - np.stack((left[top], right[top], *[np.full(len(top), -np.inf)] * 2))
        # Towards a mark a value may be constant up to rounding.
        for fall, other, margin in zip(falls[2:], (k - 1, k + 1), (0.0, SAME_VALUE), strict=True):
            if 0 <= other < len(rows):
                _, x_other, value_other = rows[other]
                nearest = np.abs(x_other[:, None] - x[top]).argmin(axis=0)
                seen = np.abs(x_other[nearest] - x[top]) <= y
                fall[seen] = value[top[seen]] - value_other[nearest[seen]] * (1.0 + margin)
        beside, above = (_largest_known(pair) for pair in (falls[:2], falls[2:]))
        top = top[(falls >= 0.0).all(axis=0) & (value[top] + SAFETY * (beside + above) >= best)]
        chosen = np.unique(np.clip(np.concatenate((top - 1, top, top + 1)), 0, len(x) - 1))
        starts.append(x[chosen] + 1j * y)
        values.append(value[chosen])
    z: Complex = np.concatenate(starts)
    return z[np.argsort(-np.concatenate(values), kind="stable")][:MOST_STARTS]


def _largest_known(falls: Array) -> Array:
    """The larger of two falls, where one is infinite the other."""
    return np.where(np.isinf(falls).any(axis=0), falls.min(axis=0), falls.max(axis=0))


def _rows(
    tractions: Tractions, measure: Measure, mesh: Mesh, above: Array, best: float
) -> list[Row]:
    """The rows of the scan, the deepest first; a few depths at a time."""
    columns, distance, shallow = mesh.x, mesh.distance, SHALLOW * mesh.scale(mesh.x)
    y, rows = DEEPEST * 0.5 * float(mesh.marks[-1] - mesh.marks[0]), list[Row]()
    while columns.size:
        step_done(0)
        levels = (y / RATIO ** np.arange(LEVELS)).tolist()
        xs = []
        for level in levels:
            apart = (distance == 0.0) | (distance >= SPACING * level)
            xs.append(thinned(columns[(shallow <= level) & apart], CELL * level))
        new = [row for row in _values_on(tractions, measure, levels, xs) if len(row[1])]
        if not new:
            break
        rows += new
        best = max(best, *(value.max() for _, _, value in new))
        _, x, value = new[-1]
        k = np.searchsorted(x, columns)
        beside = np.maximum(value[np.maximum(k - 1, 0)], value[np.minimum(k, len(x) - 1)])
        size, swing = _bounds(columns, above, WINDOW * levels[-1])
        stay = np.maximum(beside, measure.value(size + swing)) >= HOPELESS * best
        stay &= (measure.value(size + SWINGS * swing) >= best) & (shallow < levels[-1])
        columns, shallow = columns[stay], shallow[stay]
        distance, above = distance[stay], above[:, stay]
        y /= RATIO**LEVELS
    return rows


def _values_on(
    tractions: Tractions, measure: Measure, levels: list[float], xs: list[Array]
) -> list[Row]:
    """The rows at these depths, from one evaluation of the potentials."""
    z = np.concatenate([x + 1j * level for x, level in zip(xs, levels, strict=True)])
    values = np.split(
        measure.value(values_inside(tractions, z)), np.cumsum([len(x) for x in xs[:-1]])
    )
    return list(zip(levels, xs, values, strict=True))


def _bounds(x: Array, above: Array, window: float) -> tuple[Array, Array]:
    """Approximate bounds of |s|, |D_r| and |D_i| at a depth below the window's width, in two parts.

    They are the largest values on the surface within the windows around x, and their oscillation.

    s and Fq are harmonic, and y Φ' is not larger than the oscillation of Φ around it, but for a
    factor of 2/π.
    """
    cell = np.floor((x - x[0]) / window)
    first = np.flatnonzero(np.append(True, cell[1:] != cell[:-1]))
    low, high = np.minimum.reduceat(above, first, axis=1), np.maximum.reduceat(above, first, axis=1)
    low, high = (np.pad(v, ((0, 0), (1, 1)), mode="edge") for v in (low, high))
    low = np.minimum(np.minimum(low[:, :-2], low[:, 2:]), low[:, 1:-1])
    high = np.maximum(np.maximum(high[:, :-2], high[:, 2:]), high[:, 1:-1])
    size = np.maximum(-low, high)
    swing = np.where(np.isinf(size), np.inf, high - np.where(np.isinf(low), 0.0, low)).sum(axis=0)
    count = np.diff(np.append(first, len(x)))
    return np.repeat(size, count, axis=1), np.repeat(swing, count)


def _beneath(tractions: Tractions, measure: Measure, mesh: Mesh, places: list[float]) -> Complex:
    """Starts beneath those maxima of the surface from which the measure grows inwards.

    Each is the best of some depths.
    """
    x = np.array(places)
    x = x[~np.isin(x, tractions.marks)]
    if x.size:
        x = x[slope(tractions, measure, x, inwards=True) > 0.0]
    if not x.size:
        return np.zeros(0, dtype=complex)
    z = x[:, None] + 1j * mesh.scale(x)[:, None] * INWARDS
    value = measure.value(values_inside(tractions, z.ravel())).reshape(z.shape)
    starts: Complex = z[np.arange(len(x)), value.argmax(axis=1)]
    return starts


def _climbed(
    tractions: Tractions, measure: Measure, mesh: Mesh, z: Complex, highest: float
) -> Complex:
    """The maxima inside that Newton's method reaches, with every step uphill.

    Starts that leave through the surface are dropped, and those that stay below the `highest` value
    that is known.
    """
    rest: list[Complex] = []
    lowest = LEFT * np.minimum(z.imag, SHALLOW * mesh.scale(z.real))
    before, value, trust = z, np.full(z.shape, -np.inf), np.full(z.shape, LONGEST)
    for k in range(STEPS):
        if not z.size:
            break
        step_done(0)
        at = _local(tractions, z)
        here = measure.value(at.value)
        highest = max(highest, here.max())
        uphill = here >= value * (1.0 - SAME_VALUE)
        trust = np.where(uphill, np.minimum(2.0 * trust, LONGEST), 0.25 * trust)
        step = _newton(measure, at)
        length = np.abs(step)
        step *= z.imag
        done = uphill & (length <= SETTLED)
        rest.append((z + step)[done])
        step *= np.minimum(1.0, trust / np.maximum(length, 1e-300))
        # back to the better point, and from there a step half as long
        new = np.where(uphill, z + step, before + 0.25 * (z - before))
        before, value = np.where(uphill, z, before), np.where(uphill, here, value)
        stuck = trust <= STUCK
        rest.append(before[stuck & ~done])
        keep = ~done & ~stuck & (new.imag > lowest) & ((k < PATIENCE) | (here >= CLOSE * highest))
        z, before, value, trust, lowest = _distinct(
            new[keep], before[keep], value[keep], trust[keep], lowest[keep]
        )
    rest.append(z)
    return np.concatenate(rest)


def _distinct(z: Complex, *others: Any) -> tuple[Any, ...]:
    """The points without those that coincide, which would have the same steps."""
    same = np.abs(z[:, None] - z) <= TOGETHER * z.imag
    first = same.argmax(axis=1) == np.arange(len(z)) if z.size else np.zeros(0, dtype=bool)
    return z[first], *(other[first] for other in others)


def _newton(measure: Measure, at: Local) -> Complex:
    """The step -H⁻¹ g to a maximum, in units of the depth.

    Every eigenvalue of H is taken as negative, so that the step leads uphill from any point.
    """
    g, G = measure.gradient(at.value), measure.hessian(at.value)
    gx, gy = (g * at.x).sum(axis=0), (g * at.y).sum(axis=0)
    Gx, Gy = (G * at.x).sum(axis=1), (G * at.y).sum(axis=1)
    hxx, hxy, hyy = (
        (g * second + u * Gv).sum(axis=0)
        for second, u, Gv in ((at.xx, at.x, Gx), (at.xy, at.x, Gy), (at.yy, at.y, Gy))
    )
    mean, half = 0.5 * (hxx + hyy), np.hypot(0.5 * (hxx - hyy), hxy)
    angle = 0.5 * np.arctan2(2.0 * hxy, hxx - hyy)
    cos, sin = np.cos(angle), np.sin(angle)
    along, across = gx * cos + gy * sin, gy * cos - gx * sin
    least = 1e-12 * (abs(mean) + half) + 1e-300
    a, b = along / np.maximum(abs(mean + half), least), across / np.maximum(abs(mean - half), least)
    step = np.empty(gx.shape, dtype=complex)
    step.real, step.imag = a * cos - b * sin, a * sin + b * cos
    return step


def _local(tractions: Tractions, z: Complex) -> Local:
    """(s, D_r, D_i) and two derivatives of each, in units of the depth, at z (1-d).

    They follow from the potentials on circles inside the body.
    """
    y = z.imag
    omega = np.exp(2j * np.pi * np.arange(CIRCLE) / CIRCLE)
    circle = (z[:, None] + (y / RADIUS)[:, None] * omega).ravel()
    Phi, dPhi, Fq = (f.reshape(len(z), CIRCLE) for f in potentials(tractions, circle))
    n = np.arange(3)
    taylor = omega.conj()[:, None] ** n * (RADIUS**n * (1.0, 1.0, 2.0) / CIRCLE)
    (P0, P1, P2), (D1, D2, D3), (Q0, Q1, Q2) = (
        f.T for f in (Phi @ taylor, (y[:, None] * dPhi) @ taylor, Fq @ taylor)
    )
    s = (P0.imag, P1.imag, P1.real, P2.imag, P2.real, -P2.imag)
    D = (Q0 - D1, Q1 - D2, -D1 - 1j * (D2 - Q1), Q2 - D3, -D2 - 1j * (D3 - Q2), -2j * D2 + D3 - Q2)
    half = 0.5 * tractions.bulk_stress
    rows = np.empty((len(s), 3, len(z)))
    for row, a, b in zip(rows, s, D, strict=True):
        row[0], row[1], row[2] = a, b.real, b.imag
    rows[0, 0] += half
    rows[0, 1] -= half
    return Local(*rows)
