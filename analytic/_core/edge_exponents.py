"""The powers by which tractions between dissimilar bodies rise from the edges of their contact.

The equations of dissimilar bodies lead, on a contact [-b, b], to functions of the plane that are
cut there,

    X(z) = sqrt(z² - b²) ((z+b)/(z-b))^eps = S exp(2 eps t),      t = artanh(b/z),

with limits from above and below whose ratio is -exp(-2 pi i eps). In full sliding eps is real,
tan(pi eps) = -beta f (Hills, Nowell & Sackfield 1993); bonded, it is i eta with tanh(pi eta) =
beta. The bounded solutions are made of X, the singular ones of Y = exp(2 eps t)/S.
"""

from analytic._core.cut import root
from analytic._core.numbers import Library, Number, bits
from analytic._core.piecewise import pick

# Below this |rho|² functions that decay are summed as series in rho, three bits a term.
SMALL_SQUARE = 1 / 8
BITS_A_TERM = 3


def sliding_exponent(lib: Library, coupling: Number) -> Number:
    """eps of full sliding, between -1/2 and 1/2."""
    return -lib.atan(coupling) / lib.pi


def cosine(lib: Library, coupling: Number) -> Number:
    """cos(pi eps) = 1/sqrt(1 + (beta f)²)."""
    return 1 / lib.sqrt(1 + coupling * coupling)


def bounded_weight(lib: Library, near: Number, far: Number, eps: Number) -> Number:
    """near^(1/2-eps) far^(1/2+eps) of the distances > 0 from the right and from the left edge."""
    return lib.sqrt(near) * lib.sqrt(far) * (far / near) ** eps


def inverse_tangent(lib: Library, z: Number, b: Number) -> Number:
    """t = artanh(b/z) off the cut, to full relative accuracy next to ±b and far away."""
    return pick(lib, abs(z) > 2 * b, _from_quotient, _from_distances, z, b)


def bounded_remainder(lib: Library, z: Number, b: Number, eps: Number) -> Number:
    """z + 2 eps b - X(z), which decays, for z off the cut."""
    rho = b / (z + root(lib, z, b))
    return pick(
        lib, abs(rho) * abs(rho) < SMALL_SQUARE, _bounded_far, _bounded_near, z, b, eps, rho
    )


def singular_remainder(lib: Library, z: Number, b: Number, eps: Number) -> Number:
    """z Y(z) - 1 - 2 eps b Y(z), which decays like 1/z², for z off the cut."""
    S, t = root(lib, z, b), inverse_tangent(lib, z, b)
    growth = lib.expm1(2 * eps * t)
    return (b / (z + S) + (z / b) * growth - 2 * eps * (1 + growth)) * (b / S)


def singular(lib: Library, z: Number, b: Number, eps: Number) -> Number:
    """Y(z) for z off the cut."""
    return lib.exp(2 * eps * inverse_tangent(lib, z, b)) / root(lib, z, b)


def _from_quotient(lib: Library, z: Number, b: Number) -> Number:
    return lib.atanh(b / z)


def _from_distances(lib: Library, z: Number, b: Number) -> Number:
    return lib.log((z + b) / (z - b)) / 2


def _bounded_near(lib: Library, z: Number, b: Number, eps: Number, rho: Number) -> Number:
    return z + 2 * eps * b - root(lib, z, b) * lib.exp(2 * eps * inverse_tangent(lib, z, b))


def _bounded_far(lib: Library, z: Number, b: Number, eps: Number, rho: Number) -> Number:
    """2 rho X/b = (1 - rho²) ((1+rho)/(1-rho))^(2 eps) as the series sum_n y_n rho^n.

    The coefficients obey (n+1) y_(n+1) = 4 eps y_n + (n-3) y_(n-1).
    """
    before, now = 4 * eps, 8 * eps * eps - 1
    total, power = (1 - now) + 0 * rho, rho * 1
    for n in range(2, bits(lib) * 2 // BITS_A_TERM + 4):
        before, now = now, (4 * eps * now + (n - 3) * before) / (n + 1)
        total = total - now * power
        power = power * rho
    return b * rho * total / 2
