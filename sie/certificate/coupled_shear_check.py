"""The certificate of dissimilar bodies: equations (1) and (12) where the halves are unlike.

The loads are P, then Q; or P under a profile that is not symmetric.

They are measured on p and q alone, as in `coupled_check`.

    residual   max |1/π PV∫p/(x - t) dt - β q - E*/2 h'| / peak   in the whole contact
    of (12)    max |γ - γ'| / largest |q|,   γ = 1/π PV∫q/(x - t) dt + β p   in stick

γ' is the same under P alone: what sticks keeps it. The integrals are Gauss rules on panels that
shrink towards every place where a traction is not smooth, with the value at x subtracted.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.contact.small_strains import notes
from sie.friction.coupled.sheared import ShearedContact
from sie.friction.coupled.uneven_contact import UnevenContact
from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import EPS
from sie.problem.scene import Scene
from sie.progress_bar import reported

from .coupled_check import OUTSIDE, gradient_of_slip, kind_of_slip
from .result import Certificate, ShearCertificate

Array = NDArray[np.float64]
State = ShearedContact | UnevenContact

PROMISED, OF_SHEAR = 1e-10, 1e-9  # of the largest pressure, and of the largest shear in (12)
NODES, RATIO = 14, 4.0
NEAREST = 1e-10  # panels next to a mark: the first, in parts of the way to the next
DISTINCT = 1e3  # roundings of x: the first of these panels at least
NARROW = 1e-12  # half-widths: marks that are nearer are one
LOOKS = 5  # points between two marks at which the equations are measured
FEW = 24  # points at most


class Values(NamedTuple):
    """The edges of the contact, nodes in it, weights, and p and q there."""

    ends: tuple[float, float]
    x: Array
    weight: Array
    p: Array
    q: Array


@reported("certificate")
def sheared_certificate(state: State, scene: Scene, tol: float) -> Certificate:
    """Measured on p and q, and on those under P alone."""
    p, q = state.tractions
    values, marks = _values(state), _marks(state)
    nodes, weight = values.x, values.weight
    x = _looked_at(marks)
    at_p, at_q = p(x), q(x)
    Hp, Hq = _principal(values, values.p, x, at_p), _principal(values, values.q, x, at_q)
    peak, of_shear = float(values.p.max()), float(np.abs(values.q).max())
    beta, P = scene.beta, p.resultant
    H = scene.profile.slope(x)
    missed = float(np.abs(Hp - beta * at_q - 0.5 * scene.Estar * H).max()) / peak
    # What stuck under the lighter load shows whether γ stays
    zones = (state.lighter if isinstance(state, UnevenContact) else state).stick
    stuck = np.any([(x > lo) & (x < hi) for lo, hi in zones], axis=0)
    before = _kept_gradient(state, x[stuck], beta)
    drift = float(np.abs((Hq + beta * at_p)[stuck] - before).max(initial=0.0)) / of_shear
    rounded = EPS + 16.0 * EPS * peak / of_shear  # of p, which q is balanced with in (12)
    rounded += _one_ulp(q, values.q, values, x[stuck]) / of_shear
    m, r = state.contact.m, state.contact.r
    apart = np.diff(marks) / r
    rounding = EPS / float(apart.min())
    gaps = _gaps(state, scene)
    return Certificate(
        residual=missed,
        implied=missed,
        force=abs(float(weight @ values.p) - P) / P,
        moment=abs(float(weight @ (values.p * (nodes - m))) - (p.moment - m * P)) / (P * r),
        lowest_pressure=min(float(values.p.min()) / peak, 0.0),
        lowest_gap=float(gaps.min(initial=0.0)) / float(np.abs(gaps).max(initial=EPS)),
        abscissae=min(rounding, EPS / NARROW, _one_ulp(p, values.p, values, x) / peak),
        tol=max(tol, PROMISED),
        shear=_of_shear(state, scene, values, (drift, rounded), tol),
        notes=notes(H, peak / scene.Estar),
    )


def _one_ulp(
    traction: Callable[[Array], Array], at_nodes: Array, values: Values, x: Array
) -> float:
    """What one ulp of x does to a traction, and of the nodes to its principal value.

    Zones far narrower than the contact need not change it by much: it goes with a power of the
    distance in them.
    """
    middle = 0.5 * sum(values.ends)
    change = np.abs(traction(np.nextafter(x, middle)) - traction(x))
    of_nodes = np.abs(traction(np.nextafter(values.x, middle)) - at_nodes)
    apart = np.abs(x[:, None] - values.x)
    apart[apart == 0.0] = np.inf
    summed = (values.weight * of_nodes / apart).sum(axis=1) / np.pi
    return float((change + summed).max(initial=0.0))


def _kept_gradient(state: State, x: Array, beta: float) -> Array:
    """What the slip gradient was when x stuck, times E*/2."""
    if isinstance(state, UnevenContact):
        p, q = state.lighter.pressure_and_shear(x)
        values = _values(state.lighter)
        gradient: Array = _principal(values, values.q, x, q) + beta * p
        return gradient
    return gradient_of_slip(state.search.normal, np.abs(x - state.axis), beta)


def _values(state: State) -> Values:
    """The tractions at the nodes of a rule."""
    (p, q), marks = state.tractions, _marks(state)
    nodes, weight = _rule(marks)
    # Next to a mark that counts as another one a node may be that mark, where p may be infinite
    apart = ~np.isin(nodes, state.marks)
    nodes, weight = nodes[apart], weight[apart]
    if isinstance(state, UnevenContact):
        rows = state.pressure_and_shear(nodes)
        return Values((marks[0], marks[-1]), nodes, weight, rows[0], rows[1])
    return Values((marks[0], marks[-1]), nodes, weight, p(nodes), q(nodes))


def _of_shear(
    state: State,
    scene: Scene,
    values: Values,
    measured: tuple[float, float],
    tol: float,
) -> ShearCertificate:
    """What is measured on q, given the change of the slip gradient in stick and its rounding."""
    Q, peak, size = scene.tangential_load, float(values.p.max()), np.abs(values.q)
    if isinstance(state, UnevenContact):
        kind = kind_of_slip(state.full_stick, scene.beta)
    else:
        way = f"towards {'+' if Q > 0.0 else '-'}x"
        kind = f"{way} beside the stick zone; β couples p and q"
    excess = float((size - scene.friction * values.p).max()) / (scene.friction * peak)
    return ShearCertificate(
        residual=measured[0],
        equilibrium=abs(float(values.weight @ values.q) - Q) / float(values.weight @ size),
        excess=max(excess, 0.0),
        opposing=min(state.least_slip, 0.0),
        abscissae=measured[1],
        condition=1.0,
        advancing=True,
        kind=kind,
        tol=max(tol, OF_SHEAR),
    )


def _marks(state: State) -> tuple[float, ...]:
    """The marks of the tractions that are apart."""
    apart = NARROW * state.contact.r
    kept = [state.marks[0]]
    for x in state.marks[1:-1]:
        if x - kept[-1] > apart and state.marks[-1] - x > apart:
            kept.append(x)
    return (*kept, state.marks[-1])


def _gaps(state: State, scene: Scene) -> Array:
    """Gaps beside the contact."""
    contact, beyond = state.contact, state.contact.r * np.array(OUTSIDE)
    gaps = state.gap(np.append(contact.m - beyond, contact.m + beyond), scene.profile)
    return gaps[np.isfinite(gaps)]


def _rule(marks: tuple[float, ...]) -> tuple[Array, Array]:
    """Nodes and weights on panels that shrink towards every mark."""
    y, _, w = with_weight(NODES, 0.0, 0.0)
    x, weight = [], []
    for lo, hi in itertools.pairwise(marks):
        half = 0.5 * (hi - lo)
        # No node may be rounded to a mark, where p may be infinite
        nearest = max(NEAREST, DISTINCT * EPS * max(abs(lo), abs(hi)) / half)
        levels = math.ceil(math.log(1.0 / nearest) / math.log(RATIO))
        near = np.append(0.0, RATIO ** -np.arange(levels, -0.5, -1.0))
        part = (near[:-1, None] + np.diff(near)[:, None] * y).ravel()
        mass = (np.diff(near)[:, None] * w).ravel()
        x += [lo + half * part, hi - half * part[::-1]]
        weight += [half * mass, half * mass[::-1]]
    return np.concatenate(x), np.concatenate(weight)


def _looked_at(marks: tuple[float, ...]) -> Array:
    """Points between the marks, not on nodes."""
    ends = np.array(marks)
    lo, hi = ends[:-1], ends[1:]
    wide = hi - lo > 1e-6 * (ends[-1] - ends[0])
    part = (np.arange(LOOKS) + 0.47) / LOOKS
    x = (lo[wide, None] + (hi - lo)[wide, None] * part).ravel()
    return x[:: max(1, len(x) // FEW)]


def _principal(values: Values, f: Array, x: Array, at_x: Array) -> Array:
    """1/π PV∫f/(x - t) dt over the whole contact, given f at x."""
    lo, hi = values.ends
    total = ((f - at_x[:, None]) / (x[:, None] - values.x)) @ values.weight
    integral: Array = (total + at_x * np.log((x - lo) / (hi - x))) / math.pi
    return integral
