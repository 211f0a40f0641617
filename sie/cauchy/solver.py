"""Gauss-Chebyshev and Gauss-Jacobi collocation for Cauchy singular integral equations.

    a φ(x) + b/π PV∫ φ(t)/(t - x) dt + ∫ k(x, t) φ(t) dt = g(x) + Σ d_j u_j(x)
    with side conditions  ∫ φ x^power dx = value

On [-1, 1] the density is sought as φ = w Σ c_n p_n, w = (1-s)^α (1+s)^β with the exponents that a
and b determine and p_n orthonormal for w. The singular part maps p_n to one constant times
p̃_{n-κ}, orthonormal for 1/w (`jacobi`), κ = -(α + β) the index. So the matrix for c is the
identity, shifted by κ places, plus the coefficients of the smooth part. Side conditions are the
equations that κ = 1 lacks, and a free constant u_j is the unknown that κ = -1 lacks.

Without k on one interval nothing is solved: c is a transform of g, for a = 0 a DCT (`transform`).
Otherwise the matrix is square, and about as well conditioned as the identity plus k (`system`). The
sizes grow until coefficients have decayed, the residual is small at points that were not used, and
the kernel's own coefficients show that its integrals are resolved. k is called once for each size.

Sources: Erdogan & Gupta, Q. Appl. Math. 29 (1972); Erdogan, Gupta & Cook (1973); Elliott, SIAM J.
Numer. Anal. 19 (1982), for the weighted spaces in which the condition number stays bounded; Kelley
& Xue, SIAM J. Sci. Comput. 17 (1996), for GMRES on equations of the second kind.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev

from .attempt import DECAYED, Attempt
from .density import JacobiDensity
from .formulation import Problem
from .system import System
from .transform import by_transform

ENLARGED = 1.45  # from one attempt to the next: the total cost is less than twice the least
# Unknowns with which a system gives up, ...
LARGEST = 6000
# ... a transform by a discrete cosine transform, ...
LARGEST_TRANSFORM = 200_000
# ... and one by Gauss-Jacobi quadrature, which takes n² operations and numbers, ...
LARGEST_RULE = 4000
# ... or n³ operations with complex exponents.
LARGEST_COMPLEX_RULE = 1500
# an exponent within this of -1 has fewer digits left than the tolerance needs
NEAR_MINUS_ONE = 1e-6
LARGEST_GUESS = 1000  # the first size as estimated from g alone
# After IDLE enlargements without progress an error below SETTLED is noise of g or k.
IDLE = 3
SETTLED = 1e-6
# Points where g is compared with its series, and the least difference, over the largest g, that is
# called rough.
SCANNED, ROUGH = 2049, 1e-11
# Once ENOUGH_SEEN unknowns and FEWEST_SEEN attempts are reached, the errors from FIRST_SEEN
# unknowns on show whether they fall like a power of n between KINK, as those of kinks and of weak
# singularities do. It is given up where the largest size would miss the tolerance by HOPELESS, and
# MARGIN times what it would reach is offered.
FIRST_SEEN = 60
ENOUGH_SEEN = 800
FEWEST_SEEN = 5
KINK = (0.5, 4.0)
HOPELESS, MARGIN = 32.0, 4.0
# A right-hand side that is inconsistent by more than this fraction is refused.
INCONSISTENT = 1e-9


def solve(problem: Problem, tol: float) -> JacobiDensity:
    """The density with as many nodes as tol needs.

    Raises ContactError with the best `density` if it does not settle.
    """
    sizes, idle = _first_sizes(problem, tol), 0
    best: Attempt | None = None
    seen: list[tuple[int, float]] = []
    while True:
        tried = attempt(problem, sizes)
        more = tried.unresolved(tol)
        if not more.any():
            return consistent(tried)
        if best is None or tried.progress < 0.5 * best.progress:
            best, idle = tried, 0
        else:
            idle += 1
        seen.append((sum(sizes), tried.progress))
        reachable = _reachable(seen, _largest(problem))
        hopeless = reachable > HOPELESS * tol
        sizes = _enlarged(sizes, more)
        if sum(sizes) > _largest(problem) or (idle >= IDLE and best.progress < SETTLED) or hopeless:
            reached = best.answer()
            # A system's sizes are few: what lies between them cannot be promised.
            offered = MARGIN * reachable if hopeless and problem.is_transform else best.progress
            raise ContactError(
                f"the density did not settle to tol = {tol:.1e}: with n = {reached.n} nodes its "
                f"estimated error is {reached.error:.1e}; " + _reason(problem, offered),
                density=reached,
            )


def _largest(problem: Problem) -> int:
    if not problem.is_transform:
        return LARGEST
    (weight,) = problem.weights
    if weight.is_chebyshev:
        return LARGEST_TRANSFORM
    return LARGEST_RULE if weight.is_real else LARGEST_COMPLEX_RULE


def _reachable(seen: list[tuple[int, float]], largest: int) -> float:
    """The error that the largest size would leave if errors fall like a power of n; otherwise 0.

    They do where g or k has a kink or is singular, from the first sizes on. For a function that is
    only narrow they are constant until n resolves it, and then fall faster than any power.
    """
    n, progress = np.array([(n, error) for n, error in seen if n >= FIRST_SEEN]).reshape(-1, 2).T
    if len(n) < FEWEST_SEEN or n[-1] < ENOUGH_SEEN:
        return 0.0
    order = -float(np.polyfit(np.log(n), np.log(progress), 1)[0])
    if not KINK[0] <= order <= KINK[1]:
        return 0.0
    return float(progress.min() * (n[-1] / largest) ** order)


def _reason(problem: Problem, progress: float) -> str:
    """The reason why a density may not settle, and the remedy."""
    # Coefficients have to decay to this part of tol; it is printed to two digits.
    enough = 1.1 * progress / DECAYED
    remedy = f"raise tol to {enough:.1e}" if enough < 1.0 else "smooth them"
    for weight in problem.weights:
        left = abs(
            (abs(weight.alpha.real) - 1.0)
            + math.copysign(1.0, weight.alpha.real) * weight.tail.real
        )
        if weight.kappa == 0 and left < NEAR_MINUS_ONE:
            return (
                f"the exponent at a singular end is -1 but for {left:.1e}, so that next to all of "
                f"φ stands at that end: {remedy}, or make that end bounded and the other singular"
            )
    place = _roughest(problem)
    if place is None:
        return f"g or k is noisy or not smooth: {remedy}"
    return (
        f"g is noisy or not smooth near x = {place:.6g}: {remedy}, or smooth it there; a contact's "
        "slope h' may have breaks there, which are exact (sie.FromFunction, sie.Piecewise)"
    )


def _roughest(problem: Problem) -> float | None:
    """Where g is farthest from a half of its Chebyshev series; None if that is near everywhere."""
    if not callable(problem.g):
        return None
    s = chebyshev.points(SCANNED)
    place, worst = None, 0.0
    for interval in problem.maps:
        x = interval.x1 + 0.5 * (interval.x2 - interval.x1) * (1.0 + s)
        values = np.real(np.broadcast_to(problem.g(x), x.shape))
        coefficients = chebyshev.transform(values)
        coefficients[SCANNED // 2 :] = 0.0
        missed = np.abs(values - chebyshev.evaluate(coefficients, s))
        if missed.max() > max(worst, ROUGH * np.abs(values).max()):
            place, worst = float(x[missed.argmax()]), float(missed.max())
    return place


def _first_sizes(problem: Problem, tol: float) -> tuple[int, ...]:
    """The number of nodes that g needs without the kernel, by transforms of one interval."""
    sizes, free_of_kernel = problem.first_sizes(), replace(problem, k=None)
    if problem.is_transform or not free_of_kernel.is_transform:
        return sizes
    tried = sizes
    while sum(tried) <= LARGEST_GUESS:
        more = attempt(free_of_kernel, tried).unresolved(tol)
        if not more.any():
            return tried
        tried = _enlarged(tried, more)
    return sizes


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
    if problem.is_transform:
        return by_transform(problem, sizes[0])
    system = System(problem, sizes)
    return system.attempt(system.solution())
