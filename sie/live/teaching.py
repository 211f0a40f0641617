"""Gauss-Chebyshev quadrature of Cauchy singular integral equations, as textbooks have it.

The method in its smallest form, to read and to compare with: nothing in the package uses it. The
equation is that of a half-plane on the interval (-1, 1),

    1/π PV∫ φ(t)/(x - t) dt = g(x),      φ(t) = v(t) u(t),

v(t) is the weight of the index, u is smooth. With the nodes t_k and the points x_j below the sum
Σ w_k u(t_k)/(x_j - t_k) is the integral, exactly, for polynomials u of degree at most 2n.

    index   v(t)                     ends       equations
      1     1/sqrt(1 - t²)           singular   n - 1, and the total of φ
      0     sqrt((1 - t)/(1 + t))    bounded at 1, singular at -1    n
     -1     sqrt(1 - t²)             bounded    n + 1, and a constant more is unknown

docs/explanation/gauss_chebyshev.md derives it. `sie.CauchyEquation` is the general solver.

References
----------
Erdogan & Gupta (1972); Erdogan, Gupta & Cook (1973); Ioakimidis & Theocaris (1977).
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

WEIGHTS: dict[int, Callable[[Array], Array]] = {
    1: lambda t: 1.0 / np.sqrt(1.0 - t * t),
    0: lambda t: np.sqrt((1.0 - t) / (1.0 + t)),
    -1: lambda t: np.sqrt(1.0 - t * t),
}


def rule(n: int, index: int) -> tuple[Array, Array, Array]:
    """Nodes t, weights w and collocation points x of a rule with n nodes.

    Parameters
    ----------
    n : int
        How many nodes, at least 2.
    index : {1, 0, -1}
        1: both ends singular; 0: bounded at 1 alone; -1: both ends bounded.

    Returns
    -------
    t, w : ndarray of shape (n,)
        ∫ v u dt = Σ w_k u(t_k), exactly for polynomials of degree less than 2n.
    x : ndarray of shape (n - index,)
        Where the sum of the singular integral is as exact.

    Examples
    --------
    >>> from sie import teaching
    >>> t, w, x = teaching.rule(3, index=1)
    >>> round(float(w.sum()), 12), x.round(12).tolist()
    (3.14159265359, [0.5, -0.5])
    """
    if n < 2 or index not in WEIGHTS:
        raise ValueError(f"n = {n}, index = {index}: give n >= 2 and an index 1, 0 or -1")
    k, j = np.arange(1, n + 1), np.arange(1, n - index + 1)
    if index == 1:
        return np.cos((2 * k - 1) * np.pi / (2 * n)), np.full(n, np.pi / n), np.cos(j * np.pi / n)
    if index == -1:
        t = np.cos(k * np.pi / (n + 1))
        x = np.cos((2 * j - 1) * np.pi / (2 * n + 2))
        return t, np.pi * (1 - t * t) / (n + 1), x
    t = np.cos(2 * k * np.pi / (2 * n + 1))
    x = np.cos((2 * j - 1) * np.pi / (2 * n + 1))
    return t, 2 * np.pi * (1 - t) / (2 * n + 1), x


def solve(
    g: Callable[[Array], Any], n: int, index: int, total: float = 0.0
) -> tuple[Array, Array, float]:
    """Solve 1/π PV∫ φ(t)/(x - t) dt = g(x) on (-1, 1) with n nodes.

    Parameters
    ----------
    g : callable
        The right-hand side, a function of an array x.
    n : int
        How many nodes.
    index : {1, 0, -1}
        As for `rule`.
    total : float
        ∫φ dt, for index 1.

    Returns
    -------
    t : ndarray of shape (n,)
        The nodes.
    phi : ndarray of shape (n,)
        φ there.
    misfit : float
        The constant c that index -1 needs: what is solved is H φ = g - c, and the equation has a
        solution of its own only if c = 0. In a contact the edges are right where it is 0.

    Examples
    --------
    A parabola of h' = x, E* = 2, pressed until the contact is (-1, 1): p = sqrt(1 - x²).

    >>> import numpy as np
    >>> from sie import teaching
    >>> t, p, misfit = teaching.solve(lambda x: x, n=8, index=-1)
    >>> bool(np.allclose(p, np.sqrt(1 - t * t))), abs(misfit) < 1e-15
    (True, True)
    """
    t, w, x = rule(n, index)
    matrix = w / (np.pi * (x[:, None] - t))
    rhs = np.broadcast_to(np.asarray(g(x), dtype=float), x.shape)
    misfit = 0.0
    if index == 1:
        u = np.linalg.solve(np.vstack([matrix, w]), np.append(rhs, total))
    elif index == 0:
        u = np.linalg.solve(matrix, rhs)
    else:
        found = np.linalg.solve(np.column_stack([matrix, np.ones(n + 1)]), rhs)
        u, misfit = found[:-1], float(found[-1])
    return t, WEIGHTS[index](t) * u, misfit
