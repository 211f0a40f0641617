"""The slip gradient that places keep while a contact spreads under Q, beside that under P alone.

What the contact gained keeps the γ with which it was touched, or left the strip at the edge, a
polynomial in ln s on panels of s = -b - x, the distance from the old edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

from .opened_search import Search

Array = NDArray[np.float64]

NODES = 12  # for ∫γ between two cuts
CONTINUED = 0.1  # of ln s, before the last panel ends: from there on γ is continued


class GradientPanel(NamedTuple):
    """γ as a polynomial in ln s by its values at nodes."""

    lo: float
    hi: float
    nodes: Array
    values: Array

    def __call__(self, s: Array) -> Array:
        values: Array = between(self.nodes, np.log(s)) @ self.values
        return values


def between(nodes: Array, x: Array) -> Array:
    """The polynomials that are 1 at one node, 0 at the others, a row for each x."""
    apart = nodes[:, None] - nodes
    np.fill_diagonal(apart, 1.0)
    distance = x[:, None] - nodes
    hit = distance == 0.0
    distance[hit] = 1.0
    rows: Array = 1.0 / (distance * apart.prod(axis=1))
    rows /= rows.sum(axis=1, keepdims=True)
    on_node = hit.any(axis=1)
    rows[on_node] = hit[on_node]
    return rows


@dataclass(frozen=True, eq=False)
class KeptGradient:
    """γ with which places stick, by y = x + b: under P alone, or as they were touched.

    search      has the first one
    panels      of s for the second, ascending; before the first γ goes with a power of s
    """

    search: Search
    panels: tuple[GradientPanel, ...]

    def with_panel(self, panel: GradientPanel) -> KeptGradient:
        return KeptGradient(self.search, (*self.panels, panel))

    @cached_property
    def at_edge(self) -> float:
        return float(self.search.gamma(np.array([self.search.normal.b]))[0])

    def gained(self, s: Array) -> Array:
        """γ of what was touched at s."""
        first = self.panels[0]
        start = float(first(np.array([first.lo]))[0]) - self.at_edge
        values = self.at_edge + start * (s / first.lo) ** (0.5 + self.search.theta)
        beyond = s > self.panels[-1].hi
        which = np.where(beyond, -1, np.searchsorted([panel.lo for panel in self.panels], s) - 1)
        for k in np.unique(which[which >= 0]).tolist():
            own = which == k
            values[own] = self.panels[k](s[own])
        if beyond.any():
            values[beyond] = self.continued(np.log(s[beyond]))
        return values

    def continued(self, logs: Array) -> Array:
        """A guess of γ beyond the last panel, given ln s.

        That panel may be so short that its polynomial is of no use there.
        """
        places = self.panels[-1].hi * np.exp(-CONTINUED * np.array([0.0, 0.5, 1.0]))
        values: Array = between(np.log(places), logs) @ self.gained(places)
        return values

    def __call__(self, y: Array) -> Array:
        values, old, b = np.empty(len(y)), y >= 0.0, self.search.normal.b
        values[old] = self.search.gamma(np.minimum(np.abs(y[old] - b), b))
        values[~old] = self.gained(-y[~old])
        return values

    def integral(self, lo: float, hi: float) -> float:
        """∫γ dy for lo < 0 < hi."""
        b, first = self.search.normal.b, self.panels[0]
        x, _, w = with_weight(NODES, 0.0, 0.0)
        cuts = np.concatenate((self.search.gamma.cuts + b, [-p.lo for p in self.panels]))
        ends = np.array([lo, *sorted(cuts[(cuts > lo) & (cuts < hi)]), hi])
        ends = np.unique(np.append(ends, 0.0))
        # Next to the old edge γ has a power of the distance, known in closed form
        kept = (ends[1:] > 0.0) | (ends[1:] < -0.5 * first.lo)
        size = np.diff(ends)[kept, None]
        places = ends[:-1][kept, None] + size * x
        total = float((self(places.ravel()).reshape(places.shape) * w * size).sum())
        power, part = 1.5 + self.search.theta, min(first.lo, -lo)
        rise = float(self.gained(np.array([part]))[0]) - self.at_edge
        return total + part * (self.at_edge + rise / power)
