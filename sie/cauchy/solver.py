"""Gauss-Chebyshev and Gauss-Jacobi collocation for Cauchy singular integral equations.

    a φ(x) + b/π PV∫ φ(t)/(t - x) dt + ∫ k(x, t) φ(t) dt = g(x) + Σ d_j u_j(x)
    with side conditions  ∫ φ x^power dx = value

On [-1, 1] the density is sought as φ = w Σ c_n p_n, w = (1-s)^α (1+s)^β with the exponents that a
and b determine and p_n orthonormal for w. The singular part maps p_n to one constant times
p̃_{n-κ}, orthonormal for 1/w (`jacobi`), κ = -(α + β) the index. So the matrix for c is the
identity, shifted by κ places, plus the coefficients of the smooth part. Side conditions are the
equations that κ = 1 lacks, and a free constant u_j is the unknown that κ = -1 lacks.

The matrix is square, and about as well conditioned as the identity plus k (`system`). The sizes
grow until coefficients have decayed, the residual is small at points that were not used, and
the kernel's own coefficients show that its integrals are resolved. k is called once for each size.

Sources: Erdogan & Gupta, Q. Appl. Math. 29 (1972); Erdogan, Gupta & Cook (1973); Elliott, SIAM J.
Numer. Anal. 19 (1982), for the weighted spaces in which the condition number stays bounded.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError

from .attempt import DECAYED, Attempt
from .density import JacobiDensity
from .formulation import Problem
from .system import System

ENLARGED = 1.45  # from one attempt to the next: the total cost is less than twice the least
LARGEST = 2000  # unknowns
# After IDLE enlargements without progress an error below SETTLED is noise of g or k.
IDLE = 3
SETTLED = 1e-6
# A right-hand side that is inconsistent by more than this fraction is refused.
INCONSISTENT = 1e-9


def solve(problem: Problem, tol: float) -> JacobiDensity:
    """The density with as many nodes as tol needs.

    Raises ContactError with the best `density` if it does not settle.
    """
    sizes, idle = problem.first_sizes(), 0
    best: Attempt | None = None
    while True:
        tried = attempt(problem, sizes)
        more = tried.unresolved(tol)
        if not more.any():
            return consistent(tried)
        if best is None or tried.progress < 0.5 * best.progress:
            best, idle = tried, 0
        else:
            idle += 1
        sizes = _enlarged(sizes, more)
        if sum(sizes) > LARGEST or (idle >= IDLE and best.progress < SETTLED):
            raise _unsettled(best, tol)


def _unsettled(best: Attempt, tol: float) -> ContactError:
    reached = best.answer()
    # Coefficients have to decay to this part of tol; it is printed to two digits.
    enough = 1.1 * best.progress / DECAYED
    remedy = f"raise tol to {enough:.1e}" if enough < 1.0 else "smooth them"
    return ContactError(
        f"the density did not settle to tol = {tol:.1e}: with n = {reached.n} nodes its "
        f"estimated error is {reached.error:.1e}; g or k is noisy or not smooth: {remedy}; a "
        "contact's slope h' may have breaks, which are exact (sie.FromFunction, sie.Piecewise)",
        density=reached,
    )


def _enlarged(sizes: tuple[int, ...], more: NDArray[np.bool_]) -> tuple[int, ...]:
    return tuple(
        int(np.ceil(ENLARGED * n)) if grows else n for n, grows in zip(sizes, more, strict=True)
    )


def consistent(found: Attempt) -> JacobiDensity:
    """The density of an attempt. ContactError if no solution meets the right-hand side."""
    if found.defect > INCONSISTENT:
        raise ContactError(
            "the right-hand side is not consistent: bounded ends ask for an integral of g that "
            f"vanishes, and it misses a constant of {found.defect:.1e} times g; free a constant, "
            "or let an end be singular",
            density=found.answer(),
        )
    return found.answer()


def attempt(problem: Problem, sizes: tuple[int, ...]) -> Attempt:
    """The density with so many nodes on each interval."""
    system = System(problem, sizes)
    return system.attempt(system.solution())
