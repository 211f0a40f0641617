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
from sie.numerics.gauss_jacobi import gauss_jacobi
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
NODES, RATIO = 18, 3.0  # panels towards a mark, in the root of the distance from it
ROOT = 3.0
AT_EDGE, INSIDE, OF_MANY = 17, 9, 3  # such panels at an edge, at a mark, at one of many
MANY = 24  # marks: most of them are faint kinks of a trace
SAME = 1e-12  # half-widths: marks that are nearer are one
# places between two marks at which the equations are measured, between the edges alone, and in all
LOOKS, ALONE, MOST = 5, 16, 120
WIDE = 1e-6  # of the contact: on narrower parts x tells too few digits of a place
BESIDE = 0.02  # half-widths: no such place is nearer to a sharp edge
P_ROUNDING = 16.0 * EPS  # of p, which q is balanced with in (12)
LEAST = float(np.finfo(float).tiny)
OUTSIDE = (1.0 + 1e-6, 1.001, 1.1, 2.0, 10.0)  # half-widths at which the gap is tested


@reported("certificate")
def coupled_certificate(state: State, scene: Scene, tol: float) -> Certificate:
    """Both equations and equilibrium, measured on a state of a scene."""
    v, nodes = state.values, Nodes(state.values)
    at = nodes.looked_at
    (p, q), (P, M) = at.rows, (state.tractions[0].resultant, state.tractions[0].moment)
    G, r, middle = 0.5 * scene.Estar, v.contact.r, v.contact.m + v.origin
    x = v.origin + at.x
    H = scene.profile.slope(x)
    of_x = float(np.abs(scene.profile.slope(np.nextafter(x, np.inf)) - H).max())
    (Hp, _), rounding = nodes.principal_values(at), nodes.rounding(at)[0]
    beta = 0.0 if scene.neglects_beta else scene.beta
    peak, missed = float(p.max()), float(np.abs(Hp - beta * q - G * H).max())
    force, moment = (nodes.rows[0] @ (nodes.weight * arm) for arm in (1.0, nodes.x - v.contact.m))
    away = r * np.array(OUTSIDE)
    gaps = state.gap(np.append(middle - away, middle + away), scene.profile)
    gaps = gaps[np.isfinite(gaps)]
    return Certificate(
        residual=missed / peak,
        implied=missed / peak,
        force=abs(float(force) - P) / P,
        moment=abs(float(moment) - (M - middle * P)) / (P * r),
        lowest_pressure=min(float(nodes.rows[0].min()) / peak, 0.0),
        lowest_gap=float(gaps.min(initial=0.0)) / float(np.abs(gaps).max(initial=EPS)),
        abscissae=EPS + (rounding + G * of_x * bool(v.origin)) / peak,
        tol=max(tol, PROMISED),
        shear=shear_certificate(state, scene, tol, nodes),
        notes=notes(H, peak / scene.Estar),
    )


def shear_certificate(
    state: State, scene: Scene, tol: float, nodes: Nodes | None = None
) -> ShearCertificate:
    """The law of friction, equilibrium, and (12) with what came before."""
    nodes = nodes or Nodes(state.values)
    (p, q), v = nodes.rows, state.values
    f_p, at = scene.friction * p, nodes.looked_at
    missed, rounding = _change_of_gradient(state, nodes, scene.beta)
    of_shear, peak = float(np.abs(q[nodes.regular]).max()), float(at.rows[0].max())
    size, highest = float(nodes.weight @ np.abs(q)), scene.friction * peak
    zones = [(lo - v.origin, hi - v.origin, sign) for lo, hi, sign in state.slip_zones]
    known = v.exact | (nodes.rest > ENDS * (v.contact.r + abs(v.contact.m)))
    return ShearCertificate(
        residual=missed / of_shear,
        equilibrium=abs(float(nodes.weight @ q) - scene.tangential_load) / size,
        excess=max(excess(zones, v.contact, *(w[known] for w in (nodes.x, f_p, q))), 0.0) / highest,
        opposing=min(state.least_slip, 0.0),
        abscissae=EPS + (rounding + P_ROUNDING * peak) / of_shear,
        condition=1.0,
        advancing=True,
        kind=state.kind,
        tol=max(tol, OF_SHEAR),
    )


