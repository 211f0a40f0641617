"""The loads of a path, the contact under them, and a step from one point to the next.

The moments of a part of a step are t0 + T τ², τ the nodes of Clenshaw and Curtis on [0, 1], and
what is known at them is a Chebyshev series in τ: a part begins like a series in sqrt(t).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.numerics.graded_panels import Pieces

from .rates import LoadRates
from .state import SAME, Contact, Ends, intervals

if TYPE_CHECKING:
    from sie.problem.scene import Scene
    from sie.traction.base import Density

Array = NDArray[np.float64]

MOMENTS = 12
TAU = 0.5 * (1.0 - np.cos(np.pi * np.arange(MOMENTS + 1) / MOMENTS))
FEW = 8  # breaks in contact: of more, of a trace, each one is faint
FIRST = 1e-14  # of a step from nothing: after that the bodies touch


@lru_cache(maxsize=2)
def _transform(first: int) -> Array:
    """Coefficients in T_k(2τ - 1) from values at the moments, from `first` on."""
    values = np.polynomial.chebyshev.chebvander(2.0 * TAU[first:] - 1.0, MOMENTS - first)
    return np.asarray(np.linalg.inv(values), dtype=np.float64)


def in_time(values: Array) -> Array:
    """The series of values at the moments, with the one at the start or without."""
    return _transform(MOMENTS + 1 - len(values)) @ values


def at_share(series: Array, share: float | Array) -> Array:
    """The value of a series at shares τ."""
    value = np.polynomial.chebyshev.chebval(2.0 * np.asarray(share) - 1.0, series)
    return np.asarray(value, dtype=np.float64)


class Loads(NamedTuple):
    """The loads of a contact: P, Q, σ, and what is added to the tilt or the moment of the scene."""

    P: float
    Q: float
    sigma: float
    turn: float = 0.0

    def towards(self, end: Loads, share: float) -> Loads:
        """The loads in a step to others, after this share of its time."""
        pairs = zip(self, end, strict=True)
        return Loads(*(a + share * (b - a) for a, b in pairs)) if share < 1.0 else end

    def touching(self, end: Loads) -> Loads:
        """The same, or if nothing touches under them, those soon after it in a step to others."""
        return self if self.P else self.towards(end, FIRST)

    @property
    def normal(self) -> tuple[float, float]:
        """What the pressure depends on."""
        return self.P, self.turn

    def __str__(self) -> str:
        shown = ", ".join(f"{v:.6g}" for v in self[:3])
        return f"(P, Q, σ) = ({shown})" + (f" at {self.turn:.6g}" if self.turn else "")


class Contacts(Protocol):
    """The contacts of a path.

    scene           profile, bodies and friction
    pressed         the patches and the pressure under loads
    sheared_by      Q and τ of loads
    curved          whether the tilt follows from a moment, and not in proportion to time
    by_moment       whether moments are added along the path, not tilts
    """

    scene: Scene

    def pressed(self, loads: Loads) -> tuple[tuple[tuple[float, float], ...], Any]: ...
    def sheared_by(self, loads: Loads) -> tuple[float, float]: ...
    @property
    def curved(self) -> bool: ...
    @property
    def by_moment(self) -> bool: ...


def contact_under(contacts: Contacts, loads: Loads) -> Contact:
    """The contact under loads."""
    patches, pressure = contacts.pressed(loads)
    limit = limit_on(contacts.scene, patches, pressure)
    return Contact(patches, limit, *contacts.sheared_by(loads), contacts.scene.profile.period)


def limit_on(scene: Scene, patches: Ends, pressure: Density, most: int = FEW) -> Pieces:
    """f p, with marks at the breaks of the profile in contact, if there are no more than `most`."""
    breaks = np.array(scene.profile.pieces.break_points)
    breaks = breaks[(breaks > patches[0][0]) & (breaks < patches[-1][1])]
    corners = breaks if len(breaks) <= most else breaks[:0]
    ends = intervals(patches, corners, SAME * (patches[-1][1] - patches[0][0]))
    return Pieces.fitted(ends, lambda rule: scene.friction * pressure(rule.x))


@dataclass(frozen=True, eq=False)
class LoadStep:
    """A step between two loads, which change in proportion to its share t."""

    contacts: Contacts
    start: Loads
    end: Loads
    known: dict[float, Contact] = field(default_factory=dict)

    @property
    def friction(self) -> float:
        return self.contacts.scene.friction

    @property
    def constant(self) -> bool:
        """Whether the pressure does not change."""
        return self.start.normal == self.end.normal

    def loads(self, share: float) -> Loads:
        """The loads after a share of the step."""
        return self.start.towards(self.end, share)

    def at(self, share: float) -> Contact:
        """The contact after a share of the step."""
        if share not in self.known:
            loads = self.loads(share)
            if self.constant and self.known:
                one = next(iter(self.known.values()))
                Q, tau = self.contacts.sheared_by(loads)
                self.known[share] = Contact(one.patches, one.limit, Q, tau, one.period)
            else:
                self.known[share] = contact_under(self.contacts, loads)
        return self.known[share]

    @cached_property
    def rates(self) -> LoadRates:
        """The changes of the loads in the whole step."""
        contacts = self.contacts
        (Q0, tau0), (Q, tau) = (contacts.sheared_by(at) for at in (self.start, self.end))
        turn = self.end.turn - self.start.turn
        moment = turn if contacts.curved else None
        if contacts.by_moment or contacts.curved:
            turn = 0.0  # a moment at constant P and tilt, or a tilt that the scene's moment causes
        turn *= 0.5 * contacts.scene.Estar
        return LoadRates(self.end.P - self.start.P, turn, Q - Q0, tau - tau0, moment)
