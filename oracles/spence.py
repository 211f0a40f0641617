"""Dissimilar bodies pressed with friction, on a grid: the printed equations (1) and (12), step by
step. It shares nothing with the solver that it checks.

Under a symmetric profile p is even and q odd, so that with constant tractions on cells of x > 0 the
equations, integrated once from the axis, are for β > 0

    1/π ∫_0^b p ln|(x - t)(x + t)| dt - β ∫_0^x q dt = E*/2 h(x) + constant   in contact,
    E*/2 g(x) = 1/π ∫_0^b q ln|(x - t)/(x + t)| dt + β ∫_0^x p dt.

The contact grows cell by cell. In each step a cell either sticks, and g stays as it was, or slips
outwards with q = f p; an active set finds which. The error is of the first order in the cells.

Under a profile that is not symmetric the contact is not symmetric either. Both of its edges are
given then while it grows, and P and Q are found: p is 0 in the cells beside.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]

MOST = 200

# 1 - c/b of the flat punch by (β, f): the root of sqrt(1 - β²) = c^θ λ/π, λ by Gauss and double
# exponential rules and inverse iteration in mpmath, 40 digits
SLIP_WIDTHS = {
    (0.3, 0.3): 0.35421258761338148174,
    (0.5, 10.0): 5.1092024078689408638e-3,
    (0.2, 0.9): 1.0313681741733389429e-4,
    (0.03, 0.15): 1.3637928921890105363e-6,
    (0.2, 10.0): 2.2316848698699787780e-9,
    (0.15, 3.0): 5.4253521895273463134e-11,
    (0.001, 0.01): 1.8188129391499430993e-13,
    (0.1, 2.0): 7.8512691804240188278e-15,
    (0.05, 0.65): 1.5696170669776995222e-15,
}


class GridContact(NamedTuple):
    """The state under the last load: midpoints, p and q there, and which cells stick."""

    x: Array
    pressure: Array
    shear: Array
    sticks: NDArray[np.bool_]
    load: float

    @property
    def stick_ratio(self) -> float:
        """c/b."""
        return float(self.sticks.sum()) / len(self.x)


class Grid:
    """n cells on 0 < x < b, and the integrals of constants over them."""

    def __init__(self, b: float, n: int, beta: float, friction: float) -> None:
        self.h, self.beta, self.friction = b / n, beta, friction
        self.x = (np.arange(n) + 0.5) * self.h

        def primitive(s: Array) -> Array:  # ∫ ln|s| ds
            values: Array = s * np.log(np.abs(s) / b) - s
            return values

        at, t = self.x[:, None], self.x
        near = primitive(at - t + 0.5 * self.h) - primitive(at - t - 0.5 * self.h)
        far = primitive(at + t + 0.5 * self.h) - primitive(at + t - 0.5 * self.h)
        self.even, self.odd = (near + far) / np.pi, (near - far) / np.pi
        # The integral from the axis to a midpoint has half of the cell itself
        self.sum = self.h * (np.tri(n, k=-1) + 0.5 * np.eye(n))

    def step(
        self, rise: Array, slip: Array, sticks: NDArray[np.bool_]
    ) -> tuple[Array, Array, NDArray[np.bool_]]:
        """p, q and which cells stick, where the surfaces touch in as many cells.

        rise      E*/2 h in these cells and the next, where p is 0; of as many: a flat, P = 1
        slip      E*/2 g before the step
        sticks    a guess
        """
        m = len(sticks)
        rows = len(rise)
        for _ in range(MOST):
            matrix, right = np.zeros((2 * m + 1, 2 * m + 1)), np.zeros(2 * m + 1)
            matrix[:rows, :m] = self.even[:rows, :m]
            matrix[:rows, m : 2 * m] = -self.beta * self.sum[:rows, :m]
            matrix[:rows, -1], right[:rows] = -1.0, rise
            if rows == m:
                matrix[m, :m], right[m] = 2.0 * self.h, 1.0
            stuck, slipping = np.flatnonzero(sticks), np.flatnonzero(~sticks)
            below = m + 1
            matrix[below + stuck, :m] = self.beta * self.sum[stuck, :m]
            matrix[below + stuck, m : 2 * m] = self.odd[stuck, :m]
            right[below + stuck] = slip[stuck]
            matrix[below + slipping, m + slipping] = 1.0
            matrix[below + slipping, slipping] = -self.friction
            found = np.linalg.solve(matrix, right)
            p, q = found[:m], found[m : 2 * m]
            moved = self.odd[:m, :m] @ q + self.beta * (self.sum[:m, :m] @ p) - slip[:m]
            out = sticks & (q > self.friction * p)
            back = ~sticks & (moved < 0.0)
            if not out.any() and not back.any():
                return p, q, sticks
            sticks = (sticks & ~out) | back
        raise AssertionError("the active set does not settle")

    def slip(self, p: Array, q: Array) -> Array:
        """E*/2 g on all cells."""
        m = len(p)
        g: Array = self.odd[:, :m] @ q + self.beta * (self.sum[:, :m] @ p)
        return g


def flat_punch(n: int, beta: float, friction: float) -> GridContact:
    """A flat punch of half-width 1 under P = 1."""
    grid = Grid(1.0, n, beta, friction)
    p, q, sticks = grid.step(np.zeros(n), np.zeros(n), np.ones(n, dtype=bool))
    return GridContact(grid.x, p, q, sticks, 1.0)


def growing_contact(rise: Array, n: int, beta: float, friction: float, first: int) -> GridContact:
    """A profile with E*/2 h = rise at n + 1 midpoints of 0 < x < 1 + 1/n, pressed until b = 1.

    It is flat, or its contact is found in one step, on the first cells.
    """
    grid = Grid((n + 1) / n, n + 1, beta, friction)
    slip: Array = np.zeros(n + 1)
    sticks = np.ones(0, dtype=bool)
    p: Array = np.zeros(0)
    q: Array = np.zeros(0)
    for m in range(first, n + 1):
        guess = np.append(sticks, np.ones(m - len(sticks), dtype=bool))
        p, q, sticks = grid.step(rise[: m + 1], slip, guess)
        slip = grid.slip(p, q)
    return GridContact(grid.x[:n], p, q, sticks, 2.0 * grid.h * float(p.sum()))


class UnevenContact(NamedTuple):
    """The state under P and Q: midpoints, p and q there, which cells stick, and both loads."""

    x: Array
    pressure: Array
    shear: Array
    sticks: NDArray[np.bool_]
    loads: tuple[float, float]


def followed_contact(
    rise: Callable[[Array], Array], ends: Array, material: tuple[float, float]
) -> UnevenContact:
    """A profile pressed until its contact has all but the outermost of 2 n + 2 cells.

    In each of n steps it gains one on either side.

    rise        E*/2 h
    ends        of the cells, ascending
    material    β and f
    """
    (beta, friction), n = material, (len(ends) - 3) // 2
    x, width = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)

    def primitive(s: Array) -> Array:  # ∫ ln|s| ds
        values: Array = s * np.log(np.abs(s)) - s
        return values

    log = (primitive(x[:, None] - ends[:-1]) - primitive(x[:, None] - ends[1:])) / np.pi
    total = (np.tri(len(x), k=-1) + 0.5 * np.eye(len(x))) * width
    height, slip, signs = rise(x), np.zeros(len(x)), np.zeros(len(x))
    for m in range(2, n + 1):
        c, wide = np.arange(n + 1 - m, n + 1 + m), np.arange(n - m, n + 2 + m)
        for _ in range(MOST):
            matrix, right = np.zeros((4 * m + 2, 4 * m + 2)), np.zeros(4 * m + 2)
            rows = 2 * m + 2  # of (1), where p and q of these cells are unknown, and two constants
            matrix[:rows, : 2 * m], right[:rows] = log[np.ix_(wide, c)], height[wide]
            matrix[:rows, 2 * m : 4 * m] = -beta * total[np.ix_(wide, c)]
            matrix[:rows, -2] = -1.0
            stuck, slipping = np.flatnonzero(signs[c] == 0.0), np.flatnonzero(signs[c])
            at = rows + stuck
            matrix[at, : 2 * m] = beta * total[np.ix_(c[stuck], c)]
            matrix[at, 2 * m : 4 * m] = log[np.ix_(c[stuck], c)]
            matrix[at, -1], right[at] = -1.0, slip[c[stuck]]
            matrix[rows + slipping, 2 * m + slipping] = 1.0
            matrix[rows + slipping, slipping] = -friction * signs[c[slipping]]
            found = np.linalg.solve(matrix, right)
            p, q = found[: 2 * m], found[2 * m : 4 * m]
            now = log[:, c] @ q + beta * (total[:, c] @ p)
            moved = (now - slip)[c] - found[-1]
            new = np.where((signs[c] == 0.0) & (np.abs(q) > friction * p), np.sign(q), signs[c])
            new[moved * signs[c] < 0.0] = 0.0
            if (new == signs[c]).all():
                break
            signs[c] = new
        else:
            raise AssertionError("the active set does not settle")
        slip = now
    return UnevenContact(x[c], p, q, signs[c] == 0.0, (float(width[c] @ p), float(width[c] @ q)))
