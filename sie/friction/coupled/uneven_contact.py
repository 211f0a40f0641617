"""The contact of dissimilar bodies under a profile that is not symmetric, pressed with friction.

Zones, tractions, slip, gap and dissipated energy follow from P' and the middle of the contact, as
functions of its half-width (`uneven_growth`). β < 0 only turns the sign of the shear and the slip.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.contact.known_contact import Edges, Normal
from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import Interval
from sie.numerics.root_finding import false_position
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.traction.base import on_line, zero_or_nan
from sie.traction.in_contact import InContact

from .contact import LIGHTER, PARTS, CoupledContact
from .flat import double_exponential
from .functions import FlatFunctions, flat_functions
from .integral import outwards
from .two_sided import Known, TwoSidedTraction, both_tractions
from .uneven_growth import History, UnevenPanel
from .uneven_march import NEGLECT, March, first_touch, refuse_turning
from .uneven_sums import UnevenSums

Array = NDArray[np.float64]

APART = 1e-13  # of the half-width: marks that are nearer are one
# Places of s between two kinks at which the power of friction is summed, and the root of the
# distance from a kink in which it is smooth
ENERGY_NODES, FOLD = 14, 3.0
FEW, MANY_NODES = 4, 32  # kinks; and places where there are more
WIDER = 1.1  # where a load asks for more than the frictionless half-width
NEARLY, BISECTIONS = 1e-14, 60  # of the load; and steps to it


@dataclass(frozen=True, eq=False)
class UnevenContact:
    """The state under the load P.

    flat            functions of the flat punch; |β| and f
    panels          P' and the middle, up to the present half-width
    first           the flat base, or the place, that touched first
    kinks           half-widths at which an edge passed a place where the profile is not smooth
    load            P
    sign            of β
    half_modulus    E*/2
    """

    flat: FlatFunctions
    panels: tuple[UnevenPanel, ...]
    first: tuple[float, float]
    kinks: tuple[float, ...]
    load: float
    sign: float
    half_modulus: float

    @cached_property
    def sums(self) -> UnevenSums:
        return UnevenSums(self.flat, self.panels, self.first)

    @property
    def b(self) -> float:
        """Half the width of the contact."""
        return self.panels[-1].hi

    @property
    def middle(self) -> float:
        last = self.panels[-1]
        return last.middle + last.whole_shift

    @property
    def friction(self) -> float:
        return self.flat.friction

    @cached_property
    def contact(self) -> Interval:
        return Interval(*self._edges_at(self.b))

    def _edges_at(self, s: float, part: float = 1.0) -> tuple[float, float]:
        """m(s) ∓ part s."""
        k = int(np.searchsorted([panel.hi for panel in self.panels], s))
        panel = self.panels[min(k, len(self.panels) - 1)]
        by = np.array([s - panel.lo])
        m = panel.middle + float(panel.moved(np.zeros(1), by)[0])
        return m - part * s, m + part * s

    @property
    def full_stick(self) -> bool:
        """Whether the slip zones are narrower than a part FULL_STICK of the contact."""
        return self.flat.punch.bonded

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        return (self._edges_at(self.b, 1.0 if self.full_stick else self.flat.c),)

    @property
    def slip_width(self) -> float:
        """The width of each zone of slip, to full relative accuracy."""
        return 0.0 if self.full_stick else self.flat.rest * self.b

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        if self.full_stick:
            return ()
        ((lo, hi),) = self.stick
        return (self.contact.x1, lo, -self.sign), (hi, self.contact.x2, self.sign)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places in the contact where p or q is not smooth, with its edges, ascending."""
        lo, hi = self.contact[:2]
        places = {*self.first, self.panels[0].middle}
        for s in (self.panels[0].lo, *self.kinks, self.b):
            places |= {*self._edges_at(s), *self._edges_at(s, self.flat.c)}
        apart = APART * self.b
        kept = [lo]
        for x in sorted(places):
            if x - kept[-1] > apart and hi - x > apart:
                kept.append(x)
        return (*kept, hi)

    # -- tractions ---------------------------------------------------------------------------------

    def pressure(self, x: Array) -> Array:
        """p in contact."""
        return self.sums.pressure(x, np.full(len(x), self.b))

    def shear(self, x: Array) -> Array:
        """q in contact; at a corner of the profile, where both are infinite, 0."""
        q: Array = self.pressure_and_shear(x)[1]
        return q

    def pressure_and_shear(self, x: Array) -> Array:
        """Rows of p and q."""
        p, deficit = self.sums.pressure_and_deficit(x, np.full(len(x), self.b))
        q, finite = np.zeros(len(x)), np.isfinite(p)
        q[finite] = self.friction * p[finite] - deficit[finite]
        return np.stack((p, self.sign * self.sums.sides(x) * q))

    @property
    def values(self) -> InContact:
        return InContact(self.contact, self.marks, lambda x, _: self.pressure_and_shear(x))

    kind = CoupledContact.kind

    @cached_property
    def tractions(self) -> tuple[TwoSidedTraction, TwoSidedTraction]:
        """p and q with their potentials, which share their panels."""
        power, ((lo, hi),) = 1.0 - self.flat.h, self.stick
        known = Known(0.5 * (lo + hi), self.marks, (power, power), (self.load, 0.0), self.moment)
        return both_tractions((self.pressure, self.shear), self.pressure_and_shear, known)

    @cached_property
    def moment(self) -> float:
        """∫p x dx."""
        total = 0.0
        for panel in self.panels:
            ahead, mass = panel.places
            total += float(mass @ (panel.middle + panel.moved(np.zeros(1), ahead)))
        return total

    # -- slip --------------------------------------------------------------------------------------

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x since it came into contact, same shape: 0 outside the contact."""

        def value(flat: Array) -> Array:
            g = np.zeros(flat.shape)
            inside = (flat >= self.contact.x1) & (flat <= self.contact.x2)
            x = flat[inside]
            slip = self.sums.slip(x, np.full(len(x), self.b))
            g[inside] = self.sign * self.sums.sides(x) * slip / self.half_modulus
            return g

        return on_line(value, x)

    shift = strain_kept = 0.0

    @cached_property
    def least_slip(self) -> float:
        """The least slip outwards in a slip zone, over the largest."""
        if self.full_stick:
            return 0.0
        x = np.concatenate([lo + (hi - lo) * PARTS for lo, hi, _ in self.slip_zones])
        slip = self.sums.slip(x, np.full(len(x), self.b))
        return min(0.0, float(slip.min() / np.abs(slip).max()))

    @property
    def kept(self) -> tuple[tuple[float, float], UnevenContact]:
        """What stuck under a lighter load, and the state under that."""
        base = self.panels[0].lo
        before = self.at_half_width(base + LIGHTER * (self.b - base))
        return before.stick[0], before

    def at_half_width(self, s: float) -> UnevenContact:
        """The state when the contact was so wide."""
        panels = truncated(self.panels, s)
        load = sum(panel.load(math.inf) for panel in panels)
        kinks = tuple(k for k in self.kinks if k < s)
        return replace(self, panels=panels, load=load, kinks=kinks)

    @cached_property
    def energy(self) -> float:
        """The dissipated energy: ∫ f p |dg| over both slip zones, while P grew.

        The kinks of traces are many and faint: they only cost.
        """
        if len(self.kinks) > FEW:
            return replace(self, kinks=())._energy(MANY_NODES)
        return self._energy(ENERGY_NODES)

    def _energy(self, nodes: int) -> float:
        total, base = 0.0, self.panels[0].lo
        for lo, hi in itertools.pairwise(sorted({base, *self.kinks, *self._passings, self.b})):
            # A broken power of the distance from a kink is smooth in the root of its FOLD
            power = self.panels[0].power if lo == base else 0.0
            x, _, w = with_weight(nodes, 0.0, FOLD * (power + 1.0) - 1.0)
            ahead, part = (hi - lo) * x**FOLD, FOLD * (hi - lo) * w * x ** (FOLD - 1.0)
            s, loads = lo + ahead, np.empty(len(x))
            for panel in self.panels:
                own = (s > panel.lo) & (s <= panel.hi)
                loads[own] = panel(s[own] - panel.lo)
            total += float((part * loads) @ self._rate(s))
        return total / self.half_modulus

    @property
    def _passings(self) -> tuple[float, ...]:
        """The half-widths at which an end of the stick zone passes where an edge met a kink."""
        found = []
        for s, k in itertools.product((self.panels[0].lo, *self.kinks), (0, 1)):
            place, side = self._edges_at(s)[k], 2 * k - 1

            def ahead(width: float, place: float = place, k: int = k, side: int = side) -> float:
                return side * (self._edges_at(width, self.flat.c)[k] - place)

            if s > 0.0 and ahead(self.b) > 0.0:
                ends = ahead(s), ahead(self.b)
                root = false_position(ahead, s, self.b, ends, lambda a, b, missed: False)
                found.append(root)
        return tuple(found)

    def _rate(self, s: Array) -> Array:
        """∫ f p ĝ dx over the slip zones of contacts of the half-widths s."""
        flat, (part, rest, dx) = self.flat, double_exponential()
        total = np.zeros(len(s))
        for k, side in itertools.product(range(len(s)), (1.0, -1.0)):
            edge = self._edges_at(s[k])[int(side > 0.0)]
            # In parts of s, the distances from the edge at which p is not smooth
            inside = [side * (edge - mark) / s[k] for mark in self.marks]
            cuts = np.array([0.0, *sorted(e for e in inside if 0.0 < e < flat.rest), flat.rest])
            lo, length = cuts[:-1, None], np.diff(cuts)[:, None]
            e = (lo + length * part).ravel()
            from_c = ((flat.rest - cuts[1:, None]) + length * rest).ravel()
            p = self.sums.pressure(edge - side * s[k] * e, np.full(len(e), s[k]))
            g = flat.slip(1.0 - e, e, from_c)
            total[k] += self.friction * s[k] * float((length * dx).ravel() @ (p * g))
        return total

    # -- beside the contact ------------------------------------------------------------------------

    def hilbert_outside(self, rise: Array, side: float) -> Array:
        """|1/π ∫p/(x - t) dt| at a distance from the right (side 1) or left edge."""
        history = History(self.flat)
        history.panels = list(self.panels)
        return history.slope(side, 0.5 * rise, rise)[0]

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        lo, hi = profile.domain
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        known = np.isfinite(flat) & (out == 0.0)
        for edge, side in ((self.contact.x1, -1.0), (self.contact.x2, 1.0)):
            beside = known & (side * (flat - edge) > 0.0)
            if beside.any():
                rise = profile.height(flat[beside]) - profile.height(np.array(edge))
                H = partial(self.hilbert_outside, side=side)
                raised = outwards(H, np.abs(flat[beside] - edge), self.b)
                out[beside] = rise - raised / self.half_modulus
        return out.reshape(np.shape(x))


def truncated(panels: tuple[UnevenPanel, ...], s: float) -> tuple[UnevenPanel, ...]:
    """The panels up to a half-width."""
    kept = [panel for panel in panels if panel.hi <= s]
    if len(kept) < len(panels) and panels[len(kept)].lo < s:
        panel = panels[len(kept)]
        ahead = 0.5 * (s - panel.lo) * (1.0 + chebyshev.points(len(panel.rates)))
        y = panel.variable(ahead)
        series, rates = (
            chebyshev.transform(chebyshev.evaluate(c, y)) for c in (panel.series, panel.rates)
        )
        kept.append(replace(panel, hi=s, series=series, rates=rates))
    return tuple(kept)


def uneven_contact(scene: Scene, bound: Normal) -> tuple[Edges, UnevenContact]:
    """The edges and the state; ContactError where none is known.

    `bound` is the contact without friction; the scene has no tilt but that of its profile.
    """
    flat = flat_functions(abs(scene.beta), scene.friction)
    half_modulus, contact = 0.5 * scene.Estar, bound.edges.contact
    slope = bound.slope(scene.profile)
    march = March(flat, slope, half_modulus, first_touch(slope, *contact[:2]))
    s = _marched(march, scene.normal_load, contact.r)
    state = UnevenContact(
        flat,
        truncated(tuple(march.history.panels), s),
        (march.touch.lo, march.touch.hi),
        tuple(k for k in march.kinks if k < s),
        march.load if scene.normal_load is None else scene.normal_load,
        math.copysign(1.0, scene.beta),
        half_modulus,
    )
    P = state.load
    return Edges(state.contact, P, state.moment, 0.0, (False, False), 0.0, 0.0, 0.0, 0), state


def _marched(march: March, P: float | None, goal: float) -> float:
    """The half-width under the load, or as far as the goal without one."""
    while True:
        before = march.load
        panel = march.advance(goal)
        end = panel.length
        if P is not None and march.load >= P:
            end = _at_load(panel, P - before)
        refuse_turning(panel, end, before, march.flat)
        if panel.hi >= goal if P is None else march.load >= P:
            return panel.lo + end
        if march.stopped is not None:
            raise ContactError(_at_corner(march))
        if panel.hi >= goal:
            goal *= WIDER


def _at_load(panel: UnevenPanel, missing: float) -> float:
    """How far along the panel it carries that load."""
    lo, hi = 0.0, panel.length
    d = hi * missing / panel.load(hi)
    for _ in range(BISECTIONS):
        missed = panel.load(d) - missing
        lo, hi = (lo, d) if missed > 0.0 else (d, hi)
        if abs(missed) <= NEARLY * missing:
            break
        d -= missed / float(panel(np.array([d]))[0])
        if not lo < d < hi:
            d = 0.5 * (lo + hi)
    return d


def _at_corner(march: March) -> str:
    """Why there is no answer beyond a corner that an edge has reached."""
    edge = march.stopped
    assert edge is not None
    return (
        f"under P = {march.load:.6g} the contact reaches a corner of the indenter at x = "
        f"{edge.place:.6g}: there one of its edges stays while the other one moves, and how the "
        "stick zone between dissimilar bodies moves then is not solved; lower the load, round the "
        f"corner, {NEGLECT}"
    )