def _change_of_gradient(state: State, nodes: Nodes, beta: float) -> tuple[float, float]:
    """The largest change of γ in the zone that it is kept in, and what rounding changes in it.

    Without a zone nothing is known, and doubles tell too few places of a narrow one. Where the
    earlier state has the same edges Q alone made the change, and that by P is measured as well.
    """
    (zone, before), origin = state.kept, state.values.origin
    lo, hi = (end - origin for end in zone)
    if not lo < hi:
        return math.inf, 0.0
    if hi - lo < WIDE * 2.0 * state.values.contact.r:
        return 0.0, 0.0
    at = nodes.looked_at.inside(lo, hi)
    if not at.x.size:
        at = nodes.at(lo + (hi - lo) * (np.arange(LOOKS) + 0.53) / LOOKS)
    changed, rounding = nodes.gradient(at, beta) - state.strain_kept, float(nodes.rounding(at)[1])
    if before is None:
        return float(np.abs(changed).max()), rounding
    earlier = Nodes(before.values)
    same = earlier.at(at.x + (origin - before.values.origin))
    missed = float(np.abs(changed - earlier.gradient(same, beta)).max())
    rounding += float(earlier.rounding(same)[1])
    one, other = before.values.contact, state.values.contact
    if np.abs(np.subtract(one[:2], other[:2])).max() <= SAME * other.r:
        others = _change_of_gradient(before, earlier, beta)
        return max(missed, others[0]), max(rounding, others[1])
    return missed, rounding


def full_stick_certificate(
    edges: Edges, found: JacobiDensity, scene: Scene, tol: float
) -> Certificate:
    """Residual of both equations between the nodes of a graded quadrature, and equilibrium."""
    (part,), contact = found.parts, edges.contact

    def rows(x: Array, rest: Array) -> Array:
        other, on_left = 2.0 * contact.r - rest, x < contact.m
        phi = part.value(np.where(on_left, other, rest), np.where(on_left, rest, other))
        return np.stack((phi.real, phi.imag))

    nodes = Nodes(InContact(contact, (contact.x1, contact.x2), rows, exact=True))
    at, (p, _), load = nodes.looked_at, nodes.rows, nodes.rows @ nodes.weight
    residual = nodes.principal_values(at) + scene.beta * np.stack((-at.rows[1], at.rows[0]))
    residual[0] -= 0.5 * scene.Estar * edges.tilt
    loads = np.array([edges.normal_load, scene.tangential_load])
    moment, size = float(nodes.weight @ (p * nodes.left)) + contact.x1 * load[0], np.hypot(*loads)
    highest = float(p[nodes.rest > REGULAR * contact.r].max())
    return Certificate(
        residual=float(np.hypot(*residual).max() / np.hypot(*at.rows).max()),
        implied=found.error,
        force=float(np.hypot(*(load - loads)) / size),
        moment=float(abs(moment - edges.moment) / (size * contact.r)),
        lowest_pressure=0.0,
        lowest_gap=0.0,
        abscissae=0.0,
        tol=tol,
        notes=notes(np.array([edges.tilt]), highest / scene.Estar),
    )


class Places:
    """Places x in contact, their distances from the left edge and from the right one, p and q."""

    def __init__(self, values: InContact, x: Array, left: Array, right: Array) -> None:
        self.values, self.x, self.left, self.right = values, x, left, right

    @property
    def rest(self) -> Array:
        """The distances from the nearer edge."""
        return np.minimum(self.left, self.right)

    @cached_property
    def rows(self) -> Array:
        """p and q, with 0 in place of infinities at a mark that rounding put a place on."""
        found = self.values.rows(self.x, self.rest)
        return np.where(np.isfinite(found), found, 0.0)

    def inside(self, lo: float, hi: float) -> Places:
        """Those between two places."""
        kept = (self.x > lo) & (self.x < hi)
        found = Places(self.values, self.x[kept], self.left[kept], self.right[kept])
        found.__dict__["rows"] = self.rows[:, kept]
        return found


