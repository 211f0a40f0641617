"""The certificate of dissimilar bodies: equations (1) and (12), measured on p and q alone.

    residual   max |1/π PV∫p/(x - t) dt - β q - E*/2 h'| / peak   in the whole contact
    of (12)    max |γ - γ'| / largest |q|,   γ = 1/π PV∫q/(x - t) dt + β p   in stick

γ' is that of an earlier state, in which x stuck already (0 if none came before): in stick the slip
gradient stays. The integrals are Gauss rules on panels that shrink towards every place where a
traction is not smooth, with the value at x subtracted.

A state has the values of p and q (`InContact`) and their potentials, its zones, and the earlier
state. In Goodman's approximation (1) is measured without β q.
In full stick, of a flat punch, γ is 0 on the whole contact; tension is allowed there.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.cauchy.density import JacobiDensity
from sie.contact.known_contact import Edges
from sie.contact.small_strains import BESIDE as REGULAR
from sie.contact.small_strains import notes
from sie.friction.state import intervals
from sie.numerics.graded_panels import OF_RULES, Rule, gauss_shares
from sie.numerics.interval import EPS
from sie.problem.scene import Scene
from sie.progress_bar import reported
from sie.traction.base import InContact

from .result import Certificate, ShearCertificate
from .shear_check import ENDS, excess

if TYPE_CHECKING:
    from sie.friction.coupled.answer import CoupledContact as State

Array = NDArray[np.float64]

PROMISED, OF_SHEAR = 1e-11, 1e-10  # of the largest pressure, and of the largest shear in (12)
BREAKS = (0.0, *10.0 ** np.arange(-17.0, -8.0), *OF_RULES[1:])  # of the rule: powers at edges
NODES = 18  # on a panel of it
SAME = 1e-12  # half-widths: marks that are nearer are one
# places between two marks at which the equations are measured, between the edges alone, and in all
LOOKS, ALONE, MOST = 5, 16, 60
WIDE = 1e-6  # of the contact: on narrower parts x tells too few digits of a place
BESIDE = 0.02  # half-widths: no such place is nearer to a sharp edge
P_ROUNDING = 16.0 * EPS  # of p, which q is balanced with in (12)
LEAST = float(np.finfo(float).tiny)
OUTSIDE = (1.0 + 1e-6, 1.001, 1.1, 2.0, 10.0)  # half-widths at which the gap is tested


@reported("certificate")
def coupled_certificate(state: State, scene: Scene, tol: float) -> Certificate:
    """Both equations and equilibrium, measured on a state of a scene."""
    v = state.values
    on = Measure(v)
    (p, q), (P, M) = on.at(on.places), (state.tractions[0].resultant, state.tractions[0].moment)
    G, r, middle = 0.5 * scene.Estar, v.contact.r, v.contact.m + v.origin
    x = v.origin + on.places
    H = scene.profile.slope(x)
    of_x = float(np.abs(scene.profile.slope(np.nextafter(x, np.inf)) - H).max())
    beta = 0.0 if scene.neglects_beta else scene.beta
    peak, missed = float(p.max()), float(np.abs(on.hilbert(on.places)[0] - beta * q - G * H).max())
    force, moment = (on.rows[0] @ (on.weight * arm) for arm in (1.0, on.nodes - v.contact.m))
    away = r * np.array(OUTSIDE)
    gaps = state.gap(np.append(middle - away, middle + away), scene.profile)
    gaps = gaps[np.isfinite(gaps)]
    return Certificate(
        residual=missed / peak,
        implied=missed / peak,
        force=abs(float(force) - P) / P,
        moment=abs(float(moment) - (M - middle * P)) / (P * r),
        lowest_pressure=min(float(on.rows[0].min()) / peak, 0.0),
        lowest_gap=float(gaps.min(initial=0.0)) / float(np.abs(gaps).max(initial=EPS)),
        abscissae=EPS + (on.rounding(on.places)[0] + G * of_x * bool(v.origin)) / peak,
        tol=max(tol, PROMISED),
        shear=shear_certificate(state, scene, tol, on),
        notes=notes(H, peak / scene.Estar),
    )


def shear_certificate(
    state: State, scene: Scene, tol: float, on: Measure | None = None
) -> ShearCertificate:
    """The law of friction, equilibrium, and (12) with what came before."""
    v, on = state.values, on or Measure(state.values)
    (p, q), r = on.rows, v.contact.r
    missed, rounding = _change_of_gradient(state, on, scene.beta)
    of_shear, peak = (
        float(np.abs(q[on.rest > BESIDE * r * v.exact]).max()),
        float(on.at(on.places)[0].max()),
    )
    size, highest = float(on.weight @ np.abs(q)), scene.friction * peak
    zones = [(lo - v.origin, hi - v.origin, sign) for lo, hi, sign in state.slip_zones]
    known = v.exact | (on.rest > ENDS * (r + abs(v.contact.m)))
    told = (values[known] for values in (on.nodes, scene.friction * p, q))
    return ShearCertificate(
        residual=missed / of_shear,
        equilibrium=abs(float(on.weight @ q) - scene.tangential_load) / size,
        excess=max(excess(zones, v.contact, *told), 0.0) / highest,
        opposing=min(state.least_slip, 0.0),
        abscissae=EPS + (rounding + P_ROUNDING * peak) / of_shear,
        condition=1.0,
        advancing=True,
        kind=state.kind,
        tol=max(tol, OF_SHEAR),
    )


def _change_of_gradient(state: State, on: Measure, beta: float) -> tuple[float, float]:
    """The largest change of γ in the zone that it is kept in, and what rounding changes in it.

    Without a zone nothing is known, and doubles tell too few places of a narrow one. Where the
    earlier state has the same edges Q alone made the change, and that by P is measured as well.
    """
    (zone, before), origin = state.kept, state.values.origin
    lo, hi = (end - origin for end in zone)
    if not lo < hi:
        return math.inf, 0.0
    if hi - lo < WIDE * 2.0 * on.contact.r:
        return 0.0, 0.0
    x = on.places[(on.places > lo) & (on.places < hi)]
    if not x.size:
        x = lo + (hi - lo) * (np.arange(LOOKS) + 0.53) / LOOKS
    changed, rounding = on.gradient(x, beta) - state.strain_kept, float(on.rounding(x)[1])
    if before is None:
        return float(np.abs(changed).max()), rounding
    earlier = Measure(before.values)
    same = x + (origin - before.values.origin)
    missed = float(np.abs(changed - earlier.gradient(same, beta)).max())
    rounding += float(earlier.rounding(same)[1])
    if np.abs(np.subtract(earlier.contact[:2], on.contact[:2])).max() <= SAME * on.contact.r:
        others = _change_of_gradient(before, earlier, beta)
        return max(missed, others[0]), max(rounding, others[1])
    return missed, rounding


def full_stick_certificate(
    edges: Edges, found: JacobiDensity, scene: Scene, tol: float
) -> Certificate:
    """Residual of both equations on a graded quadrature, and equilibrium."""
    (part,), contact = found.parts, edges.contact

    def rows(x: Array, rest: Array) -> Array:
        other, on_left = 2.0 * contact.r - rest, x < contact.m
        phi = part.value(np.where(on_left, other, rest), np.where(on_left, rest, other))
        return np.stack((phi.real, phi.imag))

    values = InContact(contact, (contact.x1, contact.x2), rows, exact=True)
    on = Measure(values)
    at, (p, _), load = on.at(on.places), on.rows, on.rows @ on.weight
    residual = on.hilbert(on.places) + scene.beta * np.stack((-at[1], at[0]))
    residual[0] -= 0.5 * scene.Estar * edges.tilt
    loads = np.array([edges.normal_load, scene.tangential_load])
    moment, size = float(on.weight @ (p * on.left)) + contact.x1 * load[0], np.hypot(*loads)
    highest = float(p[on.rest > REGULAR * contact.r].max())
    return Certificate(
        residual=float(np.hypot(*residual).max() / np.hypot(*at).max()),
        implied=found.error,
        force=float(np.hypot(*(load - loads)) / size),
        moment=float(abs(moment - edges.moment) / (size * contact.r)),
        lowest_pressure=0.0,
        lowest_gap=0.0,
        abscissae=0.0,
        tol=tol,
        notes=notes(np.array([edges.tilt]), highest / scene.Estar),
    )


class Measure:
    """Principal values of p and q by a rule on the contact that is graded towards all marks.

    nodes, weight   of the rule
    left, rest      the distances of the nodes from the left edge, and from the nearer one
    rows            p and q there
    """

    def __init__(self, values: InContact) -> None:
        self.values, self.contact = values, values.contact
        same = 0.0 if values.exact else SAME * self.contact.r
        ends = intervals([self.contact[:2]], np.unique(values.marks), same)
        self.rule = Rule.of(ends, gauss_shares(BREAKS, NODES))
        self.nodes, self.weight = self.rule.x, self.rule.weight
        self.left = self.rule.apart_from(self.contact.x1)
        self.right = -self.rule.apart_from(self.contact.x2)
        self.rest = np.minimum(self.left, self.right)
        self.rows = self._rows(self.nodes, self.rest)

    def _rows(self, x: Array, rest: Array) -> Array:
        """p and q, with 0 in place of infinities at a mark that rounding put a place on."""
        found = self.values.rows(x, rest)
        return np.where(np.isfinite(found), found, 0.0)

    @cached_property
    def places(self) -> Array:
        """Places between the marks at which the equations are measured, half-way between nodes."""
        length = np.diff(self.rule.ends).ravel()
        wide = length > WIDE * 2.0 * self.contact.r
        looks = max(LOOKS, ALONE // len(wide))
        part = (np.arange(looks) + 0.53) / looks
        x = (self.rule.ends[wide, :1] + length[wide, None] * part).ravel()
        beside = BESIDE * self.contact.r * self.values.exact
        x = x[(x > self.contact.x1 + beside) & (x < self.contact.x2 - beside)]
        after = np.searchsorted(self.nodes, x[:: -(-len(x) // MOST)])
        return np.asarray(0.5 * (self.nodes[after - 1] + self.nodes[after]))

    def at(self, x: Array) -> Array:
        """p and q at places."""
        return self._rows(x, np.minimum(x - self.contact.x1, self.contact.x2 - x))

    def _apart(self, x: Array) -> Array:
        """x less nodes, (places, nodes)."""
        apart = -np.array([self.rule.apart_from(place) for place in x.tolist()])
        apart[apart == 0.0] = np.inf
        return apart

    def hilbert(self, x: Array) -> Array:
        """1/π PV∫f/(x - t) dt of f = p and q at places, (2, places)."""
        kernel = self.weight / self._apart(x)
        own = np.log((x - self.contact.x1) / (self.contact.x2 - x)) - kernel.sum(axis=1)
        found: Array = (self.rows @ kernel.T + self.at(x) * own) / math.pi
        return found

    def gradient(self, x: Array, beta: float) -> Array:
        """γ, E*/2 times the gradient of the slip."""
        found: Array = self.hilbert(x)[1] + beta * self.at(x)[0]
        return found

    def rounding(self, x: Array) -> Array:
        """What one ulp of the nodes does to these integrals, f changing as from node to node."""
        by_x = np.spacing(np.maximum(np.abs(self.nodes), abs(self.values.origin)))
        ulp = (EPS * self.rest + LEAST if self.values.exact else by_x)[1:]
        steps = np.where(self.left < self.right, self.left, -self.right)
        steps = np.diff(np.where(self.values.exact, steps, self.nodes))
        moved = np.abs(np.diff(self.rows)) * (ulp / np.maximum(np.abs(steps), ulp))
        sums = (moved * self.weight[1:]) @ (1.0 / np.maximum(np.abs(self._apart(x)[:, 1:]), ulp)).T
        return np.asarray(sums.max(axis=1) / math.pi)
