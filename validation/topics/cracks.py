"""From the edge of a contact to the crack, and where wear ends.

K of an edge crack under powers of the depth has an exact solution by Wiener and Hopf's method,
computed here in 30 digits; handbooks print five of its values. The slip zone of Cattaneo tends to
that of the edge's asymptote; the wear limit of a cylinder and its rolling are known in closed form.
The eigenvalues of the modes of wear on a fixed width are compared with Galin's equation, solved in
cosines of the angle, in which ln(1/|x - t|) is a diagonal series.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.linalg import eigh

import sie
from oracles.edge_crack import edge_crack
from oracles.worn_parabola import worn_parabola
from validation.harness.measures import apart, largest, relative
from validation.harness.records import Record, checked, in_turn

TITLE = "Cracks at the edge of contact, and the limit of wear"
SECONDS = (3.0, 3.0)
TIMED = False
HANDBOOK = (1.1215222552, 0.6828628777, 0.5254884154, 0.4409767224, 0.3868236391)
PAD = sie.Scene(
    profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0, friction=0.3, tangential_load=0.15
)
# K_I/(p0 sqrt(π b)) of cracks at the trailing edge of PAD by collocation, before the package had K
DEPTHS, BY_COLLOCATION = (0.01, 0.05, 0.1, 0.2), (0.03020, 0.02772, 0.00549, 0.0)
RATIOS = (0.2, 0.6, 0.9)
COSINES = 4000  # of Galin's kernel


def compute(_: bool) -> Iterator[Record]:
    yield from in_turn(("cracks", _cracks()), ("wear", _wear()))


# -- cracks ----------------------------------------------------------------------------------------


def _cracks() -> Iterator[Record]:
    by = "Tada, Paris & Irwin, Handbook; Wiener & Hopf"
    yield checked(
        constants, 0.0, 1e-6, what="K of an edge crack under (y/a)^n, n = 0 to 4: largest error",
        by=by, named="the exact solution for powers larger by 1e-6", high=1e-9,
    )  # fmt: skip
    yield checked(
        lambda values: largest(np.abs(np.subtract(factors(), values))),
        HANDBOOK, (1.1215, *HANDBOOK[1:]),
        what="the same against the digits of the handbooks: largest difference", by=by,
        named="with the four digits that are usually quoted", high=1e-10,
    )  # fmt: skip
    yield checked(
        below_the_pad, PAD, replace(PAD, tangential_load=0.151),
        what="K_I of cracks at the trailing edge of a cylinder: largest difference / p0 sqrt(π b)",
        by="this project, by collocation", named="under 1 % more load", high=6e-6,
    )  # fmt: skip
    yield checked(
        asymptote, 1.0, 1.001,
        what="slip zone of an edge's asymptote against Q b/(2 f P): relative error",
        by="Hills, Dini & Sackfield", named="under 0.1 % more load", high=1e-12,
    )  # fmt: skip


def factors(shift: float = 0.0) -> list[float]:
    """K/(σ sqrt(πa)) under (y/a)^(n + shift)."""
    powers = [n + shift for n in range(5)]
    cracks = [sie.EdgeCrack(1.0, lambda y, n=n: y**n) for n in powers]  # type: ignore[misc]
    return [crack.mode_1 / math.sqrt(math.pi) for crack in cracks]


def constants(shift: float) -> float:
    exact = [edge_crack(n + shift) for n in range(5)]
    return largest(relative(K, true) for K, true in zip(factors(), exact, strict=True))


def below_the_pad(scene: sie.Scene) -> float:
    pad, b = sie.solve(scene), sie.solve(PAD).half_width
    K = sie.Cycle([pad.with_(tangential_load=0.0), pad]).stress_intensity(
        at=-b, depth=b * np.array(DEPTHS)
    )
    unit = 2.0 / (math.pi * b) * math.sqrt(math.pi * b)
    return largest(np.abs(K.mode_1[1] / unit - BY_COLLOCATION))


def asymptote(factor: float) -> float:
    pad = sie.solve(replace(PAD, tangential_load=factor * PAD.tangential_load))
    exact = PAD.tangential_load * pad.half_width / (2.0 * PAD.friction)
    return relative(pad.edge_intensity("left").slip_length, exact)


# -- wear ------------------------------------------------------------------------------------------


def _wear() -> Iterator[Record]:
    yield checked(
        worn, 1.0, 1.0 + 1e-9,
        what="wear limit of a cylinder at Q/fP = 0.2, 0.6, 0.9: stick zone, pressure in the "
        "middle, end, deepest place and volume: largest relative error",
        by="Dmitriev et al. 2016; closed form", named="under 1e-9 more tangential load",
        high=1e-11,
    )  # fmt: skip
    yield checked(
        creep, 1.0, 1.0 + 1e-9, what="creep of a rolling cylinder: relative error",
        by="Carter 1926", named="under 1e-9 more tangential load", high=1e-12,
    )  # fmt: skip
    found = sie.wear_modes().eigenvalues
    yield checked(
        lambda mu: apart(mu, galin()), found[:5], found[1:6],
        what="the first five eigenvalues of Galin's modes: largest error",
        by="Galin & Goryacheva 1977", named="each of the next mode", high=1e-8,
    )  # fmt: skip


def worn(factor: float) -> float:
    load = math.pi / 4.0  # of half-width 1
    errors = []
    for ratio in RATIOS:
        scene = replace(
            PAD, normal_load=load, friction=0.5, tangential_load=factor * 0.5 * ratio * load
        )
        limit, exact = sie.wear_limit(scene), worn_parabola(ratio)
        deepest = math.sqrt(0.5 * (1.0 + float(exact.stick) ** 2))
        values: tuple[Any, ...] = (
            limit.stick[1], 2.0 * limit.pressure(0.0), limit.worn[1], limit.depth(deepest),
            limit.volume,
        )  # fmt: skip
        errors += [relative(float(v), true) for v, true in zip(values, exact, strict=True)]
    return largest(errors)


def creep(factor: float) -> float:
    rolls = sie.rolling(replace(PAD, tangential_load=factor * PAD.tangential_load))
    b = rolls.solution.half_width
    return relative(rolls.creep, PAD.friction * b * (1.0 - math.sqrt(0.5)))


def galin() -> list[Any]:
    """The first five eigenvalues, largest first, with φ a sum of cos mθ, x = cos θ, m up to 60.

    The kernel is ln 2 + Σ 2/k cos kθ cos kθ', which functions of zero mean meet from k = 1 on.
    """
    k, m = np.arange(1, COSINES + 1), np.arange(1, 61)[:, None]

    def mean(j: Any) -> Any:
        """∫ cos jθ sin θ dθ."""
        return np.where(j % 2 == 0, 2.0 / np.where(j % 2 == 0, 1.0 - j * j, 1.0), 0.0)

    def products(j: Any) -> Any:
        """∫ cos mθ cos jθ sin θ dθ of functions cos mθ less their mean."""
        return 0.5 * (mean(m - j) + mean(m + j)) - 0.5 * mean(m) * mean(j)

    kernel, norm = products(k) * (2.0 / k) @ products(k).T, products(m.T)
    return sorted(eigh(kernel, norm, eigvals_only=True).tolist(), reverse=True)[:5]