class Nodes(Places):
    """The nodes and weights of a rule on the whole contact, in ascending order."""

    def __init__(self, values: InContact) -> None:
        contact = values.contact
        marks = np.array(values.marks)
        left, right = contact.from_left(marks), contact.from_right(marks)
        left[0] = right[-1] = 0.0
        apart = values.exact | (np.minimum(left, right) > SAME * contact.r)
        apart[1:] &= values.exact | (np.diff(marks) > SAME * contact.r)
        apart[[0, -1]] = True
        marks, left, right = marks[apart], left[apart], right[apart]
        self.marks = marks
        self.width = _steps(marks, left, right)
        # what a narrower neighbour changes has a scale of its own beside it
        size = np.log(np.concatenate(([np.inf], self.width, [np.inf]))) / math.log(RATIO**ROOT)
        deeper = size[1:-1] - np.stack((size[:-2], size[2:]))
        panels = np.ceil(np.maximum(deeper, 0.0)) + (INSIDE if len(marks) <= MANY else OF_MANY)
        panels[0, 0] = panels[1, -1] = AT_EDGE
        parts = []
        for k, width in enumerate(self.width.tolist()):
            (s, ds), (e, de) = (_towards_mark(int(n)) for n in panels[:, k])
            from_lo, from_hi = 0.5 * width * s, 0.5 * width * e[::-1]
            x = np.append(marks[k] + from_lo, marks[k + 1] - from_hi)
            from_left = left[k] + np.append(from_lo, width - from_hi)
            from_right = right[k + 1] + np.append(width - from_lo, from_hi)
            parts.append((x, from_left, from_right, 0.5 * width * np.append(ds, de[::-1])))
        x, left, right, self.weight = (np.concatenate(v) for v in zip(*parts, strict=True))
        if not values.exact:  # beside a sharp edge f dx is f times the root, both at the rounded x
            x = np.clip(x, *np.nextafter(contact[:2], contact.m))
            rounded = np.maximum(contact.from_left(x) * contact.from_right(x), 0.0)
            self.weight *= np.sqrt(rounded / (left * right))
        super().__init__(values, x, left, right)

    def at(self, x: Array) -> Places:
        """Places that are no nodes."""
        contact = self.values.contact
        return Places(self.values, x, contact.from_left(x), contact.from_right(x))

    @cached_property
    def regular(self) -> NDArray[np.bool_]:
        """Whether each node is away from sharp edges, where the tractions are infinite."""
        p, apart = self.rows[0], BESIDE * self.values.contact.r
        most = p[self.rest > apart].max()
        left, right = (apart * (p[end] > most) for end in (0, -1))
        return np.asarray((self.left >= left) & (self.right >= right))

    @cached_property
    def looked_at(self) -> Places:
        """Places between the marks at which the equations are measured."""
        wide = self.values.exact | (self.width > WIDE * 2.0 * self.values.contact.r)
        looks = max(LOOKS, ALONE // len(self.width))
        part = (np.arange(looks) + 0.53) / looks
        x = (self.marks[:-1, None] + self.width[:, None] * part)[wide].ravel()
        first, last = self.x[self.regular][[0, -1]]
        x = x[(x > first) & (x < last)][:: max(1, -(-len(x) // MOST))]
        after = np.searchsorted(self.x, x)  # rounding is least halfway between two nodes
        return self.at(0.5 * (self.x[after - 1] + self.x[after]))

    def _apart(self, at: Places) -> Array:
        """x - t of places and nodes (places, nodes), by what tells the node best."""
        x, left, right = (v[:, None] for v in (at.x, at.left, at.right))
        apart = np.where(self.right < self.left, self.right - right, left - self.left)
        apart = np.where(np.abs(self.x) < self.rest, x - self.x, apart)
        apart[apart == 0.0] = np.inf
        return apart

    def principal_values(self, at: Places) -> Array:
        """1/π PV∫f/(x - t) dt of f = p and q, (2, places)."""
        kernel = self.weight / self._apart(at)
        whole = np.log(at.left / at.right) - kernel.sum(axis=1)
        found: Array = (self.rows @ kernel.T + at.rows * whole) / math.pi
        return found

    def gradient(self, at: Places, beta: float) -> Array:
        """γ, E*/2 times the gradient of the slip."""
        found: Array = self.principal_values(at)[1] + beta * at.rows[0]
        return found

    def rounding(self, at: Places) -> Array:
        """What the rounding of places does to these integrals: a bound, the sum over the nodes.

        What it changes of f is taken from the change of f from node to node.
        """
        if not at.x.size:
            return np.zeros(2)
        exact = EPS * np.minimum(np.abs(self.x), self.rest) + LEAST
        by_x = np.spacing(np.maximum(np.abs(self.x), abs(self.values.origin)))
        ulp = exact if self.values.exact else by_x
        step = _steps(self.x, self.left, self.right)
        change = np.zeros(self.rows.shape)
        change[:, 1:] = np.abs(np.diff(self.rows)) * (ulp[1:] / np.maximum(step, ulp[1:]))
        apart = np.maximum(np.abs(self._apart(at)), ulp)
        moved = [(self.weight * f / apart).sum(axis=1).max() for f in change]
        return np.array(moved) / math.pi


def _steps(x: Array, left: Array, right: Array) -> Array:
    """The distances between neighbours, by what tells the second best."""
    steps = np.where(right[1:] < left[1:], -np.diff(right), np.diff(left))
    return np.where(np.abs(x[1:]) < np.minimum(left, right)[1:], np.diff(x), steps)


def _towards_mark(panels: int) -> tuple[Array, Array]:
    """Distances from a mark, as parts of the way to the middle, and weights."""
    g, _, w = gauss_jacobi(NODES, 0.0, 0.0)
    ends = np.append(0.0, RATIO ** -np.arange(float(panels), -0.5, -1.0))
    length = np.diff(ends)[:, None]
    t, dt = (ends[:-1, None] + length * g).ravel(), (length * w).ravel()
    return t**ROOT, ROOT * t ** (ROOT - 1.0) * dt
