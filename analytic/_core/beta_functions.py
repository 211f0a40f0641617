"""Incomplete beta functions of the edge exponents, to full relative accuracy.

The sliding rounded flat needs them.

With 0 < alpha < 1, the exponent of p at an edge being 1 - alpha there,

    phi(y) = (alpha/y^alpha) ∫_0^y s^(alpha-1)/(1-s) ds = sum_n alpha y^n/(alpha+n)
           = 2F1(1, alpha; 1+alpha; y)
    A      = (1+V) phi(-V) - 1 = sum_n n! Y^n/(1+alpha)_n,  n >= 1,  Y = V/(1+V)
    B(y)   = 1 - (1-y) phi(y)  = sum_n alpha y^n/((alpha+n-1)(alpha+n)),  n >= 1

for 0 <= y <= 1 and 0 <= Y < 1. All terms are positive. For alpha = 1/2 they are the functions of
`arc_functions`.
"""

import math

from analytic._core.numbers import Library, Number, bits, fraction, most
from analytic._core.piecewise import pick

# Below this y the closed form of B loses more than three bits, and its series, three bits a term,
# takes over.
SMALL = 1 / 8
# From here to y = 1 the expansion about y = 1 takes over, which gains 1.3 bits a term there. Below,
# the map y = 4 w/(1+w)² leaves w <= 0.226, 2.1 bits a term.
NEAR_ONE = 0.6
BITS_A_TERM_NEAR_ONE = 1.3
BITS_A_TERM_BELOW = 2.1


def A(lib: Library, alpha: Number, Y: Number) -> Number:
    """A of Y = V/(1+V)."""
    term = Y / (1 + alpha)
    total = 0 * term
    for n in range(2, _terms(lib, Y) + 2):
        total = total + term
        term = term * Y * (n / (n + alpha))
    return total + term


def B(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    """B(y), given c = 1 - y; B(1) = 1."""
    return pick(lib, y < SMALL, _B_series, _B_closed, alpha, y, c)


def phi(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    """phi(y) for 0 <= y < 1, given c = 1 - y."""
    return pick(lib, y < NEAR_ONE, _phi_below, _phi_near_one, alpha, y, c)


def rim_moment(
    lib: Library, n: int, alpha: Number, rim: Number, length: Number
) -> tuple[Number, Number]:
    """The moment F = ∫_0^d (d-r)^n r^(alpha-1) (L-r)^(-alpha) dr and how it grows with the rim.

    d is the rim and L > d the length. The second number is the change of ln F with ln d at fixed
    d/r and L/r, less alpha + n: Y F'/F in d^(n+alpha) L^(-alpha) B(alpha, n+1) F(Y), F = 2F1(alpha,
    alpha; alpha+n+1; Y).
    """
    Y = rim / length
    total, weighted, term = 1 + 0 * Y, 0 * Y, 1 + 0 * Y
    for k in range(_terms(lib, Y) + 2):
        term = term * Y * ((alpha + k) / (alpha + n + 1 + k)) * ((alpha + k) / (k + 1))
        total = total + term
        weighted = weighted + (k + 1) * term
    beta = fraction(math.factorial(n), 1, lib)  # B(alpha, n+1) = n!/(alpha (alpha+1) ... (alpha+n))
    for k in range(n + 1):
        beta = beta / (alpha + k)
    return beta * rim**n * (rim / length) ** alpha * total, weighted / total


def _terms(lib: Library, Y: Number) -> int:
    """How many terms, each less than Y times the one before, are enough."""
    largest = float(most(Y, lib))
    return int(bits(lib) / -math.log2(largest)) if largest > 0 else 1


def _B_series(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    total, power = 0 * y, y
    for n in range(1, bits(lib) // 3 + 3):
        total = total + alpha / ((alpha + n - 1) * (alpha + n)) * power
        power = power * y
    return total


def _B_closed(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    return pick(lib, c > 0, _B_below_one, _one, alpha, y, c)


def _B_below_one(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    return 1 - c * phi(lib, alpha, y, c)


def _one(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    return 1 + 0 * y


def _phi_below(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    """phi = (1+w)^(2 alpha) sum_n alpha e_n w^n/(n + alpha).

    The e_n are those of sum_n e_n w^n = (1+w)^(1-2 alpha)/(1-w).
    """
    root = lib.sqrt(c)
    w = (1 - root) / (1 + root)
    binomial, e, power = 1 + 0 * alpha, 1 + 0 * alpha, 1 + 0 * w
    total = power * 1
    for n in range(1, int(bits(lib) / BITS_A_TERM_BELOW) + 3):
        binomial = binomial * ((2 - 2 * alpha - n) / n)
        e, power = e + binomial, power * w
        total = total + alpha / (n + alpha) * e * power
    return (1 + w) ** (2 * alpha) * total


def _phi_near_one(lib: Library, alpha: Number, y: Number, c: Number) -> Number:
    """From ∫_0^y = ∫_0^e + ∫_e^y, the last with s^(alpha-1) as a binomial series of 1 - s."""
    end = 1 - fraction(3, 5, lib) + 0 * alpha
    start = 1 - end
    whole = _phi_below(lib, alpha, start, end) * start**alpha / alpha
    rest = lib.log(end / c) + _difference(lib, alpha, end, c)
    return alpha * (whole + rest) / y**alpha


def _difference(lib: Library, alpha: Number, end: Number, c: Number) -> Number:
    """sum_n (1-alpha)_n/n! (end^n - c^n)/n."""
    total, coefficient, first, second = 0 * c, 1 + 0 * alpha, 1 + 0 * end, 1 + 0 * c
    for n in range(1, int(bits(lib) / BITS_A_TERM_NEAR_ONE) + 3):
        coefficient = coefficient * ((n - alpha) / n)
        first, second = first * end, second * c
        total = total + coefficient * (first - second) / n
    return total
