"""The zones of stick and slip between the ends of a finite step.

Each is a finite step from the start, found from those that are known: ends are continued by
polynomials in coordinates that stay smooth where a slip zone at an edge that retreats vanishes and
begins anew in the other direction. Its length d is then like (t - t*)², and s sqrt(d) a smooth
function of time which changes its sign at t*.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.zones import within

from .cells import zones_on_cells
from .equations import Equations
from .finite_step import Part, newton
from .loading import TAU, at_share, in_time
from .onset import onset
from .potentials import RelativeSlip
from .rates import Rates
from .state import Zones

if TYPE_CHECKING:
    from sie.numerics.zones import Slips

    from .loading import LoadStep
    from .state import Contact, Ends, State

Array = NDArray[np.float64]

HALVINGS = 52  # of the time at which a place comes into contact
GOES_ON = -1e-5  # of the largest K, and of the largest rate of slip


@dataclass(eq=False)
class ZonesBetween:
    """The zones at shares of the step; `known` holds those found."""

    before: State
    step: LoadStep
    span: tuple[float, float]
    known: dict[float, Equations]
    retreating: NDArray[np.int_]  # which edges retreat
    start: Array  # the coordinates at the start; none if the number of zones changes

    @classmethod
    def back(cls, part: Part, step: LoadStep) -> Self:
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
            rates = Rates.where(found, self.step.rates, self.step.friction)
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
        if not zones:  # slip has left the contact there
            return None
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


# -- the slip of a part, and of places that come into contact on the way ---------------------------


def slip(part: Part, step: LoadStep, x: Array) -> Array:
    """The slip at places (1-d); at one that came into contact in the part, since then."""
    found = RelativeSlip(part.equations).at(x)
    old, new = (part.before.contact.patches, part.state.contact.patches)
    touches, touched = within(x, new), within(x, old)
    gained = touches & ~touched
    sticks = gained & within(x, part.state.stick)  # since it touched
    found[sticks], gained = 0.0, gained & ~sticks
    if gained.any():
        found[gained] -= _slip_at_touch(part, step, x[gained])
    return np.where(touches, found, 0.0) * (2.0 / step.contacts.scene.Estar)


def _slip_at_touch(part: Part, step: LoadStep, x: Array) -> Array:
    """(E*/2) Δg at places when they come into contact, at an edge that grows steadily.

    The place of the edge and the slip there are series in τ, t = t0 + T τ².
    """
    old, new = part.before.contact.patches, part.state.contact.patches
    if len(old) != len(new):
        raise ContactError("the slip of a patch that appears or merges is not covered")
    found = np.zeros(x.shape)
    moments = _moments(part, step)
    for k, (was, now) in enumerate(zip(old, new, strict=True)):
        for side in (0, 1):
            a, b = sorted((was[side], now[side]))
            gained = (x >= a) & (x <= b)
            outward = (b == now[side]) == (side == 1)
            if outward and gained.any():
                edges = [equations.after.patches[k][side] for equations in moments]
                slips = [
                    RelativeSlip(equations).at(np.array([e]))[0]
                    for equations, e in zip(moments, edges)
                ]
                tau = _time_at(in_time(np.array([was[side], *edges])), x[gained], side == 1)
                found[gained] = at_share(in_time(np.array([0.0, *slips])), tau)
    return found


def _moments(part: Part, step: LoadStep) -> list[Equations]:
    """The equations at the moments of a part."""
    if part.panel is not None:
        return list(part.panel.equations)
    way = ZonesBetween.back(part, step)
    shares = part.begun + (part.until - part.begun) * TAU[1:] ** 2
    return [way.equations(float(share)) for share in shares[::-1]][::-1]


def _time_at(series: Array, x: Array, rises: bool) -> Array:
    """The τ at which an edge is at places, by halving."""
    lo, hi = np.zeros(x.shape), np.ones(x.shape)
    for _ in range(HALVINGS):
        middle = 0.5 * (lo + hi)
        later = (at_share(series, middle) < x) == rises
        lo, hi = np.where(later, middle, lo), np.where(later, hi, middle)
    return 0.5 * (lo + hi)
