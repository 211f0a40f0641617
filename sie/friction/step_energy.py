"""The energy that friction dissipates in a part of a step: ∫ dt ∫ f p |dg/dt| dx.

Each place slips in one direction, so that by parts, with Δg since the start of the part,

    W = ∫ f p₁ s Δg₁ dx - ∫ dt ∫ f dp/dt s Δg dx,

s the direction of slip. It does not matter from when on Δg counts at a place that comes into
contact: p = 0 there, and where a place leaves. The second integral is 0 under constant
pressure. Its integrand is continuous in time even where zones leap, as they do where the loads come
back to what they were. On a strip part the zones are known at its moments, where Clenshaw and
Curtis integrate 2 T τ dτ. In a finite part each moment is a finite step from the start of it. Time
is cut where an end passes a mark of the shear, and on each piece t = t_a + (t_b - t_a) sin²(πv/2).

Where a slip zone at an edge vanishes and begins anew in the other direction (`zones_between`), the
time is cut too.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.clenshaw_curtis import clenshaw_curtis
from sie.numerics.root_finding import false_position

from .equations import Equations, slip_work
from .finite_step import Part, balanced
from .loading import TAU, LoadStep
from .potentials import RelativeSlip
from .rates import Rates
from .state import State, Zones
from .strips import Panel
from .zones_between import ZonesBetween

Array = NDArray[np.float64]

INTERVALS = 16  # of the rule of Clenshaw and Curtis on a piece of time
STUCK = 1e-11  # of the loads: by so much equations may be missed where all sticks
LOOKED = np.array([1e-4, 0.01, 0.05, 0.15, 0.3, 0.5, 0.7, 0.9])  # shares where marks are passed
CUT = 3e-5  # of a part: so well a time is known at which the integrand has a kink
APART = 1e-4  # of a part: cuts that are closer are one
CLOSE = 1e-2  # of a part: between times so close to each other values may be interpolated
ACCURATE = 1e-8  # of the energy: pieces of time are halved until it is known to so much
REFUSED = 1e-7  # of the energy: it is refused if it is known to less
PLACES = 200  # of each patch, at which slip is looked at for turns ...
BETWEEN = np.array([0.25, 0.5, 0.75])  # ... after these parts of a step at constant pressure
NEARER = 0.6  # times the distance of a share that was not solved: the next that is tried
MOST_PIECES, MOST_MISSED = 40, 60


def work(part: Part, step: LoadStep) -> float:
    """The energy of a part. Raises ContactError where it is not known to `REFUSED`."""
    if not part.state.slip and (step.constant or not _leaves(part, step)):
        return 0.0
    sticking = [_sticking(state) for state in (part.before, part.state)]
    if not step.constant and sticking[0] != sticking[1]:
        raise ContactError(
            "a patch begins to slide as a whole, or sticks again, while P or the tilt changes: the "
            "energy lost is not covered; ask for the state alone, or change Q at constant P"
        )
    contact = part.state.contact
    whole, error = slip_work(RelativeSlip(part.equations), contact.limit.on, contact), 0.0
    if not step.constant:
        if part.panel is not None:
            moved, error = _of_panel(part.panel)
        else:
            moved, error = _of_finite_part(part, step, whole)
        whole -= moved
    elif part.panel is None:
        error = _turned(part, step)
    if error > REFUSED * whole:
        raise ContactError(
            f"the energy lost is known to {error / whole:.0e} of it only, as where slip turns on "
            "the way: put a point of the path in between; the state is not concerned"
        )
    return whole * 2.0 / step.contacts.scene.Estar


def _leaves(part: Part, step: LoadStep) -> bool:
    """Whether slip zones have left the contact before the end of a part."""
    if part.panel is not None or part.state.contact.width >= part.before.contact.width:
        return False
    after = step.at(part.begun + 0.5 * (part.until - part.begun))
    return not balanced(Equations(part.before, after, Zones(after.patches, ())), STUCK)


def _turned(part: Part, step: LoadStep) -> float:
    """∫ f p (what places slip to and fro - |Δg|) dx of a finite step at constant pressure."""
    way, contact = Way.back(part, step), part.state.contact
    x = np.concatenate([np.linspace(lo, hi, PLACES + 2)[1:-1] for lo, hi in contact.patches])
    try:
        shares = part.begun + (part.until - part.begun) * BETWEEN
        on_the_way = [way.equations(float(share)) for share in shares[::-1]]
    except ContactError:
        return np.inf
    slips = [RelativeSlip(now).at(x) for now in (part.equations, *on_the_way)]
    to_and_fro = np.abs(np.diff([*slips, 0.0 * x], axis=0)).sum(axis=0)
    more = contact.limit(x) * (to_and_fro - np.abs(slips[0]))
    return float(more.mean() * sum(hi - lo for lo, hi in contact.patches))


def _sticking(state: State) -> list[bool]:
    """For each patch whether some of it sticks."""
    return [any(x1 <= a and b <= x2 for a, b in state.stick) for x1, x2 in state.contact.patches]


def _by_pressure(now: Equations, rates: Rates) -> float:
    """∫ f dp/dt s Δg dx."""
    return rates.friction * slip_work(RelativeSlip(now), rates.pressure.density, now.after)


@lru_cache(maxsize=2)
def _last_coefficients(n: int) -> Array:
    """The matrix of the last three Chebyshev coefficients of values at the nodes, (3, n + 1)."""
    values = chebvander(2.0 * clenshaw_curtis(n)[0] - 1.0, n)
    return np.asarray(np.linalg.inv(values), dtype=np.float64)[-3:]


def _integral(values: Array) -> tuple[float, float]:
    """The integral from 0 to 1 of values at the nodes, and its error by the last coefficients.

    A term T_n adds 1/n² to the integral, about.
    """
    n = len(values) - 1
    tail = np.abs(_last_coefficients(n) @ values).max()
    return float(clenshaw_curtis(n)[1] @ values), float(tail) / n**2


def _of_panel(panel: Panel) -> tuple[float, float]:
    """∫ dt ∫ f dp/dt s Δg dx of a part on which something comes to stick, and its error."""
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
class Way(ZonesBetween):
    """The integrand of the energy at shares of a finite step."""

    values: dict[float, float] = field(default_factory=dict)
    allowed: float = 0.0  # error of a value
    missed: int = 0  # how often no zones were found
    # a share at which no zones were found, by the known ones that it lies between
    failed: dict[tuple[float, float], float] = field(default_factory=dict)

    def integral(self, a: float, b: float) -> tuple[float, float]:
        """∫ dt ∫ f dp/dt s Δg dx between two shares, and its error."""
        v = clenshaw_curtis(INTERVALS)[0][1:-1]
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
            self.values[share] = _by_pressure(
                now, Rates.where(now, self.step.rates, self.step.friction)
            )
        return self.values[share], 0.0

    def _between(self, share: float) -> tuple[float, float, tuple[float, float]]:
        """The value between those at the nearest known shares, its error, and these shares."""
        a = max((k for k in self.known if k < share), default=self.span[0])
        b = min(k for k in self.known if k > share)
        first = self.value(a)[0] if a in self.known else 0.0  # before any slip
        last = self.value(b)[0]
        found = first + (last - first) * (share - a) / (b - a)
        return found, abs(last - first), (a, b)


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
        turns = first.zones.signs != last.zones.signs
        one, other = (_watched(way, now, turns) for now in (first, last))
        if len(one) == len(other):
            passed = np.flatnonzero(one * other < -(near**2)).tolist()
            found += [_root(way, (sooner, later), k, turns) for k in passed]
    return found


def _watched(way: Way, now: Equations, turns: bool) -> Array:
    """Ends and edges less the marks; if slip turns the coordinates too, which may change sign."""
    places = np.append(now.stick, now.after.patches)
    beyond = (places[:, None] - way.before.marks).ravel()
    return np.append(beyond, way.coordinates(now) if turns else ())


def _root(way: Way, span: tuple[float, float], k: int, turns: bool) -> float:
    """The share at which value k of those that are watched changes its sign.

    A slip zone that is too short for Newton's method is as good as vanished.
    """

    def value(now: Equations) -> float:
        return float(_watched(way, now, turns)[k])

    sooner, later = span
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
