"""Full contact of a periodic profile, without edges.

Every harmonic A cos(kx + φ) of h gives the pressure -E*/2 k A cos(kx + φ):

    p(x) = P/λ + (E*/2λ) ∫_λ (H(t) - H(x)) cot(π(t - x)/λ) dt
    F(z) = (E*/2) [H + i/λ ∫_λ (H(t) - H) cot(π(z - t)/λ) dt] - i P/λ

for Im z > 0, with any H taken out. It is the answer if p >= 0, which is verified by bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.contact.known_contact import Edges
from sie.numerics import chebyshev
from sie.numerics.chord import Chord, Points
from sie.numerics.interval import Interval
from sie.profiles.pieces import Pieces
from sie.traction.base import Density, refuse_side, zero_or_nan

from .bounds import DEEPEST, NODES, TENSION, halves, lower_bound
from .density import NARROW, by_circle, potential_of
from .measure import NEAR
from .panels import Patches
from .result import CLOSE, GRADING, LEAST, PatchCertificate
from .rule import Rule, principal_value

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

GAUSS = 16  # nodes on a panel
FEWEST = 8  # panels
# of the period: a knot within rounding of an even cut leaves a panel without places between nodes
NARROWEST = 1e-10
CLOSED = 1e-12  # periods: a gap at a concave corner that is no wider is taken for none
# how often the panels of the certificate are graded towards breaks, and where H jumps at some:
# p is infinite there like a logarithm, of which the last panel has to hold next to nothing
LEVELS, DEEP = 12, 30
SUSPECTS = 16  # places of lowest pressure on a grid: tension there rules full contact out
CHUNK = 1 << 18
PLACES = 100  # at which the equation is measured
ZOOMS, ZOOMED = 6, 10  # around the least pressure: how often, and places each time
OPENING = "note: full contact is about to end: a gap opens where the load falls by {:.0e} of it"


@dataclass(frozen=True, eq=False)
class FullPressure(Density):
    """The pressure of full contact on [start, start + period], repeated.

    The load is per period; half_modulus is E*/2.
    """

    pieces: Pieces
    start: float
    period: float
    half_modulus: float
    load: float

    @property
    def interval(self) -> tuple[float, float]:
        return self.start, self.start + self.period

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        return (self.interval,)

    @property
    def loads(self) -> tuple[float, ...]:
        return (self.load,)

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return self.load

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        return float((self.rule.weight * self.at_rule) @ self.rule.points.x)

    @cached_property
    def panels(self) -> tuple[Array, Array, NDArray[np.int64]]:
        """Ends of the panels (p,), (p,) and their pieces of H."""
        cuts = self.pieces.cuts
        even = np.linspace(self.start, self.start + self.period, FEWEST + 1)
        ends = np.union1d(even, cuts[(cuts > self.start) & (cuts < self.start + self.period)])
        return ends[:-1], ends[1:], self.pieces.locate(0.5 * (ends[1:] + ends[:-1]))

    @cached_property
    def _sources(self) -> tuple[Array, Array, Array]:
        """Nodes (p, n), weights and H there."""
        lo, hi, piece = self.panels
        g, w = chebyshev.gauss_legendre(GAUSS)
        t = lo[:, None] + (hi - lo)[:, None] * g
        return t, (hi - lo)[:, None] * w, self.pieces.value(piece[:, None], t, 0.0)

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        return (*self.panels[0].tolist(), self.start + self.period)

    @cached_property
    def rule(self) -> Rule:
        """A composite rule, graded towards the ends of the panels."""
        lo, hi, piece = self.panels
        end = self.start + self.period
        jumps = self.pieces.jumps(np.array([self.start - 0.5 * self.period]), np.array([end]))
        levels = DEEP if jumps.any() else LEVELS
        graded = GRADING ** np.arange(1.0, levels + 1.0)
        part = np.unique(np.concatenate(([0.0, 0.5, 1.0], graded, 1.0 - graded)))
        start = (lo[:, None] + (hi - lo)[:, None] * part[:-1]).ravel()
        length = ((hi - lo)[:, None] * np.diff(part)).ravel()
        g, w = chebyshev.gauss_legendre(GAUSS - 4)
        x = (start[:, None] + length[:, None] * g).ravel()
        piece = np.repeat(piece, len(x) // len(lo))
        return Rule(Points(x, 0.0 * x), 0 * piece, piece, (length[:, None] * w).ravel())

    @property
    def rules(self) -> tuple[Rule, Rule]:
        """That, and places between its points."""
        lo, hi, piece = self.panels
        wide = np.flatnonzero(hi - lo > NARROWEST * self.period)
        some = wide[:: max(len(wide) // PLACES, 1)]
        x, piece = (lo + (hi - lo) * 0.45)[some], piece[some]
        return self.rule, Rule(Points(x, 0.0 * x), 0 * piece, piece, 0.0 * x)

    @cached_property
    def at_rule(self) -> Array:
        return self(self.rule.points.x)

    def within(self, x: Array) -> Array:
        return x - self.period * np.floor((x - self.start) / self.period)

    def _excess(self, z: Any, reference: Any, piece: Any) -> Any:
        """(1/λ) ∫ (H(t) - reference) cot(π(t - z)/λ) dt at z (m,) of this period."""
        size = max(CHUNK // self._sources[0].size, 1)
        out = np.empty(z.shape, dtype=np.result_type(z, reference))
        for start in range(0, len(z), size):
            some = slice(start, start + size)
            out[some] = self._part(z[some], reference[some], piece[some])
        return out / self.period

    def _part(self, z: Any, reference: Any, piece: Any) -> Any:
        t, w, H = self._sources
        lo, hi, own = self.panels
        k = np.pi / self.period
        away = z[:, None] - 0.5 * (lo + hi)
        turn = self.period * np.rint(np.real(away) / self.period)
        rows, panels = np.nonzero(np.abs(away - turn) < NEAR * 0.5 * (hi - lo))
        shifted = z[rows] - turn[rows, panels]  # the repetition of z that is near the panel
        step = t - z[:, None, None]
        step[rows, panels] = t[panels] - shifted[:, None]
        zero = step == 0.0
        cot = 1.0 / np.tan(k * np.where(zero, 1.0, step))
        value = w * cot * (H - reference[:, None, None])
        sums = value.sum(axis=2)
        near = step[rows, panels]
        same = (own[panels] == piece[rows]) & (turn[rows, panels] == 0.0)
        exact = self.pieces.divided(own[panels][:, None], (t[panels], 0.0), (shifted[:, None], 0.0))
        smooth = np.where(zero[rows, panels], 1.0 / k, near * cot[rows, panels])
        own_sum = (w[panels] * exact * smooth).sum(axis=1)
        residue = self.pieces.value(own[panels], shifted, 0.0) - reference[rows]
        real = np.real(shifted)
        e = self.pieces.breaks
        beyond = np.maximum(
            np.maximum(e[own[panels]] - real, real - e[own[panels] + 1]), np.abs(np.imag(shifted))
        )
        residue = np.where(beyond <= self.pieces.reach[own[panels]], residue, 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.sin(k * (hi[panels] - shifted)) / np.sin(k * (lo[panels] - shifted))
            pole = np.log(np.abs(ratio) if not np.iscomplexobj(ratio) else ratio) / k
        gauss = (w[panels] * cot[rows, panels]).sum(axis=1)
        pole = np.where(np.isfinite(pole), pole, gauss)
        other = sums[rows, panels] + residue * (pole - gauss)
        sums[rows, panels] = np.where(same, own_sum, other)
        return sums.sum(axis=1)

    def __call__(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        flat = x.ravel()
        out = zero_or_nan(flat)
        finite = np.isfinite(flat)
        at = self.within(flat[finite])
        piece = self.pieces.locate(at)
        H = self.pieces.value(piece, at, 0.0)
        out[finite] = self.load / self.period + self.half_modulus * self._excess(at, H, piece)
        return np.asarray(out.reshape(x.shape))

    def hilbert(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        at = self.within(np.where(np.isfinite(x), x, self.start))
        one, other = (
            self.pieces.value(self.pieces.locate(at, s), at, 0.0) for s in ("left", "right")
        )
        return np.asarray(
            np.where(np.isfinite(x), 0.5 * self.half_modulus * (one + other), zero_or_nan(x))
        )

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        refuse_side(side)
        z = arguments.complexes("z", z)
        return np.asarray(potential_of(self, z.ravel(), side).reshape(z.shape))

    def _off_axis(self, z: Complex) -> Complex:
        z = self.within(z.real) + 1j * z.imag
        piece = self.pieces.locate(z.real)
        follows = z.imag <= self.pieces.reach[piece]
        H = np.where(
            follows, self.pieces.value(piece, z, 0.0), self.pieces.value(piece, z.real, 0.0)
        )
        excess = self._excess(z, H, np.where(follows, piece, -1))
        return np.asarray(self.half_modulus * (H - 1j * excess) - 1j * self.load / self.period)

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        """By Cauchy's formula; on the surface from values beside."""
        refuse_side(side)
        z = arguments.complexes("z", z)
        flat = z.ravel()
        out, off = np.empty(flat.shape, dtype=complex), flat.imag != 0.0
        out[off] = by_circle(self.cauchy, flat[off], NARROW * np.abs(flat.imag[off]))
        x = flat.real[~off]
        step = 1e-3 * self.period
        weights = np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * step)
        slope = self(x[:, None] + step * np.array([-2.0, -1.0, 1.0, 2.0])) @ weights
        at = self.within(x)
        out[~off] = (
            self.half_modulus * self.pieces.curvature(self.pieces.locate(at), at)
            - 1j * side * slope
        )
        return np.asarray(out.reshape(z.shape))

    def _suspects(self) -> Array:
        """The places of lowest pressure on a uniform grid, on which H has its conjugate by FFT."""
        n = 1 << len(self.panels[0]).bit_length()
        x = self.start + (self.period / n) * np.arange(n)
        harmonics = np.fft.rfft(self.pieces.value(self.pieces.locate(x), x, 0.0))
        conjugate = np.fft.irfft(1j * harmonics, n)
        return np.asarray(x[np.argsort(conjugate)[:SUSPECTS]])

    @property
    def mean(self) -> float:
        return self.load / self.period

    @cached_property
    def lowest(self) -> float:
        """A lower bound of p over its mean; below 0 where p is negative."""
        lo, hi, _ = self.panels
        mean, lowest = self.mean, np.inf
        suspected = float(self(self._suspects()).min())
        if suspected < -TENSION * mean:
            return suspected / mean
        g, _ = chebyshev.gauss_legendre(NODES)
        for _ in range(DEEPEST):
            p = self((lo[:, None] + (hi - lo)[:, None] * g).ravel()).reshape(len(lo), NODES)
            if (p < -TENSION * mean).any():
                return float(p.min()) / mean
            bound = lower_bound(p)
            enough = bound >= -TENSION * mean
            lowest = min(lowest, float(bound[enough].min(initial=np.inf)))
            if enough.all():
                break
            lo, hi = halves(lo[~enough], hi[~enough])
        return lowest / mean


