"""A state of dissimilar bodies in the coordinates of the scene: zones, tractions, gap."""

from __future__ import annotations

from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.contact.known_contact import Edges
from sie.numerics.interval import Interval
from sie.traction.base import FAR_AWAY, InContact, on_line, zero_or_nan

from .traction import EDGE, REACH, OnPieces, Piece, places, tabulated

if TYPE_CHECKING:
    from sie.profiles.base import Profile

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
        return self._rows(x - self.origin, rest)

    def _rows(self, x: Array, rest: Array | None = None) -> Array:
        p, q, _ = self.loaded.fields(x, rest)
        return np.stack((p, self.sign * q))

    @property
    def values(self) -> InContact:
        """The tractions about the origin."""
        lo, hi = self.loaded.zones.ends[[0, -1]].tolist()
        marks = (lo, *(x - self.origin for x in self.marks[1:-1]), hi)
        return InContact(Interval(lo, hi), marks, self._rows, self.origin, self.sharp)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places in the contact where p or q is not smooth, with its edges, ascending."""
        (lo, hi), kinks = self.contact[:2], self.loaded.question.slope.kinks
        places = {self.origin + x for x in (*self.loaded.marks, *kinks)}
        return (lo, *sorted(x for x in places if lo < x < hi), hi)

    @cached_property
    def _tables(self) -> list[list[Piece]]:
        """p and q on each piece."""
        fields, pieces = self.loaded.fields, self.loaded.state.pieces
        reach = EDGE / (1.0 + min(0.0, *pieces.powers.tolist())) if self.sharp else REACH
        v, found = tabulated(places(reach)), []
        cuts = pieces.cuts.tolist()
        cuts[0], cuts[-1] = (edge - self.origin for edge in self.contact[:2])
        for k, length in enumerate(pieces.lengths.tolist()):
            p, q, _ = fields.on_piece(k, v)
            found.append([Piece(cuts[k], cuts[k + 1], length, f) for f in (p, self.sign * q)])
        return found

    def _pieces(self, row: int) -> list[Piece]:
        return [pair[row] for pair in self._tables]

    def _row(self, row: int, x: Array) -> Array:
        values: Array = self.rows(x)[row]
        return values

    @cached_property
    def tractions(self) -> tuple[OnPieces, OnPieces]:
        """p and q with their potentials."""
        loads = self.loaded.question.P, self.sign * self.loaded.Q
        p, q = (
            OnPieces(
                self.contact,
                partial(self._row, k),
                partial(self._pieces, k),
                loads[k],
                self.origin,
                self.marks,
                self.sharp,
            )
            for k in (0, 1)
        )
        return p, q

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x since it came into contact, same shape: 0 outside the contact."""

        def value(flat: Array) -> Array:
            g, (lo, hi) = np.zeros(flat.shape), self.contact[:2]
            inside = (flat >= lo) & (flat <= hi)
            g[inside] = self.sign / self.half_modulus * self._slip(flat[inside] - self.origin)
            return g

        return on_line(value, x)

    def _slip(self, x: Array) -> Array:
        """E*/2 times the slip for β > 0, at places about the origin."""
        raise NotImplementedError

    # -- beside the contact ------------------------------------------------------------------------

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        lo, hi = profile.domain
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        known = np.isfinite(flat) & (out == 0.0)
        for edge, side in ((self.contact.x1, -1.0), (self.contact.x2, 1.0)):
            beside = known & (side * (flat - edge) > 0.0)
            apart = np.minimum(np.abs(flat[beside] - edge), FAR_AWAY * self.contact.r)
            rise = profile.height(flat[beside]) - profile.height(np.array(edge))
            out[beside] = rise - self.loaded.fields.raised(apart, side) / self.half_modulus
        return out.reshape(np.shape(x))
