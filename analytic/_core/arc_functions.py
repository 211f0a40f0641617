"""The two functions of the rounded flat, and the logarithms in them, to full relative accuracy.

    A(y) = (1+y²) atan(y)/y - 1   = sum_k -2 (-y²)^k/(4k²-1)        0 <= y <= 1
    B(y) = 1 - (1-y²) artanh(y)/y = sum_k  2 y^(2k)/(4k²-1)  = -A(iy); 0 <= y <= 1, or complex

and atan(y)/y - 1, artanh(y)/y - 1. All are even, so that they are given y². Near y = 1 and near the
cut y > 1 of artanh the values depend on 1 - y², which the caller computes from lengths.
"""

from analytic._core.numbers import Library, Number, bits, fraction
from analytic._core.piecewise import pick

# Below this |y|² the closed forms lose more than three bits, and series take over. The power series
# gain three bits a term there. Halving the argument, artanh(y) = 2 artanh(y/(1 + sqrt(1-y²))),
# makes it five.
SMALL_SQUARE = 1 / 8
BITS_A_TERM = 3
BITS_A_TERM_HALVED = 5


def A(lib: Library, y2: Number) -> Number:
    """A(y) = (1+y²) atan(y)/y - 1 of y², real."""
    return pick(lib, y2 < SMALL_SQUARE, _A_series, _A_closed, y2)


def B(lib: Library, y2: Number, c: Number) -> Number:
    """B(y) = 1 - c artanh(y)/y of y² and c = 1 - y²; B(1) = 1."""
    return pick(lib, abs(y2) < SMALL_SQUARE, _B_series, _B_closed, y2, c)


def atan_excess(lib: Library, y2: Number) -> Number:
    """atan(y)/y - 1 of y², real."""
    return pick(lib, y2 < SMALL_SQUARE, _atan_series, _atan_closed, y2)


def artanh_excess(lib: Library, y2: Number, c: Number) -> Number:
    """artanh(y)/y - 1 of y² and c = 1 - y²; for y² > 1 the principal value, of c = |1 - y²|."""
    return pick(lib, abs(y2) < SMALL_SQUARE, _artanh_series, _artanh_closed, y2, c)


def _A_series(lib: Library, y2: Number) -> Number:
    return -_B_series(lib, -y2, 1 + y2)


def _A_closed(lib: Library, y2: Number) -> Number:
    y = lib.sqrt(y2)
    return (1 + y2) * lib.atan(y) / y - 1


def _B_series(lib: Library, y2: Number, c: Number) -> Number:
    """B = -(1 + sqrt(c))/2 sum_k 8 w^k/((2k-3)(2k-1)(2k+1)), w = y²/(1 + sqrt(c))²."""
    halved = 1 + lib.sqrt(c)
    w = y2 / (halved * halved)
    total = 0 * w
    for k in range(bits(lib) // BITS_A_TERM_HALVED, 0, -1):
        total -= fraction(4, (2 * k - 3) * (2 * k - 1) * (2 * k + 1), lib)
        total *= w
    return halved * total


def _B_closed(lib: Library, y2: Number, c: Number) -> Number:
    y = lib.sqrt(y2)
    # At c = 0 the product is 0 whatever the logarithm.
    return 1 - c * _artanh(lib, y, c + (c == 0)) / y


def _atan_series(lib: Library, y2: Number) -> Number:
    return _artanh_series(lib, -y2, 1 + y2)


def _atan_closed(lib: Library, y2: Number) -> Number:
    y = lib.sqrt(y2)
    return lib.atan(y) / y - 1


def _artanh_series(lib: Library, y2: Number, c: Number) -> Number:
    total = 0 * y2
    for k in range(bits(lib) // BITS_A_TERM + 1, 0, -1):
        total += fraction(1, 2 * k + 1, lib)
        total *= y2
    return total


def _artanh_closed(lib: Library, y2: Number, c: Number) -> Number:
    y = lib.sqrt(y2)
    return _artanh(lib, y, c) / y - 1


def _artanh(lib: Library, y: Number, c: Number) -> Number:
    """artanh(y) = ln((1+y)/sqrt(1-y²)): for Re y >= 0, where 1 + y does not cancel."""
    return lib.log((1 + y) / lib.sqrt(c))
