"""Dissimilar bodies pressed with friction: the stick zone, and the load under a power form.

While the load grows both bodies stick on |x| < c and slip outwards beside it, q = ± f p. Under
every symmetric convex form c/b is that of the flat punch, and the load under h = C |x|^m is (Spence
1975)

    P = E* C b^m/(2 M(m)).

Let k = c/b, theta = arctan(beta f)/pi, and on 0 < r < 1

    W(r) = r^(-1/2) (1-r)^(theta-1/2) (1 - k² r)^(1/2-theta),
    K v(s) = ∫ v(r) W(r) dr/(1 - k² r s).

K v is, but for a factor, the slope of the surface beside the contact under the pressure v(r) at
x = c sqrt(r), and K K v that pressure again. So v > 0 is the eigenfunction of K, and k makes
its eigenvalue lambda = pi sqrt(1 - beta²) k^-theta (derived in docs/derivations/coupled_slip.md of
the source distribution). With P = b = 1,

    k^(2 theta) ∫ W v dr = 1,    p(0) = k^-theta/(pi sqrt(1 - beta²)),
    M(m) = 1/(2 pi) ∫ s^(m/2-1) (1-s)^(theta-1/2) (1 - k² s)^(1/2-theta) k^(2 theta) K v(s) ds.

theta = 0 leaves lambda = pi for every k, so that the difference is computed: K is symmetric with
respect to W, and at theta = 0 has v = (1 - k² r)^(-1/2). With w = (r (1-r))^(-1/2)

    e = k^theta lambda/pi - 1 = ∫ w v ((k (1-r)/(1 - k² r))^theta - 1) dr / ∫ w v dr,
    -e (2 + e) = beta².

As friction grows k tends to 1, 1 - k <= 32 exp(-arctan(f)/eta) with tanh(pi eta) = beta. Where that
is below rounding the contact sticks all over: p(0) = 1/(pi sqrt(1 - beta²)) and

    M(m) = 1/pi ∫_0^∞ cos(2 eta v) tanh^(m-1) v / cosh v dv.

p(0) and M differ from these by parts of 1 - k.

All integrals are sums over r = 1/(1 + exp(-pi sinh t)) (Takahasi & Mori 1974), which keep 1 - r.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from analytic._core.documentation import documented
from analytic._core.numbers import Library, Number, as_result, bits, fraction
from analytic._core.parameters import positive, refuse
from analytic.goodman import SPENCE

POINTS = 0.15  # per bit and unit of t: as many as the singularity at 1/k² asks for
# of ln(k²/(1-k²)): narrower slip zones need more points than are worth it, and of a narrower stick
# zone products leave the range of doubles
LARGEST_STICK, LEAST_STICK = 39.0, -640.0
# 1 - k over exp(-arctan(f)/eta), tanh(pi eta) = beta, is 8 for small beta f and at most 31 (beta =
# 0.4, f = 1000)
MOST_SLIP = 32
NEAR = 1e-9  # in ln(k²/(1-k²)): its accuracy in doubles
SEARCHES, STEPS = 30, 20
SLIP = "the slip zones are narrower than {} of the contact; give friction nearer to dundurs."
STICK = "the stick zone is narrower than {} of the contact; give a larger friction."
ONE = "friction or dundurs is an array; give one number of each, for the stick zone is searched."


class _Flat(NamedTuple):
    """The flat punch: k² and 1 - k², beta² of this k, and on r the function W v dr.

    r, rest, weight     r, 1 - r and W dr
    v                   the eigenfunction
    """

    k2: Number
    complement: Number
    square: Number
    r: Number
    rest: Number
    weight: Number
    v: Number


@documented("c, a length", SPENCE)
def stick_half_width(
    *, half_width: Number, friction: Number, dundurs: Number, lib: Library = np
) -> Number:
    """The half-width of the stick zone, for single numbers friction and dundurs > 0.

    >>> round(float(stick_half_width(half_width=1.0, friction=0.3, dundurs=0.3)), 12)
    0.645787412387
    """
    b = positive("half_width", half_width, lib)
    if _bonded(friction, dundurs, lib):
        return as_result(b)
    flat, _ = _solved(friction, dundurs, lib)
    return as_result(b * lib.sqrt(flat.k2))


@documented("b - c, a length", SPENCE)
def slip_width(
    *, half_width: Number, friction: Number, dundurs: Number, lib: Library = np
) -> Number:
    """The width of either slip zone to relative accuracy, for single friction > 0 and dundurs > 0.

    >>> round(float(slip_width(half_width=1.0, friction=0.3, dundurs=0.3)), 12)
    0.354212587613
    """
    b, (flat, _) = positive("half_width", half_width, lib), _solved(friction, dundurs, lib)
    return as_result(b * flat.complement / (1 + lib.sqrt(flat.k2)))


@documented("p(0), a stress", SPENCE)
def flat_central_pressure(
    *, half_width: Number, normal_load: Number, friction: Number, dundurs: Number,
    lib: Library = np,
) -> Number:  # fmt: skip
    """The pressure in the middle of a flat punch, for single numbers friction and dundurs > 0.

    >>> args = {"half_width": 1.0, "normal_load": 1.0, "friction": 0.3, "dundurs": 0.3}
    >>> round(float(flat_central_pressure(**args)), 12)
    0.337874445206
    """
    b, P = positive("half_width", half_width, lib), positive("normal_load", normal_load, lib)
    narrowing = 1  # k^theta
    if not _bonded(friction, dundurs, lib):
        flat, theta = _solved(friction, dundurs, lib)
        narrowing = flat.k2 ** (theta / 2)
    beta = positive("dundurs", dundurs, lib)
    return as_result(P / (b * lib.pi * lib.sqrt((1 - beta) * (1 + beta)) * narrowing))


@documented("P, a force per length", SPENCE)
def load(
    *, half_width: Number, coefficient: Number, exponent: Number, modulus: Number,
    friction: Number, dundurs: Number, lib: Library = np,
) -> Number:  # fmt: skip
    """The load under h = C |x|^m, for single numbers friction and dundurs > 0.

    >>> args = {"coefficient": 0.5, "exponent": 2, "modulus": 1.0, "friction": 0.3, "dundurs": 0.3}
    >>> round(float(load(half_width=1.0, **args)), 11)
    0.82616167305
    """
    b, C = positive("half_width", half_width, lib), positive("coefficient", coefficient, lib)
    E, m = positive("modulus", modulus, lib), positive("exponent", exponent, lib)
    refuse(m < 1, "exponent = {} is less than 1; give at least 1, a convex form.", m)
    if _bonded(friction, dundurs, lib):
        return as_result(E * C * b**m / (2 * _bonded_moment(m, dundurs, lib)))
    flat, _ = _solved(friction, dundurs, lib)
    total = (flat.weight * flat.v).sum()
    # K v over k^(2 theta) ∫ W v dr; W(s) s^((m-1)/2) ds is the weight of M(m)
    Kv = (1 / _kernel(flat.r, flat.rest, flat.k2, flat.complement)) @ (flat.weight * flat.v) / total
    M = (flat.weight * flat.r ** ((m - 1) / 2) * Kv).sum() / (2 * lib.pi)
    return as_result(E * C * b**m / (2 * M))


def _bonded(friction: Number, dundurs: Number, lib: Library) -> bool:
    """Whether the slip zones are narrower than rounding of the half-width."""
    f, beta = positive("friction", friction, lib), positive("dundurs", dundurs, lib)
    refuse(np.ndim(f) + np.ndim(beta) > 0, ONE)
    eta = lib.log((1 + beta) / (1 - beta)) / (2 * lib.pi) if beta < 1 else 1
    widest = MOST_SLIP * lib.exp(-lib.atan(f) / eta)
    return bool(widest < fraction(1, 1, lib) / 2 ** bits(lib))


def _bonded_moment(m: Number, dundurs: Number, lib: Library) -> Number:
    """M(m) = 1/pi ∫ cos(2 eta v) tanh^(m-1) v / cosh v dv of a contact that sticks all over.

    v = exp(pi/2 sinh t): what is left out and the step err by rounding.
    """
    beta = positive("dundurs", dundurs, lib)
    eta = lib.log((1 + beta) / (1 - beta)) / (2 * lib.pi)
    end = lib.asinh(2 * lib.log(2) * (bits(lib) + 8) / lib.pi)
    count = int(12 * bits(lib) * float(end) / 53) + 1
    total = 0
    for j in range(-count, count + 1):
        t = end * j / count
        v = lib.exp(lib.pi / 2 * (lib.exp(t) - lib.exp(-t)) / 2)
        dv = lib.pi / 2 * (lib.exp(t) + lib.exp(-t)) / 2 * v * end / count
        secant = 2 * lib.exp(-v) / (1 + lib.exp(-2 * v))
        total = total + lib.cos(2 * eta * v) * lib.tanh(v) ** (m - 1) * secant * dv
    return total / lib.pi


def _solved(friction: Number, dundurs: Number, lib: Library) -> tuple[_Flat, Number]:
    """The flat punch of the pair, and theta."""
    f, beta = positive("friction", friction, lib), positive("dundurs", dundurs, lib)
    refuse(np.ndim(f) + np.ndim(beta) > 0, ONE)
    refuse(beta > 0.5, "dundurs = {} is more than 1/2; give Dundurs' constant of a pair.", beta)
    theta, square = lib.atan(beta * f) / lib.pi, beta * beta

    def miss(y: Number) -> tuple[Number, _Flat]:
        flat = _flat(y, theta, lib)
        return flat.square / square - 1, flat

    if lib is np:
        y = 0.0
        step = 1.0
    else:  # next to the answer in doubles
        near, _ = _solved(float(f), float(beta), np)
        y, step = lib.log(lib.mpf(near.k2) / lib.mpf(near.complement)), lib.mpf(NEAR)
    (low, at_low), (high, at_high) = _bracket(miss, y, step)
    last = 0
    for _ in range(SEARCHES):
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        value, flat = miss(middle)
        if abs(value) <= fraction(64, 1, lib) / 2 ** bits(lib) or middle in (low, high):
            break
        side = 1 if value > 0 else -1
        # Illinois: an end that stays for a second time counts half
        if side > 0:
            low, at_low, at_high = middle, value, at_high / (2 if last == side else 1)
        else:
            high, at_high, at_low = middle, value, at_low / (2 if last == side else 1)
        last = side
    return flat, theta


def _bracket(
    miss: Callable[[Number], tuple[Number, _Flat]], y: Number, step: Number
) -> tuple[tuple[Number, Number], tuple[Number, Number]]:
    """Places next to each other between which the miss, which falls with y, changes sign."""
    value = miss(y)[0]
    while True:
        ahead = min(y + step, LARGEST_STICK) if value > 0 else max(y - step, LEAST_STICK)
        refuse(ahead == y == LARGEST_STICK, SLIP, 1e-17)
        refuse(ahead == y == LEAST_STICK, STICK, 1e-139)
        other = miss(ahead)[0]
        if (other > 0) != (value > 0):
            ends = sorted([(y, value), (ahead, other)])
            return ends[0], ends[1]
        y, value, step = ahead, other, 2 * step


def _flat(y: Number, theta: Number, lib: Library) -> _Flat:
    """The flat punch whose stick zone has ln(k²/(1 - k²)) = y; it is that of another beta."""
    r, rest, w = _nodes(y, lib)
    each = np.vectorize(lib.log), np.vectorize(lib.expm1)
    log, expm1 = (np.log, np.expm1) if lib is np else each
    k2, complement = 1 / (1 + lib.exp(-y)), 1 / (1 + lib.exp(y))
    beside = complement + k2 * rest
    change = expm1(theta * (log(rest / beside) + lib.log(k2) / 2))
    weight = w * (beside / rest) ** (fraction(1, 2, lib) - theta) * rest ** fraction(1, 2, lib)
    v = _eigenfunction(_kernel(r, rest, k2, complement), weight, lib)
    e = (w * v * change).sum() / (w * v).sum()
    return _Flat(k2, complement, -e * (2 + e), r, rest, weight, v)


def _eigenfunction(apart: Number, weight: Number, lib: Library) -> Number:
    """v > 0, of 1/apart times the weights, 1 in the middle.

    In doubles it is that of a symmetric matrix. More digits follow from what it misses, by Newton's
    method with the matrix in doubles: each step adds as many as a double has.
    """
    distances, root = apart.astype(float), np.sqrt(weight.astype(float))
    _, vectors = np.linalg.eigh(root[:, None] * root / distances)
    v, middle = (root / distances) @ abs(vectors[:, -1]), len(root) // 2
    v = v / v[middle]
    if lib is np:
        return v
    kernel, one = weight / apart, lib.mpf(1)
    rough = weight.astype(float) / distances
    v = np.array([one * float(value) for value in v], dtype=object)
    slopes = np.zeros((len(v) + 1,) * 2)
    slopes[-1, middle] = 1.0
    for _ in range(STEPS):
        Kv = kernel @ v
        missed = Kv - Kv[middle] * v
        size = max(abs(missed))
        slopes[:-1, :-1] = rough - float(Kv[middle]) * np.eye(len(v))
        slopes[:-1, -1] = -v.astype(float)
        scaled = np.append((missed / size).astype(float), 0.0) if size else np.zeros(len(v) + 1)
        step = np.linalg.solve(slopes, scaled)[:-1]
        v = v - size * step
        if size * float(max(abs(step / v.astype(float)))) <= len(v) * one / 2 ** bits(lib):
            break
    return v


def _kernel(r: Number, rest: Number, k2: Number, complement: Number) -> Number:
    """1 - k² r s at all pairs of nodes."""
    return complement + k2 * (rest[:, None] + r[:, None] * rest)


def _nodes(y: Number, lib: Library) -> tuple[Number, Number, Number]:
    """r, 1 - r and (r (1-r))^(-1/2) dr; 1 - k² r s is k'² + k² ((1-r) + r (1-s))."""
    thin = max(float(y), 0.0)
    end = lib.asinh(((bits(lib) + 8) * 2 * lib.log(2) + thin) / lib.pi)
    thinner = (1 + (thin / 3) ** 2) ** 0.5
    count = int(POINTS * bits(lib) * thinner * float(end)) + 1
    values = []
    for j in range(-count, count + 1):
        t = end * j / count
        growth = lib.exp(lib.pi * (lib.exp(t) - lib.exp(-t)) / 2)
        r, rest = growth / (1 + growth), 1 / (1 + growth)
        cosh = (lib.exp(t) + lib.exp(-t)) / 2
        values.append((r, rest, lib.pi * end / count * cosh * lib.sqrt(r * rest)))
    r, rest, w = np.array(values, dtype=float if lib is np else object).T
    return r, rest, w
