"""One number of a contact taken to its extremes: the true error, and the certificate's estimate.

Each sweep is a function value -> Outcome. Truths are closed forms in 50 digits (of many pieces, a
sum of as many in doubles), evaluated at the very doubles that the solver was given.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

import sie
from analytic import rounded_flat
from oracles.principal_value import context
from sie.problem.material import SIMILAR
from validation.harness.measures import largest

mp = context(50)
SPOILED = 1e-10  # an answer off by so much must be detected
CERTIFIED_PIECES = 1000  # beyond, a certificate takes longer than the solution
MARGIN = 0.95  # of the half-width: nearer the edge one ulp of the edge weighs more than the bar


@dataclass(frozen=True)
class Outcome:
    """error, spoiled (the same of an answer that is off by SPOILED), estimate; refused: the words
    of the refusal, if it was one.
    """

    error: float = math.nan
    spoiled: float = math.nan
    estimate: float = math.nan
    refused: str = ""

    def state(self, bar: float) -> str:
        """full; known (refused, or the certificate states a third of the error); or lost."""
        if self.refused:
            return "known"
        if self.error <= bar:
            return "full"
        return "known" if self.estimate >= self.error / 3 else "lost"


@dataclass(frozen=True)
class Sweep:
    """`promised` is the range in which full accuracy is promised, `values` go beyond it;
    `decades(value)` is the axis of the picture.
    """

    name: str
    axis: str
    at: Callable[[float], Outcome]
    values: tuple[float, ...]
    promised: tuple[float, float]
    bar: float = 1e-13
    certified: bool = True  # whether a certificate of the contact comes with the answers
    decades: Callable[[float], float] = field(default=lambda v: math.log10(abs(v)))

    def run(self, value: float) -> Outcome:
        try:
            return self.at(value)
        except (sie.ContactError, ValueError) as error:
            return Outcome(refused=str(error))


def _outcome(
    solution: Any, found: Any, true: Any, scale: float, estimate: float | None = None
) -> Outcome:
    """Errors of some values relative to `scale`; all numbers in mpmath, so that nothing is lost in
    the comparison.
    """

    def error(factor: float) -> float:
        return largest(
            abs(factor * mp.mpmathify(complex(f)) - t) / scale
            for f, t in zip(found, true, strict=True)
        )

    return Outcome(
        error(1.0), error(1.0 + SPOILED), solution.check().error if estimate is None else estimate
    )


# -- the rounded punch from flat to round ---------------------------------------------------------


def flatness(share: float, given: str) -> Outcome:
    """share in (-1, 1): a/b = share if positive, else 1 - |share|.

    The errors are those of the pressure on the flat and its rounded edge, and of the load or the
    width of that edge.
    """
    thin = share < 0
    a, rim = (1.0, -share / (1.0 + share)) if thin else (share, 1.0 - share)
    if given == "width":
        rim = float((1.0 + rim) - a) if thin else rim
    punch: dict[str, Any] = {"half_flat": a, "radius": 1.0, "modulus": 1.0, "lib": mp}
    profile = sie.RoundedFlat(a, 1.0)
    if given == "load":
        P = float(rounded_flat.load(rim=mp.mpf(rim), **punch))
        rim_true = rounded_flat.rim(normal_load=mp.mpf(P), **punch)
        solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=P))
        contact = solution.normal.edges.contact
        extra = (float((contact.x2 - a) + contact.tail2) / float(rim_true), mp.one)
    else:
        b = a + rim
        rim_true = mp.mpf(b) - a
        solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=b))
        P_true = rounded_flat.load(rim=rim_true, **punch)
        extra = (float(solution.normal_load) / float(P_true), mp.one)
    x = np.array([0.0, 0.37 * a, 0.999 * a, a + 0.3 * rim, a + 0.8 * rim])
    true = [rounded_flat.pressure(mp.mpf(v), rim=rim_true, **punch) for v in x.tolist()]
    peak = max(true)
    found = [float(p) / float(peak) for p in solution.pressure(x)]
    return _outcome(
        solution, [*found, extra[0]], [*(t / mp.mpf(float(peak)) for t in true), extra[1]], 1.0
    )


def near_ends(deepest: int, steps: int = 1) -> tuple[float, ...]:
    """Shares 10^-k and 1 - 10^-k."""
    return (
        *(10.0**-k for k in range(deepest, 0, -steps)),
        0.5,
        *(-(10.0**-k) for k in range(1, deepest + 1, steps)),
    )


def logit(share: float) -> float:
    """Decades from a/b = 1/2."""
    a = share if share > 0 else 1.0 + share
    rest = 1.0 - share if share > 0 else -share
    return math.log10(a / rest)


# -- scale, pieces, gaps, coupling, depth ---------------------------------------------------------


@lru_cache(maxsize=1)
def _unscaled() -> tuple[Any, ...]:
    s = np.array([-0.8, -0.3, 0.1, 0.55, 0.9])
    punch = {"half_flat": 0.5, "radius": 1.0, "modulus": 1.0, "half_width": 1.0}
    return (
        s,
        [rounded_flat.pressure(mp.mpf(v), **punch, lib=mp) for v in s.tolist()],
        rounded_flat.load(**punch, lib=mp),
    )


def scale(length: float, modulus: float) -> Outcome:
    """The rounded punch with lengths and modulus multiplied: p/E* and x/b stay."""
    s, true, P = _unscaled()
    load = float(P) * length * modulus
    scene = sie.Scene(
        profile=sie.RoundedFlat(0.5 * length, length), modulus=modulus, normal_load=load
    )
    solution = sie.solve(scene)
    return _outcome(solution, solution.pressure(s * length) / modulus, true, float(max(true)))


def pieces(n: float) -> Outcome:
    """n/2 rounded flats of one radius on top of each other, a = d/2, 3d/2, …: h' is a polygon whose
    every corner counts.

    d is a power of two, so that its coefficients are exact; a sum of positive doubles, each right
    to rounding, is so too.
    """
    corners = max(int(n) // 2, 1)
    d = 2.0 ** -math.ceil(math.log2(corners + 1))
    b, a, k = corners * d, (np.arange(corners) + 0.5) * d, np.arange(corners + 1.0)
    right = np.stack((-0.5 * d * k * k, k), axis=1)  # h' = k x - d k²/2 after k of the corners
    rows = np.concatenate(((right * (-1.0, 1.0))[:0:-1], right))
    profile = sie.Piecewise(np.concatenate((-a[::-1], a)).tolist(), rows.tolist())
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=b))
    x = b * np.array([-0.9, -0.3, 1e-4, 0.77])
    true = [
        math.fsum(
            rounded_flat.pressure(v, half_flat=a, radius=1.0, modulus=1.0, half_width=b).tolist()
        )
        for v in x.tolist()
    ]
    estimate = solution.check().error if n <= CERTIFIED_PIECES else math.nan
    return _outcome(solution, solution.pressure(x), true, max(true), estimate)


def gap(width: float) -> Outcome:
    """Two like flats side by side, [-1, -k] and [k, 1], under P/2 each: p = (P/π) |x| / sqrt((x² -
    k²)(1 - x²)); a gap of 2k.
    """
    k = 0.5 * width
    equation = sie.CauchyEquation(
        ((-1.0, -k), (k, 1.0)), g=0.0, b=-1.0, ends="singular", total=(0.5, 0.5)
    )
    density = equation.solve()
    s = np.array([0.03, 0.2, 0.5, 0.9])
    x = k + (1.0 - k) * s
    true = [
        mp.mpf(v) / mp.pi / mp.sqrt((mp.mpf(v) ** 2 - mp.mpf(k) ** 2) * (1 - mp.mpf(v) ** 2))
        for v in x.tolist()
    ]
    ratio = [float(f) / float(t) for f, t in zip(density(x), true, strict=True)]
    return _outcome(
        None, ratio, [mp.one] * len(ratio), 1.0, estimate=float(getattr(density, "error", math.nan))
    )


def coupling(beta_f: float) -> Outcome:
    """Sliding Hertz, tan πε = -βf: p = (E* cos πε/2R)(c2-x)^(1/2-ε)(c1+x)^(1/2+ε), c1, c2 = w(1 ∓
    2ε) (Hills, Nowell & Sackfield 1993).
    """
    # Bodies of a smaller β are similar.
    friction = min(max(2.0, 2.5 * abs(beta_f)), abs(beta_f) / (2.0 * SIMILAR))
    scene = sie.Scene(
        profile=sie.Parabola(1.0),
        modulus=1.0,
        dundurs=beta_f / friction,
        friction=friction,
        sliding=1,
        half_width=1.0,
    )
    solution = sie.solve(scene)
    e = -mp.atan(mp.mpf(beta_f)) / mp.pi
    half = mp.mpf(1) / 2
    x = 2 * float(e) + MARGIN * np.array([-1.0, -0.4, 0.1, 0.7, 1.0])
    true = [
        mp.cos(mp.pi * e)
        / 2
        * (1 + 2 * e - mp.mpf(v)) ** (half - e)
        * (1 - 2 * e + mp.mpf(v)) ** (half + e)
        for v in x.tolist()
    ]
    return _outcome(solution, solution.pressure(x), true, float(max(true)))


@lru_cache(maxsize=1)
def _punch() -> sie.Solution:
    return sie.solve(sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, half_width=1.0))


def depth(y: float) -> Outcome:
    """The potential F(x + iy) of the rounded punch under, beside and far from the contact, relative
    to itself.
    """
    z = np.array([0.1, 0.5, 0.8, 1.0, 1.3]) + 1j * y
    punch = {"half_flat": 0.5, "radius": 1.0, "modulus": 1.0, "half_width": 1.0, "lib": mp}
    true = [rounded_flat.potential(mp.mpc(v), **punch) for v in z.tolist()]
    found = [
        complex(f) / complex(t) for f, t in zip(_punch().pressure.cauchy(z), true, strict=True)
    ]
    # The certificate is that of the pressure.
    return _outcome(None, found, [mp.one] * len(found), 1.0, estimate=math.nan)


def at_kink(distance: float, ratio: float = 0.5) -> Outcome:
    """The pressure at so many b from the end of the flat, on both sides; 0 is the end itself."""
    solution = sie.solve(
        sie.Scene(profile=sie.RoundedFlat(ratio, 1.0), modulus=1.0, half_width=1.0)
    )
    x = np.array([ratio - distance, ratio + distance, -ratio - distance])
    return _of_punch(solution, ratio, x[np.abs(x) < 1.0], 1.0)


def at_edge(distance: float, ratio: float = 0.5) -> Outcome:
    """The pressure so many b from the edge, the half-width being given: relative to itself, though
    it vanishes there.
    """
    solution = sie.solve(
        sie.Scene(profile=sie.RoundedFlat(ratio, 1.0), modulus=1.0, half_width=1.0)
    )
    return _of_punch(solution, ratio, np.array([1.0 - distance, -1.0 + distance]), None)


def _of_punch(solution: sie.Solution, ratio: float, x: Any, scale: float | None) -> Outcome:
    punch = {"half_flat": ratio, "radius": 1.0, "modulus": 1.0, "half_width": 1.0, "lib": mp}
    true = [rounded_flat.pressure(mp.mpf(v), **punch) for v in x.tolist()]
    if scale is None:
        found = [float(f) / float(t) for f, t in zip(solution.pressure(x), true, strict=True)]
        return _outcome(solution, found, [mp.one] * len(found), 1.0)
    # Nearly the place of the peak
    peak = rounded_flat.pressure(mp.mpf(ratio) + mp.mpf("0.4") * (1 - mp.mpf(ratio)), **punch)
    return _outcome(solution, solution.pressure(x), true, max(peak, *true))


def partial_slip(ratio: float) -> Outcome:
    """Q/fP -> half-width of the stick zone of the rounded punch: P(c) = P - Q/f (Ciavarella 1998);
    share < 0 is 1 - |share|.

    Q/f is given as a double, so that near fP the difference is what two doubles leave.
    """
    f, a, R = 0.5, 0.5, 1.0
    punch: dict[str, Any] = {"half_flat": a, "radius": R, "modulus": 1.0, "lib": mp}
    P = 0.5
    Q = f * P * ratio if ratio > 0 else f * (P + P * ratio)
    solution = sie.solve(
        sie.Scene(
            profile=sie.RoundedFlat(a, R), modulus=1.0, normal_load=P, friction=f, tangential_load=Q
        )
    )
    ((lo, hi),) = solution.stick
    rim = rounded_flat.rim(normal_load=mp.mpf(P) - mp.mpf(Q) / mp.mpf(f), **punch)
    return _outcome(solution, [0.5 * (hi - lo)], [a + rim], float(a + rim))
