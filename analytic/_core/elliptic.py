"""Complete elliptic integrals by the arithmetic-geometric mean of Gauss.

The mean converges quadratically in any precision.

From a_0 > b_0, a_(n+1) = (a_n + b_n)/2, b_(n+1) = sqrt(a_n b_n), c_(n+1) = (a_n - b_n)/2, to their
common limit. With k'² = (b_0/a_0)² = 1 - k² (Borwein & Borwein, Pi and the AGM, 1987, chapter 1;
Abramowitz & Stegun 17.6)

    K = pi/(2 agm(1, k')),      (K - E)/K = k²/2 + sum_n 2^(n-1) c_n²,  n >= 1  (with a_0 = 1).
"""

from collections.abc import Iterator

from analytic._core.numbers import Library, Number, bits, everywhere


def means(lib: Library, a: Number, b: Number, c: Number) -> Iterator[tuple[Number, Number]]:
    """(a_n, c_n) for n = 1, 2, ... from a_1 = a, b_1 = b, c_1 = c.

    c may have more digits than (a_0 - b_0)/2.
    """
    small = 2.0 ** (-bits(lib) / 2 - 2)  # then the next c is below half a unit of a
    while True:
        yield a, c
        if everywhere(abs(c) <= small * a):
            return
        after = (a + b) / 2
        a, b, c = after, lib.sqrt(a) * lib.sqrt(b), c * c / (4 * after)


def agm(lib: Library, a: Number, b: Number) -> Number:
    """The arithmetic-geometric mean of a >= b > 0."""
    *_, (mean, c) = means(lib, (a + b) / 2, lib.sqrt(a) * lib.sqrt(b), (a - b) / 2)
    return mean - c * c / (4 * mean)  # half of the next step


def ratio_D(lib: Library, k: Number, kc: Number) -> Number:
    """D/K = (K - E)/(k² K), from 1/2 at k = 0 to 1 at k = 1; of k > 0 and k'."""
    total, weight = 1 + 0 * k, 2
    for _, c in means(lib, (1 + kc) / 2, lib.sqrt(kc), k * k / (2 * (1 + kc))):
        total = total + weight * (c / k) * (c / k)
        weight = 2 * weight
    return total / 2


def third_kind(lib: Library, kc: Number, p: Number) -> Number:
    """∫_0^(pi/2) sin²/((cos² + p sin²) sqrt(cos² + k'² sin²)) for p > 0.

    This is Bulirsch's cel(k', p, 0, 1) (Numer. Math. 13, 1969).
    """
    g, e, m = lib.sqrt(p), kc, 1
    q, a, b = kc, 0 * (kc * p), 1 / g
    while True:
        before, a, h = a, a + b / g, e / g
        b = 2 * (b + before * h)
        g, n, m = g + h, m, m + q
        if everywhere(abs(n - q) <= 2.0 ** (-bits(lib) / 2 - 2) * n):
            return lib.pi / 2 * (b + a * m) / (m * (m + g))
        q = 2 * lib.sqrt(e)
        e = q * m
