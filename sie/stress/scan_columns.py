"""The columns of places that a scan for the largest stress looks at, dense near edges and breaks.

What is not smooth are the edges and breaks of the tractions, the marks. On a disc that keeps away
from these by its own radius the stress is a fast convergent power series, so that a scan whose
cells are as large as a fraction of

    s(x) = min_j (|x - m_j| + g_j),      m_j the marks, g_j a fraction of the gap to the next one

resolves it equally well at every scale: a rounded edge of 1e-6 b has as many cells as the whole
contact. Where the slope of a traction is infinite the stress goes like r ln r, or like the root of
r, with the distance r. Beside a falling term k r that has a maximum at a distance of exp(-k),
however small: there g_j is FINEST.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .half_plane import Tractions

Array = NDArray[np.float64]

# g of a mark is this fraction of the smaller gap beside it.
NEAR = 0.05
# The same where there are many marks.
NEAR_OF_MANY = 1.0
# g where the slope of a traction is infinite, in half-widths: beyond it a gain of r ln r is
# rounding.
FINEST = 1e-12
# Many marks that are nearer to each other, in half-widths, are merged.
RESOLVED = 1e-8
MANY_MARKS = 40
# The most singular marks that are kept: those with the highest pressure.
MOST_SINGULAR = 24
# The columns reach so many half-widths beside the contact.
OUTSIDE = 1.8
# On the surface there are so many more on either side, up to FAR half-widths.
FAR, FAR_COLUMNS = 1e3, 12
# The ratio of the depths of the scan.
RATIO = 1.45


class Mesh(NamedTuple):
    """Marks with their g, and columns of the scan with their distances from the next mark.

    The marks are among the columns; all are ascending.
    """

    marks: Array
    g: Array
    x: Array
    distance: Array

    @property
    def surface(self) -> Array:
        """The columns of the surface: these, and FAR_COLUMNS more on either side."""
        far = 0.5 * float(self.marks[-1] - self.marks[0]) * np.geomspace(OUTSIDE, FAR, FAR_COLUMNS)
        return np.concatenate((self.marks[0] - far[::-1], self.x, self.marks[-1] + far))

    def scale(self, x: Array) -> Array:
        """s(x) of the module."""
        left, right, k = _from_marks(self.marks, x)
        return np.minimum(left + self.g[k - 1], right + self.g[k])


def mesh_of(tractions: Tractions) -> Mesh:
    """The columns in which the stress of these tractions is scanned."""
    marks, singular = tractions.marks, tractions.singular
    r = 0.5 * float(marks[-1] - marks[0])
    if len(marks) > MANY_MARKS:  # those that resolve a cusp approach it over hundreds of octaves
        marks = np.unique(np.concatenate((thinned(marks, RESOLVED * r), singular, marks[-1:])))
    gaps = np.diff(marks)
    smaller = np.minimum(np.append(gaps, np.inf), np.insert(gaps, 0, np.inf))
    g = (NEAR if len(marks) <= MANY_MARKS else NEAR_OF_MANY) * smaller
    highest = singular[np.argsort(-tractions.pressure(singular), kind="stable")[:MOST_SINGULAR]]
    finest = FINEST * r + 8.0 * np.spacing(np.abs(marks).max())
    g[np.isin(marks, highest)] = finest
    # Next to a fine mark others are as fine as their distance from it
    from_left = np.minimum.accumulate(g - marks) + marks
    from_right = np.minimum.accumulate((g + marks)[::-1])[::-1] - marks
    g = np.minimum(g, np.maximum(np.minimum(from_left, from_right), g.min()))
    half = 0.5 * gaps
    # The extent of columns on both sides of a mark.
    left, right = np.append(half, OUTSIDE * r), np.insert(half, 0, OUTSIDE * r)
    (k, d), (j, e) = _graded(g, left), _graded(g, right)
    x = np.unique(np.concatenate((tractions.marks, marks[k] + d, marks[j] - e)))
    return Mesh(marks, g, x, np.minimum(*_from_marks(marks, x)[:2]))


def _from_marks(marks: Array, x: Array) -> tuple[Array, Array, NDArray[np.intp]]:
    """Distances of x from two marks k - 1 and k, one of which is the nearest."""
    k = np.clip(np.searchsorted(marks, x), 1, len(marks) - 1)
    return np.abs(x - marks[k - 1]), np.abs(x - marks[k]), k


def _graded(g: Array, until: Array) -> tuple[NDArray[np.intp], Array]:
    """(marks, distances) of the columns beside them; cells grow like the distance plus g."""
    # At every depth the columns beside a mark then lie in the same directions from it.
    step = 0.5 * np.log(RATIO)
    count = np.ceil(np.log1p(until / g) / step).astype(np.intp)
    k = np.repeat(np.arange(len(g)), count)
    i = np.arange(len(k)) - np.repeat(np.cumsum(count) - count, count)
    d = g[k] * np.expm1((i + 0.47) * step)
    inside = d < until[k]  # none of two columns midway between marks
    return k[inside], d[inside]


def thinned(x: Array, spacing: float) -> Array:
    """A subset of x (ascending) with one of every cell of that width.

    The number of columns then depends on the depth.
    """
    cell = np.floor((x - x[:1]) / spacing)
    return x[np.append(np.ones(min(len(x), 1), dtype=bool), cell[1:] != cell[:-1])]
