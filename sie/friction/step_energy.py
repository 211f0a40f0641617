"""The energy that friction dissipates in a part of a step: ∫ dt ∫ f p |dg/dt| dx.

The power follows from the zones at a moment (`rates`). On a strip part they are known at its
moments, where Clenshaw and Curtis integrate 2 T τ dτ. In a finite part each moment is a finite step
from the start of it; the zones move smoothly but where an end passes a mark of the shear, at which
the time is cut. On each piece t = t_a + (t_b - t_a) sin²(πv/2), with Gauss nodes in v.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.chebyshev import gauss_legendre

from .cells import zones_on_cells
from .finite_step import Equations, Zones, newton
from .loading import LoadStep
from .onset import onset
from .rates import Rates
from .state import Contact, Slips, State
from .strips import MOMENTS, TAU, Panel

Array = NDArray[np.float64]

NODES = 16
LOOKED = np.array([1e-4, 0.01, 0.05, 0.15, 0.3, 0.5, 0.7, 0.9])  # shares where marks are passed
GOES_ON = -1e-5  # of the largest K, and of the largest rate of slip
HALVINGS = 30  # of the time between two shares, to find when an end passes a mark


def rates_of(contact: Contact, zones: Zones, slip: Slips, step: LoadStep) -> Rates:
    """The rates of a state at the rates of loads of a step."""
    return Rates.solved(
        contact.patches,
        zones.stick,
        slip,
        step.rates,
        friction=step.friction,
        period=contact.period,
    )


def power(contact: Contact, zones: Zones, slip: Slips, step: LoadStep) -> float:
    """(E*/2) ∫ f p |dg| of a state, per unit of the step's share."""
    rates = rates_of(contact, zones, slip, step)
    return rates.power(contact.limit.on, tuple(contact.limit.marks))


@lru_cache(maxsize=1)
def _weights() -> Array:
    """The weights of Clenshaw and Curtis at the moments of a panel, of ∫ dτ from 0 to 1."""
    k = np.arange(MOMENTS + 1)
    of_polynomials = np.where(k % 2, 0.0, 1.0 / (1.0 - np.where(k % 2, 0.0, k) ** 2))
    matrix = np.polynomial.chebyshev.chebvander(2.0 * TAU - 1.0, MOMENTS)
    return np.linalg.solve(matrix.T, of_polynomials)


def work_of_panel(panel: Panel) -> float:
    """(E*/2) times the energy of a part on which something comes to stick."""
    powers = [
        rates.power(contact.limit.on, tuple(contact.limit.marks))
        for rates, contact in zip(panel.rates, panel.span.contacts, strict=True)
    ]
    return float(_weights()[1:] @ (2.0 * panel.span.length * TAU[1:] * np.array(powers)))


def work_of_finite_part(
    before: State, after: State, step: LoadStep, span: tuple[float, float]
) -> float:
    """(E*/2) times the energy of a finite step between two shares of a step of loads."""
    if not after.slip:
        return 0.0
    begun, until = span
    way = Way.back(before, after, step, span)
    shares = [until, *(begun + (until - begun) * LOOKED[::-1]).tolist()]
    cuts = sorted({begun, until, *_cuts(way, shares)})
    g, w = gauss_legendre(NODES)
    turn, pace = np.sin(0.5 * np.pi * g) ** 2, 0.5 * np.pi * np.sin(np.pi * g) * w
    total = 0.0
    for a, b in reversed(list(pairwise(cuts))):
        for share, weight in zip(reversed(turn.tolist()), reversed(pace.tolist()), strict=True):
            now = way.equations(a + (b - a) * share)
            total += (b - a) * weight * power(now.after, now.zones, now.slip, step)
    return total


