"""The certificate of coupled partial slip: equations (1) and (12), measured on p and q alone.

    residual   max |1/π PV∫p/(x - t) dt - β q - E*/2 h'| / peak   in the whole contact
    of (12)       max |γ - γ'| / largest |q|,   γ = 1/π PV∫q/(x - t) dt + β p       in stick

γ' is the same under a lighter load under which x already stuck (0 under a flat punch): in stick
the slip gradient stays. The integrals are Gauss rules on panels that shrink towards every place
where a traction is not smooth, with the value at x subtracted; they use the values of p and q
alone.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sie.contact.small_strains import notes
from sie.friction.coupled.contact import CoupledContact
from sie.numerics.interval import EPS
from sie.problem.scene import Scene
from sie.progress_bar import reported

from .coupled_rule import (
    Values,
    distinct_marks,
    principal_value,
    to_edge,
    values_on_panels,
)
from .result import Certificate, ShearCertificate

Array = NDArray[np.float64]

PROMISED, OF_SHEAR = 1e-11, 1e-10  # of the largest pressure, and of the largest shear in (12)
LOOKS = 5  # points of each of the middle panels at which the equations are measured
P_ROUNDING = 16.0 * EPS  # of p, which q is balanced with in (12)
LIGHTER = 0.9  # of the growth beyond the flat base
BESIDE = 0.02  # of the half-width: no point of the residual is nearer to a sharp edge
OUTSIDE = (1.0 + 1e-6, 1.001, 1.1, 2.0, 10.0)  # half-widths at which the gap is tested


@reported("certificate")
def coupled_certificate(state: CoupledContact, scene: Scene, tol: float) -> Certificate:
    """Measured on p and q under the load, and q also under a lighter one."""
    values, x = values_on_panels(state), _looked_at(state)
    p, q = state.pressure_and_shear(x)
    Hp, Hq = (principal_value(values, state, x, f, s) for f, s in ((p, 1.0), (q, -1.0)))
    slopes = scene.profile.slope(state.axis + x), -scene.profile.slope(state.axis - x)
    peak = float(p.max())
    G, beta = state.half_modulus, scene.beta
    missed = max(float(np.abs(Hp - beta * q - G * H).max()) for H in slopes) / peak
    gamma = Hq + beta * p
    stuck, of_shear = _drift(state, x, gamma, beta), float(np.abs(q).max())
    rounding = EPS + (_of_nodes(values, state, x, values.p) + _of_slope(state, scene, x)) / peak
    of_q = EPS + _of_nodes(values, state, x, values.q) / of_shear
    f_p = scene.friction * p
    beside = state.b * np.array(OUTSIDE)
    gaps = state.gap(state.axis + beside, scene.profile)
    finite = gaps[np.isfinite(gaps)]
    flow = sum(panel.load(state.ahead) for panel in state.growth) + state.corner_load
    shear = ShearCertificate(
        residual=stuck / of_shear,
        equilibrium=abs(flow - state.load) / state.load,
        excess=max(float((np.abs(q) - f_p).max()) / float(f_p.max()), 0.0),
        opposing=min(float((state.sign * state.slip(x)).min()), 0.0),
        abscissae=of_q + P_ROUNDING * peak / of_shear,
        condition=1.0,
        advancing=True,
        kind=kind_of_slip(state.full_stick, scene.beta),
        tol=max(tol, OF_SHEAR),
    )
    return Certificate(
        residual=missed,
        implied=missed,
        force=abs(2.0 * float(values.weight @ values.p) - state.load) / state.load,
        moment=0.0,
        lowest_pressure=min(float(p.min()) / peak, 0.0),
        lowest_gap=float(finite.min(initial=0.0)) / float(np.abs(finite).max(initial=EPS)),
        abscissae=rounding,
        tol=max(tol, PROMISED),
        shear=shear,
        notes=notes(np.concatenate(slopes), peak / scene.Estar),
    )


def kind_of_slip(full_stick: bool, beta: float) -> str:
    """The slip under a normal load alone, in words."""
    way = f"{'outwards' if beta > 0.0 else 'inwards'} on both sides while the normal load grew"
    if full_stick:
        way = "full stick, its zones narrower than 1e-15 of the contact"
    return f"{way}; β couples p and q"


def _drift(state: CoupledContact, x: Array, gamma: Array, beta: float) -> float:
    """The largest change of γ, since the stick zone reached x, where that can be measured."""
    base = state.flat_base
    if not state.growth:
        inside = x < state.flat.c * state.b
        return float(np.abs(gamma[inside]).max(initial=0.0))
    ahead = state.ahead if state.corner_load else LIGHTER * state.ahead
    load, b = sum(panel.load(ahead) for panel in state.growth), base + ahead
    kinks = tuple(k for k in state.kinks if k < b)
    lighter = replace(state, ahead=ahead, corner_load=0.0, load=load, kinks=kinks)
    inside = x < 0.999 * state.flat.c * b
    x = x[inside]
    before = gradient_of_slip(lighter, x, beta)
    return float(np.abs(gamma[inside] - before).max(initial=0.0))


def gradient_of_slip(state: CoupledContact, y: Array, beta: float) -> Array:
    """γ = 1/π PV∫q/(x - t) dt + β p at 0 < y < b."""
    p, q = state.pressure_and_shear(y)
    gamma: Array = principal_value(values_on_panels(state), state, y, q, -1.0) + beta * p
    return gamma


def _looked_at(state: CoupledContact) -> Array:
    """Points between the marks, not on nodes."""
    ends = (0.0, *distinct_marks(state))
    part = (np.arange(LOOKS) + 0.5) / LOOKS
    x = np.concatenate([lo + (hi - lo) * part for lo, hi in itertools.pairwise(ends)])
    if state.corner_load:
        x = x[x < (1.0 - BESIDE) * state.b]
    kept: Array = x[(x > BESIDE * state.marks[0]) & ~np.isin(x, ends)]
    return kept


def _of_nodes(values: Values, state: CoupledContact, x: Array, f: Array) -> float:
    """What rounding of the nodes does to the principal value of f: the root of sums of squares.

    Where f is singular or changes in a strip they are as exact as their distance from the edge.
    """
    order = np.argsort(-values.rest, kind="stable")
    y, rest, weight, f = (column[order] for column in (values.y, values.rest, values.weight, f))
    by_rest = state.narrow or state.corner_load > 0.0
    moved = EPS * (np.minimum(y, rest) if by_rest else y)
    steps = np.maximum(-np.diff(rest, prepend=state.b), moved)
    change = np.abs(np.diff(f, prepend=f[0])) * moved / steps
    apart = np.abs(np.where(rest < y, rest - to_edge(state, x)[:, None], x[:, None] - y))
    moves = weight * change / np.maximum(apart, moved)
    return float(np.linalg.norm(moves, axis=1).max()) / math.pi


def _of_slope(state: CoupledContact, scene: Scene, x: Array) -> float:
    """What rounding of x does to E*/2 h': x is a distance from the axis, and exact at 0."""
    if not state.axis:
        return 0.0
    at, slope = state.axis + np.append(x, -x), scene.profile.slope
    change = slope(np.nextafter(at, np.inf)) - slope(at)
    return state.half_modulus * float(np.abs(change).max())
