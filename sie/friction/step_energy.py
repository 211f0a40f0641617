"""The energy that friction dissipates in a part of a step: ∫ dt ∫ f p |dg/dt| dx.

Each place slips in one direction, so that by parts, with Δg since the start of the part,

    W = ∫ f p₁ s Δg₁ dx - ∫ dt ∫ f dp/dt s Δg dx,

s the direction of slip. It does not matter from when on Δg counts at a place that comes into
contact: p = 0 there, and where a place leaves. The second integral is 0 under constant
pressure. Its integrand is continuous in time even where zones leap, as they do where the loads come
back to what they were. On a strip part the zones are known at its moments, where Clenshaw and
Curtis integrate 2 T τ dτ. In a finite part each moment is a finite step from the start of it. Time
is cut where an end passes a mark of the shear, and on each piece t = t_a + (t_b - t_a) sin²(πv/2).

A slip zone at an edge that retreats may vanish and begin anew in the other direction. Its length d
is then like (t - t*)², and s sqrt(d) a smooth function of time which changes its sign at t*: by it
zones are continued from known moments to others, and the time is cut at t*.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.graded_panels import OF_SERIES, Rule
from sie.numerics.root_finding import false_position

from .cells import zones_on_cells
from .equations import Equations, Zones
from .finite_step import newton
from .gained_slip import GainedSlip
from .loading import LoadStep
from .onset import onset
from .rates import Rates
from .state import SAME, Contact, Ends, Slips, State, intervals
from .strip_part import StripPart
from .strips import TAU

if TYPE_CHECKING:
    from .course import Part

Array = NDArray[np.float64]

INTERVALS = 16  # of the rule of Clenshaw and Curtis on a piece of time
LOOKED = np.array([1e-4, 0.01, 0.05, 0.15, 0.3, 0.5, 0.7, 0.9])  # shares where marks are passed
GOES_ON = -1e-5  # of the largest K, and of the largest rate of slip
CUT = 3e-5  # of a part: so well a time is known at which the integrand has a kink
APART = 1e-4  # of a part: cuts that are closer are one
CLOSE = 1e-2  # of a part: between times so close to each other values may be interpolated
ACCURATE = 1e-8  # of the energy: pieces of time are halved until it is known to so much
REFUSED = 1e-7  # of the energy: it is refused if it is known to less
PLACES = 200  # of each patch, at which slip is looked at for turns ...
BETWEEN = np.array([0.25, 0.5, 0.75])  # ... after these parts of a step at constant pressure
NEARER = 0.6  # times the distance of a share that was not solved: the next that is tried
MOST_PIECES, MOST_MISSED = 40, 60


def work(part: Part | StripPart, step: LoadStep) -> float:
    """The energy of a part. Raises ContactError where it is not known to `REFUSED`."""
    if not part.state.slip:
        return 0.0
    sticking = [_sticking(state) for state in (part.before, part.state)]
    if not step.constant and sticking[0] != sticking[1]:
        raise ContactError(
            "a patch begins to slide as a whole, or sticks again, while P or the tilt changes: the "
            "energy lost is not covered; ask for the state alone, or change Q at constant P"
        )
    contact = part.state.contact
    whole, error = _paired(contact, part.equations, contact.limit.on), 0.0
    if not step.constant:
        if isinstance(part, StripPart):
            moved, error = _of_panel(part, step, whole)
        else:
            moved, error = _of_finite_part(part, step, whole)
        whole -= moved
    elif not isinstance(part, StripPart):
        error = _turned(part, step)
    if error > REFUSED * whole:
        raise ContactError(
            f"the energy lost is known to {error / whole:.0e} of it only, as where slip turns on "
            "the way: put a point of the path in between; the state is not concerned"
        )
    return whole * 2.0 / step.contacts.scene.Estar


def _turned(part: Part, step: LoadStep) -> float:
    """∫ f p (what places slip to and fro - |Δg|) dx of a finite step at constant pressure."""
    way, contact = Way.back(part, step), part.state.contact
    x = np.concatenate([np.linspace(lo, hi, PLACES + 2)[1:-1] for lo, hi in contact.patches])
    try:
        shares = part.begun + (part.until - part.begun) * BETWEEN
        on_the_way = [way.equations(float(share)) for share in shares[::-1]]
    except ContactError:
        return np.inf
    slips = [GainedSlip(now).at(x) for now in (part.equations, *on_the_way)]
    to_and_fro = np.abs(np.diff([*slips, 0.0 * x], axis=0)).sum(axis=0)
    more = contact.limit(x) * (to_and_fro - np.abs(slips[0]))
    return float(more.mean() * sum(hi - lo for lo, hi in contact.patches))


def _paired(contact: Contact, now: Equations, density: Callable[[Rule], Array]) -> float:
    """∫ d s Δg dx of a density d, s the direction of slip."""
    total = 0.0
    for lo, hi, sense, pieces in GainedSlip(now).slipped:
        marks = np.unique(np.concatenate((pieces.marks, contact.limit.marks)))
        rule = Rule.graded(intervals([(lo, hi)], marks, SAME * contact.width), OF_SERIES)
        total += sense * float(rule.weight @ (density(rule) * pieces.on(rule)))
    return total


def _sticking(state: State) -> list[bool]:
    """For each patch whether some of it sticks."""
    return [any(x1 <= a and b <= x2 for a, b in state.stick) for x1, x2 in state.contact.patches]


def _by_pressure(now: Equations, rates: Rates) -> float:
    """∫ f dp/dt s Δg dx."""
    return rates.friction * _paired(now.after, now, rates.pressure.density)


@lru_cache(maxsize=2)
def _clenshaw_curtis(n: int) -> tuple[Array, Array, Array]:
    """Nodes from 0 to 1, weights of ∫, and the matrix of Chebyshev coefficients."""
    nodes = 0.5 * (1.0 - np.cos(np.pi * np.arange(n + 1) / n))
    k = np.arange(n + 1)
    of_polynomials = np.where(k % 2, 0.0, 1.0 / (1.0 - np.where(k % 2, 0.0, k) ** 2))
    transform = np.asarray(np.linalg.inv(chebvander(2.0 * nodes - 1.0, n)), dtype=np.float64)
    return nodes, np.asarray(of_polynomials @ transform), transform


def _integral(values: Array) -> tuple[float, float]:
    """The integral from 0 to 1 of values at the nodes, and its error by the last coefficients.

    A term T_n adds 1/n² to the integral, about.
    """
    n = len(values) - 1
    _, weights, transform = _clenshaw_curtis(n)
    tail = np.abs(transform[-3:] @ values).max()
    return float(weights @ values), float(tail) / n**2


def _of_panel(part: StripPart, step: LoadStep, whole: float) -> tuple[float, float]:
    """∫ dt ∫ f dp/dt s Δg dx of a part on which something comes to stick, and its error."""
    panel = part.panel
    values = [_by_pressure(*one) for one in zip(panel.equations, panel.rates, strict=True)]
    return _integral(np.append(0.0, 2.0 * panel.span.length * TAU[1:] * np.array(values)))


def _of_finite_part(part: Part, step: LoadStep, whole: float) -> tuple[float, float]:
    """The same of a finite step between two shares of a step of loads."""
    begun, until = part.begun, part.until
    way = Way.back(part, step)
    cuts = [begun]
    for cut in sorted(_cuts(way, [until, *(begun + (until - begun) * LOOKED[::-1]).tolist()])):
        if cut - cuts[-1] > APART * (until - begun) < until - cut:
            cuts.append(cut)
    way.allowed = ACCURATE * whole / (until - begun)
    pieces = [(*span, *way.integral(*span)) for span in pairwise([*cuts, until])]
    while len(pieces) < MOST_PIECES:
        worst = max(pieces, key=lambda piece: piece[3])
        if worst[3] <= ACCURATE * (whole - sum(piece[2] for piece in pieces)):
            break
        pieces.remove(worst)
        a, b = worst[:2]
        halves = (a, 0.5 * (a + b)), (0.5 * (a + b), b)
        pieces += [(*half, *way.integral(*half)) for half in halves]
    return sum(piece[2] for piece in pieces), sum(piece[3] for piece in pieces)


@dataclass(eq=False)
class Way:
    """The zones on the way through a finite step; `known` holds those found, by their share."""

    before: State
    step: LoadStep
    span: tuple[float, float]
    known: dict[float, Equations]
    retreating: NDArray[np.int_]  # which edges retreat
    start: Array  # the coordinates at the start; none if the number of zones changes
    values: dict[float, float] = field(default_factory=dict)
    allowed: float = 0.0  # error of a value
    missed: int = 0  # how often no zones were found
    # a share at which no zones were found, by the known ones that it lies between
    failed: dict[tuple[float, float], float] = field(default_factory=dict)

    @classmethod
    def back(cls, part: Part, step: LoadStep) -> Way:
        """Through a part, from its end on."""
        zones = onset(part.before, step.rates, step.friction)
        start = zones.stick if len(zones.stick) == len(part.state.stick) else ()
        old, new = part.before.contact.patches, part.state.contact.patches
        inward = (
            np.array([[1.0, -1.0]]) * (np.array(new) - np.array(old))
            if len(old) == len(new)
            else ()
        )
        retreating = np.flatnonzero(np.ravel(inward) > 0.0)
        coordinates = smooth_coordinates(start, zones.slip, np.ravel(old)[retreating])
        known = {part.until: part.equations}
        return cls(part.before, step, (part.begun, part.until), known, retreating, coordinates)

    def coordinates(self, now: Equations) -> Array:
        """The smooth coordinates of zones on the way."""
        edges = np.ravel(now.after.patches)[self.retreating]
        return smooth_coordinates(now.zones.stick, now.slip, edges)

    def integral(self, a: float, b: float) -> tuple[float, float]:
        """∫ dt ∫ f dp/dt s Δg dx between two shares, and its error."""
        v = _clenshaw_curtis(INTERVALS)[0][1:-1]
        turn, pace = np.sin(0.5 * np.pi * v) ** 2, 0.5 * np.pi * np.sin(np.pi * v)
        values, doubt = np.zeros(INTERVALS + 1), 0.0
        for i in range(INTERVALS - 2, -1, -1):
            value, error = self.value(a + (b - a) * float(turn[i]))
            values[i + 1] = (b - a) * pace[i] * value
            doubt += (b - a) * pace[i] * error / INTERVALS
        whole, error = _integral(values)
        return whole, error + doubt

    def value(self, share: float) -> tuple[float, float]:
        """∫ f dp/dt s Δg dx at a share; between known ones where no zones are found, and its error.

        They are not found next to where they leap, and the integrand is continuous there.
        """
        if share not in self.known:
            between, doubt, (a, b) = self._between(share)
            known = b - a < CLOSE * (self.span[1] - self.span[0]) and doubt <= self.allowed
            failed = self.failed.get((a, b))
            if known or (
                failed and min((share - a) / (failed - a), (b - share) / (b - failed)) > NEARER
            ):
                return between, doubt
            try:
                self.equations(share)
            except ContactError:
                self.missed += 1
                if self.missed > MOST_MISSED:
                    raise
                self.failed[a, b] = share
                return between, doubt
        if share not in self.values:
            now = self.known[share]
            self.values[share] = _by_pressure(now, rates_of(now, self.step))
        return self.values[share], 0.0

    def _between(self, share: float) -> tuple[float, float, tuple[float, float]]:
        """The value between those at the nearest known shares, its error, and these shares."""
        a = max((k for k in self.known if k < share), default=self.span[0])
        b = min(k for k in self.known if k > share)
        first = self.value(a)[0] if a in self.known else 0.0  # before any slip
        last = self.value(b)[0]
        found = first + (last - first) * (share - a) / (b - a)
        return found, abs(last - first), (a, b)

    def equations(self, share: float) -> Equations:
        """The equations at a share, whose zones go on as they have to."""
        if share not in self.known:
            after = self.step.at(share)
            found = (self._passed(after, guess) for guess in self._guesses(share))
            one = next((now for now in found if now is not None), None)
            if one is None:
                raise ContactError(
                    f"the energy lost is not known: no zones of slip are found at {share:.6g} of "
                    "the step; the state at its end is not concerned"
                )
            self.known[share] = one
        return self.known[share]

    def _passed(self, after: Contact, guess: Zones) -> Equations | None:
        """The equations from a guess, if they are solved and nothing in it sticks or turns."""
        try:
            found = newton(self.before, after, guess)
            rates = rates_of(found, self.step)
        except ContactError:
            return None
        margins = rates.signed_K[np.isfinite(rates.signed_K)]
        stops = margins.min(initial=0.0) < GOES_ON * np.abs(rates.K).max()
        return None if stops or rates.turning < GOES_ON else found

    def _guesses(self, share: float) -> Iterator[Zones]:
        """By a line or a parabola through known zones, the nearest ones, else by cells."""
        nearest = sorted(self.known, key=lambda other: abs(other - share))
        count = len(self.known[nearest[0]].zones.stick)
        alike = [k for k in nearest if len(self.known[k].zones.stick) == count]
        if self.start.size == 2 * count:
            alike = sorted([*alike, self.span[0]], key=lambda other: abs(other - share))
        for several in (3, 2, 1):
            if len(alike) >= several and any(k in self.known for k in alike[:several]):
                zones = self._continued(alike[:several], share)
                if zones is not None:
                    yield zones
        beyond = [k for k in nearest if (k < share) != (nearest[0] < share)]
        yield from (self.known[k].zones for k in beyond[:1])
        try:
            yield from zones_on_cells(self.before, self.step.at(share))
        except ContactError:
            return

    def _continued(self, shares: list[float], share: float) -> Zones | None:
        """The zones by a polynomial through those at some shares."""
        known = [self.coordinates(self.known[k]) if k in self.known else self.start for k in shares]
        found = np.zeros(len(known[0]))
        for k, value in zip(shares, known, strict=True):
            others = [other for other in shares if other != k]
            found += value * np.prod([(share - other) / (k - other) for other in others])
        like = next(self.known[k] for k in shares if k in self.known)
        return _zones_at(found, like, self.step.at(share), self.retreating)


def rates_of(now: Equations, step: LoadStep) -> Rates:
    """The rates of solved equations at the rates of loads of a step."""
    return Rates.solved(
        now.after.patches,
        now.zones.stick,
        now.slip,
        step.rates,
        friction=step.friction,
        period=now.after.period,
    )


def smooth_coordinates(stick: Ends, slip: Slips, edges: Array) -> Array:
    """S sqrt(d) for ends beside a slip zone of length d at one of these edges, places of others."""
    left, right = ({zone[k]: zone for zone in slip} for k in (0, 1))
    ends = np.array(stick).ravel()
    found = ends.copy()
    for j, e in enumerate(ends):
        lo, hi, s = (left if j % 2 else right).get(e, (e, e, 0.0))
        if (hi if j % 2 else lo) in edges:
            found[j] = s * np.sqrt(hi - lo)
    return found


def _zones_at(
    coordinates: Array, like: Equations, contact: Contact, retreating: NDArray[np.int_]
) -> Zones | None:
    """The zones of coordinates, beside the same patches; None where they are none."""
    ends, signs, patches = coordinates.copy(), list(like.zones.signs), like.after.patches
    for j, e in enumerate(like.stick.ravel()):
        zones = [k for k, zone in enumerate(like.slip) if zone[j % 2 == 0] == e]
        outer = like.slip[zones[0]][j % 2]
        for k in retreating:
            if outer == np.ravel(patches)[k]:
                inward = -1.0 if j % 2 else 1.0
                ends[j] = np.ravel(contact.patches)[k] + inward * coordinates[j] ** 2
                signs[zones[0]] = 1.0 if coordinates[j] > 0.0 else -1.0
    edges = np.array(contact.patches)
    inside = ((edges[:, :1] < ends) & (ends < edges[:, 1:])).any(axis=0).all()
    if not inside or not (np.diff(ends) > 0.0).all():
        return None
    return Zones(tuple((float(a), float(b)) for a, b in ends.reshape(-1, 2)), tuple(signs))


def _cuts(way: Way, shares: list[float]) -> list[float]:
    """The shares at which ends pass marks, or slip at an edge turns; `shares` falls."""
    found = []
    near = 1e-9 * way.before.contact.width
    for share in shares:
        with suppress(ContactError):
            way.equations(share)
    shares = [share for share in shares if share in way.known]
    for later, sooner in pairwise(shares):
        first, last = way.known[sooner], way.known[later]
        if len(first.zones.stick) != len(last.zones.stick):
            continue
        ends = way.coordinates(first), way.coordinates(last)
        for j, (a, b) in enumerate(zip(_places(first), _places(last), strict=True)):
            if (
                j < len(ends[0])
                and first.zones.signs != last.zones.signs
                and ends[0][j] * ends[1][j] < 0.0
            ):
                found.append(_root(_Coordinate(way, j), way, sooner, later))
            inside = (way.before.marks - a) * (b - way.before.marks) > near**2
            for mark in way.before.marks[inside]:
                found.append(_root(_Beyond(j, float(mark)), way, sooner, later))
    return found


@dataclass(frozen=True)
class _Coordinate:
    """Coordinate j of the zones."""

    way: Way
    j: int

    def __call__(self, now: Equations) -> float:
        return float(self.way.coordinates(now)[self.j])


@dataclass(frozen=True)
class _Beyond:
    """How far end j is beyond a mark."""

    j: int
    mark: float

    def __call__(self, now: Equations) -> float:
        return float(_places(now)[self.j] - self.mark)


def _places(now: Equations) -> Array:
    """The ends of stick zones, and the edges."""
    return np.append(now.stick, now.after.patches)


def _root(value: Callable[[Equations], float], way: Way, sooner: float, later: float) -> float:
    """The share at which a value of the zones changes its sign.

    A slip zone that is too short for Newton's method is as good as vanished.
    """
    for share in sorted(way.known):
        if sooner < share < later:
            same = (value(way.known[share]) < 0.0) == (value(way.known[sooner]) < 0.0)
            sooner, later = (share, later) if same else (sooner, share)
    ends = value(way.equations(sooner)), value(way.equations(later))
    close = CUT * (way.span[1] - way.span[0])

    def here(share: float) -> float:
        try:
            return value(way.equations(share))
        except ContactError:
            return 0.0

    def settled(lo: float, hi: float, at: float) -> bool:
        return hi - lo < close or abs(at) < CUT * abs(ends[1] - ends[0])

    return false_position(here, sooner, later, ends, settled)