@dataclass(eq=False)
class Way:
    """The zones on the way through a finite step; `known` holds those found, by their share."""

    before: State
    step: LoadStep
    start: Array  # the ends as the step begins
    begun: float
    known: dict[float, Equations] = field(default_factory=dict)

    @classmethod
    def back(cls, before: State, after: State, step: LoadStep, span: tuple[float, float]) -> Way:
        """Through the part between two states, from its end on."""
        start = np.array(onset(before, step.rates, step.friction).stick).ravel()
        zones = Zones(after.stick, tuple(s for *_, s in after.slip))
        way = cls(before, step, start, span[0])
        way.known[span[1]] = Equations(before, after.contact, zones)
        return way

    def equations(self, share: float) -> Equations:
        """The equations at a share, whose zones go on as they have to; else the guess for it."""
        if share not in self.known:
            after, guesses = self.step.at(share), list(self._guesses(share))
            found = (self._passed(after, guess) for guess in guesses)
            self.known[share] = next(
                (now for now in found if now is not None),
                Equations(self.before, after, guesses[0]),
            )
        return self.known[share]

    def _passed(self, after: Contact, guess: Zones) -> Equations | None:
        """The equations from a guess, if they are solved and nothing in it sticks or turns."""
        try:
            found = newton(self.before, after, guess)
            rates = rates_of(after, found.zones, found.slip, self.step)
        except ContactError:
            return None
        margins = rates.signed_K[np.isfinite(rates.signed_K)]
        stops = margins.min(initial=0.0) < GOES_ON * np.abs(rates.K).max()
        return None if stops or rates.turning < GOES_ON else found

    def _guesses(self, share: float) -> Iterator[Zones]:
        """By a line through known zones, the nearest ones, those of other signs, else by cells."""
        nearest = min(self.known, key=lambda other: abs(other - share))
        now = self.known[nearest]
        ends, signs = now.stick.ravel(), now.zones.signs
        others = {k: e.stick.ravel() for k, e in self.known.items() if e.zones.signs == signs}
        if len(self.start) == len(ends):
            others[self.begun] = self.start
        others.pop(nearest)
        if others:
            k = min(others, key=lambda other: abs(other - share))
            line = ends + (others[k] - ends) * ((share - nearest) / (k - nearest))
            if (np.diff(line) > 0.0).all() and _inside(line, self.step.at(share)):
                yield Zones(tuple((float(a), float(b)) for a, b in line.reshape(-1, 2)), signs)
        yield now.zones
        others = {k: e.zones for k, e in self.known.items() if e.zones.signs != signs}
        if others:
            yield others[min(others, key=lambda other: abs(other - share))]
            return
        try:
            yield from zones_on_cells(self.before, self.step.at(share))
        except ContactError:
            return


def _inside(ends: Array, contact: Contact) -> bool:
    edges = np.array(contact.patches)
    return bool(((edges[:, :1] < ends) & (ends < edges[:, 1:])).any(axis=0).all())


def _cuts(way: Way, shares: list[float]) -> list[float]:
    """The shares at which ends pass marks, or other zones slip; `shares` falls."""
    found = []
    for later, sooner in pairwise(shares):
        first, last = way.equations(sooner), way.equations(later)
        if first.zones.signs != last.zones.signs:
            found.append(_first(_Signed(last.zones.signs), way, sooner, later))
            continue
        near = 1e-9 * way.before.contact.width
        for j, (a, b) in enumerate(zip(first.stick.ravel(), last.stick.ravel(), strict=True)):
            inside = (way.before.marks - a) * (b - way.before.marks) > near**2
            for mark in way.before.marks[inside]:
                passed = _Passed(j, mark, float(np.sign(b - a)))
                found.append(_first(passed, way, sooner, later))
    return found


@dataclass(frozen=True)
class _Signed:
    """Whether slip has these directions."""

    signs: tuple[float, ...]

    def __call__(self, now: Equations) -> bool:
        return now.zones.signs == self.signs


@dataclass(frozen=True)
class _Passed:
    """Whether an end is beyond a mark; one on it is not, which Newton's method prefers."""

    j: int
    mark: float
    way: float

    def __call__(self, now: Equations) -> bool:
        ends = now.stick.ravel()
        return self.j < ends.size and self.way * (ends[self.j] - self.mark) > 0.0


def _first(holds: Callable[[Equations], bool], way: Way, sooner: float, later: float) -> float:
    """The share from which on something holds, by halving: other ends ask at the same shares."""
    for _ in range(HALVINGS):
        middle = 0.5 * (sooner + later)
        sooner, later = (sooner, middle) if holds(way.equations(middle)) else (middle, later)
    return later