@dataclass(frozen=True, eq=False)
class FullContact:
    """Contact everywhere, as the answer to a scene."""

    edges: Edges
    pressure: FullPressure
    symmetric: bool = False
    gap_volume: float = 0.0
    found: None = None  # no edges are sought

    def slope(self, profile: Any) -> Any:
        return profile.pieces

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        return self.pressure.patches

    def gap(self, x: Array) -> Array:
        """No gap anywhere."""
        return np.where(np.isnan(x), np.nan, 0.0)

    def certificate(self, tol: float) -> PatchCertificate:
        """The residual of (1) by a composite rule of its own, and the equilibrium."""
        pressure, G = self.pressure, self.pressure.half_modulus
        (rule, at), p = pressure.rules, pressure.at_rule
        x, period = at.points, Patches.of(pressure.patches, Chord(pressure.period))
        found = principal_value(period, rule, p, (x, at.patch), pressure(x.x))
        residual = np.abs(found - G * pressure.pieces.value(at.piece, x.x, 0.0)).max()
        least = max(_minimum(pressure, rule.points.x, p), TENSION * pressure.mean)
        condition = pressure.mean / least
        return PatchCertificate(
            residual=float(residual) / float(p.max()),
            force=abs(float(rule.weight @ p) - pressure.load) / pressure.load,
            moment=0.0,
            lowest_pressure=min(pressure.lowest, 0.0),
            patches=1,
            condition=condition,
            measured_to=LEAST,
            tol=tol,
            notes=() if condition < CLOSE else (OPENING.format(1.0 / condition),),
        )


