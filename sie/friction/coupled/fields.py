"""p, q and γ of a state at any place, from tables in the variable of the quadrature.

The fields are computed at four shifts of the rule, and interpolated between equidistant v: whatever
power of the distance they have at an end, they are smooth in v.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import sici

from .pieces import STEP, Places
from .state import State

Array = NDArray[np.float64]

SHIFTS = 4
POINTS = 14  # of the interpolation
FARTHEST = 22.0  # |v| beyond which fields go on as a power of the distance from an edge
DEEP = 33.0  # |v| up to which p and γ are told at marks inside the contact
NEAREST = 1e-8  # of the contact: nodes that are nearer to a mark are not looked at


@dataclass(frozen=True, eq=False)
class Fields:
    """The fields of a state."""

    state: State

    def __call__(self, x: Array, rest: Array | None = None) -> Array:
        """Rows of p, q and γ at places in contact, at distances `rest` from the nearer edge."""
        cuts = self.state.pieces.cuts
        k = np.clip(np.searchsorted(cuts, x, side="right") - 1, 0, len(cuts) - 2)
        lo, hi = x - cuts[k], cuts[k + 1] - x
        if rest is not None:
            at_left = (k == 0) & (lo < hi)
            at_right = (k == len(cuts) - 2) & (hi <= lo)
            lo, hi = np.where(at_left, rest, lo), np.where(at_right, rest, hi)
        with np.errstate(divide="ignore"):
            v = np.log(np.maximum(lo, 0.0)) - np.log(np.maximum(hi, 0.0))
        rows, last = np.empty((3, len(x))), len(cuts) - 2
        for piece in np.unique(k):
            own = k == piece
            first, table = self._tables[piece]
            lowest = FARTHEST if piece == 0 else DEEP
            highest = FARTHEST if piece == last else DEEP
            for row, far in (([0, 2], (-lowest, highest)), ([1], (-FARTHEST, FARTHEST))):
                place = (np.clip(v[own], *far) - first) * (SHIFTS / STEP)
                rows[np.ix_(row, own)] = interpolated(table[row], place)
        sign = self.state.pieces.sign[self.state.pieces.zone_of_piece[k]]
        slips = sign != 0.0
        rows[1, slips] = sign[slips] * self.state.question.friction * rows[0, slips]
        powers = self.state.pieces.powers
        for edge, side, way in ((0, k == 0, -1.0), (-1, k == len(cuts) - 2, 1.0)):
            beyond = side & (way * v > FARTHEST)
            rows[:2, beyond] *= np.exp(powers[edge] * (FARTHEST - way * v[beyond]))
        return rows

    def gamma(self, x: Array) -> Array:
        """γ in contact."""
        values: Array = self(x)[2]
        return values

    @cached_property
    def _rules(self) -> tuple[list[Places], list[Array]]:
        """The four rules, and rows of p, q and γ on each."""
        state, question = self.state, self.state.question
        beta, f, pieces = question.beta, question.friction, state.pieces
        rules = [pieces.rule(shift / SHIFTS) for shift in range(SHIFTS)]
        flows, stuck, cos = [], [], math.cos(math.pi * question.theta)
        for at in rules:
            sticks, A, p = state.sticks(at), state.A(at), np.empty(len(at.x))
            gamma = np.empty(len(at.x))
            gamma[sticks] = question.gamma(at.x[sticks])
            p[sticks] = (A[sticks] - beta * gamma[sticks]) / (1.0 - beta**2)
            H1, chi = question.slope(at.x), state.chi(at)
            mass = np.where(sticks, p, -cos * H1) * at.weight / chi
            stuck.append((sticks, A, H1, chi, p, gamma))
            flows.append(mass)
        rows = []
        for k, at in enumerate(rules):
            sticks, A, H1, chi, p, gamma = stuck[k]
            other = (k + SHIFTS // 2) % SHIFTS
            flow = chi * state.psi(at, rules[other], flows[other])
            sign = pieces.sign[at.zone]
            kappa = sign * beta * f
            p = np.where(sticks, p, cos * flow - kappa * H1 / (1.0 + kappa**2))
            q = np.where(sticks, (flow - H1) / beta, sign * f * p)
            gamma = np.where(sticks, gamma, (A - (1.0 - beta**2) * p) / beta)
            rows.append(np.stack((p, q, gamma)))
        return rules, rows

    @cached_property
    def _tables(self) -> list[tuple[float, Array]]:
        """The first v and the rows of each piece."""
        rules, rows = self._rules
        lengths, tables = self.state.pieces.lengths, []
        for piece in range(len(lengths)):
            first = rules[0].offset[rules[0].piece == piece][0] / lengths[piece]
            tables.append((math.log(first), self._merged(rules, rows, piece)))
        return tables

    def _merged(self, rules: list[Places], rows: list[Array], piece: int) -> Array:
        columns = [row[:, rule.piece == piece] for rule, row in zip(rules, rows, strict=True)]
        merged: Array = np.stack(columns, axis=2).reshape(len(rows[0]), -1)
        return merged

    @cached_property
    def whole(self) -> tuple[Places, Array]:
        """The nodes of all shifts, piece by piece in ascending order, and rows of p, q and γ."""
        rules, rows = self._rules
        numbers = [
            SHIFTS * np.arange(len(rule.x), dtype=float)[None] + k for k, rule in enumerate(rules)
        ]
        pieces = range(len(self.state.pieces.lengths))
        order = np.concatenate([self._merged(rules, numbers, piece)[0] for piece in pieces])
        order = order.astype(int)
        every = Places(*(np.stack(c, axis=1).ravel()[order] for c in zip(*rules, strict=True)))
        fields = np.stack(rows, axis=2).reshape(3, -1)[:, order]
        return every._replace(weight=every.weight / SHIFTS), fields

    @cached_property
    def nodes(self) -> tuple[Places, Array]:
        """The same without those that are nearer to a cut than what matters."""
        every, fields = self.whole
        kept = np.abs(every.offset) > NEAREST * self.state.pieces.length
        return every.chosen(kept), fields[:, kept]


def interpolated(table: Array, place: Array) -> Array:
    """Columns of a table at fractional places by Lagrange's polynomials."""
    first = np.clip(np.floor(place).astype(int) - POINTS // 2 + 1, 0, table.shape[1] - POINTS)
    apart = (place - first)[:, None] - np.arange(POINTS)
    exact = apart == 0.0
    weights = _WEIGHTS / np.where(exact, 1.0, apart)
    weights = np.where(exact.any(axis=1)[:, None], exact, weights)
    weights /= weights.sum(axis=1)[:, None]
    values: Array = np.einsum("rmk,mk->rm", table[:, first[:, None] + np.arange(POINTS)], weights)
    return values


def cumulative(values: Array) -> Array:
    """The integral of equidistant values up to each place, in steps, by the sinc series.

    The integrand vanishes towards both ends: error e^(-π²/h).
    """
    k = np.arange(1 - len(values), len(values))
    total: Array = np.convolve(values, 0.5 + sici(math.pi * k)[0] / math.pi, "valid")
    return total


def summed(values: Array) -> Array:
    """The same by neighbours alone, where what is far away may not be smooth."""
    half = len(_STENCIL) // 2
    padded = np.concatenate((np.zeros(half), values, np.zeros(half)))
    total: Array = np.cumsum(np.convolve(padded, _STENCIL[::-1], "valid")[: len(values)])
    return total


def _integral_of_step(points: int) -> Array:
    """Weights of equidistant values for the integral between the two in the middle."""
    t = np.arange(points) - (points - 1) / 2.0
    powers = np.arange(points)
    exact = np.where(powers % 2 == 0, 2.0 * 0.5 ** (powers + 1) / (powers + 1), 0.0)
    return np.asarray(np.linalg.solve(t ** powers[:, None], exact))


_STENCIL = _integral_of_step(10)
_WEIGHTS: Array = np.array(
    [(-1.0) ** j * math.comb(POINTS - 1, j) for j in range(POINTS)], dtype=float
)
