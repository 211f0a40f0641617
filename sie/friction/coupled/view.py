"""A state of dissimilar bodies in the coordinates of the scene.

States are solved about an origin in the contact, for β > 0; β < 0 turns the signs of q, of the
slip and of the strain.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.contact.known_contact import Edges
from sie.numerics.interval import Interval
from sie.profiles.base import Profile
from sie.traction.base import zero_or_nan
from sie.traction.in_contact import InContact

from .integral import outwards
from .two_sided import Known, TwoSidedTraction, both_tractions

if TYPE_CHECKING:
    from .step import Loaded

Array = NDArray[np.float64]


class View:
    """Zones, tractions and gap.

    loaded          the state
    origin          of its places
    sign            of β
    half_modulus    E*/2
    """

    loaded: Loaded
    origin: float
    sign: float
    half_modulus: float
    sharp = False  # whether the edges are corners, where the tractions are infinite

    # -- zones and loads ---------------------------------------------------------------------------

    @cached_property
    def contact(self) -> Interval:
        lo, hi = self.loaded.zones.ends[[0, -1]].tolist()
        return Interval(self.origin + lo, self.origin + hi)

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones."""
        return tuple((self.origin + lo, self.origin + hi) for lo, hi in self.loaded.zones.stick)

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        return tuple(
            (self.origin + lo, self.origin + hi, self.sign * s)
            for lo, hi, s in self.loaded.zones.slip
        )

    @property
    def edges(self) -> Edges:
        P = self.loaded.question.P
        sharp = self.sharp, self.sharp
        return Edges(self.contact, P, self.moment, 0.0, sharp, 0.0, 0.0, 0.0, 0)

    @cached_property
    def moment(self) -> float:
        """∫p x dx."""
        at, (p, _, _) = self.loaded.fields.whole
        return self.origin * self.loaded.question.P + float(at.weight @ (p * at.x))

    @property
    def kind(self) -> str:
        """The slip in words."""
        ways = ["+" if s > 0.0 else "-" for _, _, s in self.slip_zones]
        left, right = ways[0], ways[-1]
        where = f"towards {left}x" if left == right else f"towards {left}x left and {right}x right"
        return f"{where} beside the stick zone; β couples p and q"

    # -- tractions ---------------------------------------------------------------------------------

    def rows(self, x: Array, rest: Array | None = None) -> Array:
        """Rows of p and q in contact."""
        p, q, _ = self.loaded.fields(x - self.origin, rest)
        return np.stack((p, self.sign * q))

    @property
    def values(self) -> InContact:
        """The tractions about the origin."""
        lo, hi = self.loaded.zones.ends[[0, -1]].tolist()

        def rows(x: Array, rest: Array) -> Array:
            p, q, _ = self.loaded.fields(x, rest)
            return np.stack((p, self.sign * q))

        marks = (lo, *(x - self.origin for x in self.marks[1:-1]), hi)
        return InContact(Interval(lo, hi), marks, rows, self.origin, self.sharp)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places in the contact where p or q is not smooth, with its edges, ascending."""
        (lo, hi), kinks = self.contact[:2], self.loaded.question.slope.kinks
        places = {self.origin + x for x in (*self.loaded.marks, *kinks)}
        return (lo, *sorted(x for x in places if lo < x < hi), hi)

    @cached_property
    def tractions(self) -> tuple[TwoSidedTraction, TwoSidedTraction]:
        """p and q with their potentials, which share their panels."""
        lo, hi = self.stick[0]
        powers = self.loaded.state.pieces.powers
        loads = self.loaded.question.P, self.sign * self.loaded.Q
        known = Known(0.5 * (lo + hi), self.marks, (powers[0], powers[-1]), loads, self.moment)
        values = (lambda x: self.rows(x)[0], lambda x: self.rows(x)[1])
        return both_tractions(values, self.rows, known)

    # -- beside the contact ------------------------------------------------------------------------

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        lo, hi = profile.domain
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        known, width = np.isfinite(flat) & (out == 0.0), self.contact.r
        for edge, side in ((self.contact.x1, -1.0), (self.contact.x2, 1.0)):
            beside = known & (side * (flat - edge) > 0.0)
            if beside.any():

                def H(d: Array, edge: float = edge, side: float = side) -> Array:
                    at = edge - self.origin + side * np.maximum(d, 1e-12 * width)
                    return side * self.loaded.state.beside_contact(at)[0]

                rise = profile.height(flat[beside]) - profile.height(np.array(edge))
                raised = outwards(H, np.abs(flat[beside] - edge), width)
                out[beside] = rise - raised / self.half_modulus
        return out.reshape(np.shape(x))