def _minimum(pressure: FullPressure, x: Array, p: Array) -> float:
    """The least pressure, from places around the least of these."""
    k = int(np.argmin(p))
    lo, hi = x[max(k - 1, 0)], x[min(k + 1, len(x) - 1)]
    lowest = float(p[k])
    for _ in range(ZOOMS):
        x = np.linspace(lo, hi, ZOOMED)
        p = pressure(x)
        k = int(np.argmin(p))
        lo, hi, lowest = x[max(k - 1, 0)], x[min(k + 1, ZOOMED - 1)], min(lowest, float(p[k]))
    return lowest


def full_contact(
    pieces: Pieces, start: float, period: float, half_modulus: float, load: float
) -> FullContact | None:
    """Full contact, if p >= 0 everywhere."""
    inside = pieces.void & (pieces.breaks[:-1] < start + period) & (pieces.breaks[1:] > start)
    if inside.any():
        return None
    pressure = FullPressure(pieces, start, period, half_modulus, load)
    if not pressure.lowest >= -TENSION:
        return None
    # a concave corner opens always, but what doubles do not tell from none
    corners = pieces.never_closed
    corners = corners[(corners >= start) & (corners <= start + period)]
    if (pressure(np.append(corners - CLOSED * period, corners + CLOSED * period)) < 0.0).any():
        return None
    edges = Edges(
        Interval(start, start + period),
        load,
        pressure.moment,
        0.0,
        (False, False),
        0.0,
        0.0,
        0.0,
        0,
    )
    return FullContact(edges, pressure)
