"""Contact in several patches: closed forms, closing gaps, events, and a rough profile.

Closed forms: two equal parabolas (steps of the arithmetic-geometric mean), two equal flats, and per
period Westergaard's wave, a row of parabolas and a row of flats, in 50 digits. Gaps: the same
parabolas pressed until the gap between patches is 1e-10 of a patch, on the line and per period.
Events: on h = x²/2 + cos(12x + 0.7)/20 a patch appears and grows like the square root of the load
beyond that (up to a logarithm), and the gap between two vanishes like the square root of the load
that is left; next to an event the certificate states the conditioning. Wave: Westergaard's from
first touch to full contact. Rough: a self-affine profile against codes that work on grids
(`validation.rivals.rough_profile`). Growth: waves that shorten with the spacing of the points
keep the density of patches.

The error of edges is relative to the narrowest patch, that of pressures to their peak.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

import sie
from analytic import flat_row, hertz, parabola_row, two_flats, two_parabolas, wavy
from validation.harness.counting import work
from validation.harness.measures import apart, largest, mp
from validation.harness.records import Claim, Curve, Doing, Record, Table, checked
from validation.rivals.rough_profile import SEED, roughness, timed

TITLE = "Contact in several patches"
SECONDS = (15.0, 60.0)
TIMED = True
EDGES, PRESSURE = 1e-13, 1e-12
Array = NDArray[np.float64]
INSIDE = np.array([-0.97, -0.6, -0.2, 0.1, 0.5, 0.9])  # of each patch, in half-widths
BY = "this project: to machine precision"
NEARER = 4  # times, towards an event
# The distance of the exponent of a square root from 1/2: of a patch that appears r² has a factor
# ln(1/r)
ROOT = 0.05
SIZES = ((300, 1000, 3000), (1000, 3000, 10_000))  # points at a fixed density of patches
GROWTH = 1.3


# -- closed forms ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class Case:
    """A scene with known patches and the exact pressure at a double, as a number of many digits."""

    name: str
    scene: sie.Scene
    edges: tuple[Any, ...]
    pressure: Callable[[float], Any]

    def errors(self, load: float = 1.0) -> tuple[float, float]:
        """Errors of the edges and of the pressure, of a solution under `load` times the load."""
        scene = self.scene
        assert scene.normal_load is not None
        solution = sie.solve(sie.Scene(
            profile=scene.profile, modulus=1.0, normal_load=load * scene.normal_load
        ))  # fmt: skip
        found = np.array(solution.patches).ravel()
        if scene.profile.period < np.inf:
            found -= scene.profile.period * np.round(found.mean() / scene.profile.period)
        ends = [mp.mpf(e) for e in self.edges]
        narrowest = min(b - a for a, b in zip(ends[::2], ends[1::2], strict=True))
        off = largest(
            abs(mp.mpf(x) - e) / narrowest for x, e in zip(found.tolist(), ends, strict=True)
        )
        x = samples(solution)
        return off, apart(solution.pressure(x), [self.pressure(v) for v in x.tolist()])


def samples(solution: sie.Solution) -> Array:
    ends = np.array(solution.patches)
    return (ends.mean(axis=1)[:, None] + 0.5 * np.diff(ends, axis=1) * INSIDE).ravel()


def parabolas(inner: float, outer: float) -> Case:
    """Two equal parabolas, R = 1, whose patches are inner < |x| < outer up to rounding of d, P."""
    shape = {"radius": 1.0, "modulus": 1.0}
    d = float(two_parabolas.distance(inner=inner, outer=outer))
    load = float(two_parabolas.load(inner=inner, outer=outer, **shape))
    exact = {"normal_load": mp.mpf(load), "distance": mp.mpf(d)}
    c1, c2 = two_parabolas.edges(**exact, **shape, lib=mp)
    profile = sie.Row([sie.Parabola(1.0).shifted(-d), sie.Parabola(1.0).shifted(d)])
    return Case(
        "two parabolas",
        sie.Scene(profile=profile, modulus=1.0, normal_load=load),
        (-c2, -c1, c1, c2),
        lambda x: two_parabolas.pressure(mp.mpf(x), inner=c1, outer=c2, **shape, lib=mp),
    )


def flats(inner: float, outer: float) -> Case:
    middle, half = 0.5 * (inner + outer), 0.5 * (outer - inner)
    profile = sie.Row([sie.Flat(half).shifted(-middle), sie.Flat(half).shifted(middle)])
    ends = mp.mpf(middle) - mp.mpf(half), mp.mpf(middle) + mp.mpf(half)
    given = {"inner": ends[0], "outer": ends[1], "normal_load": 1, "lib": mp}
    return Case(
        "two flats",
        sie.Scene(profile=profile, modulus=1.0, normal_load=1.0),
        (-ends[1], -ends[0], *ends),
        lambda x: two_flats.pressure(mp.mpf(x), **given),
    )


def wave(mean: float) -> Case:
    """Westergaard's wave, λ = 1, D = 1/2, under a part of what closes it."""
    shape = {"wavelength": 1, "amplitude": mp.mpf("0.5"), "modulus": 1, "lib": mp}
    load = mean * 0.5 * math.pi
    a = wavy.half_width(mean_pressure=mp.mpf(load), **shape)
    profile = sie.FromFunction(lambda x: np.pi * np.sin(2.0 * np.pi * x))
    return Case(
        "Westergaard's wave",
        sie.Scene(profile=sie.Periodic(profile, 1.0), modulus=1.0, normal_load=load),
        (-a, a),
        lambda x: wavy.pressure(mp.mpf(x), half_width=a, **shape),
    )


def crests(gap: float) -> Case:
    """A row of parabolas, R = L = 1, with a gap of this part of the period."""
    shape = {"radius": 1, "period": 1, "modulus": 1, "lib": mp}
    wanted = mp.mpf(1) / 2 - mp.mpf(gap) / 2
    load = float(parabola_row.mean_pressure(half_width=wanted, **shape))
    a = parabola_row.half_width(mean_pressure=mp.mpf(load), **shape)
    return Case(
        "row of parabolas",
        sie.Scene(profile=sie.Periodic(sie.Parabola(1.0), 1.0), modulus=1.0, normal_load=load),
        (-a, a),
        lambda x: parabola_row.pressure(mp.mpf(x), half_width=a, **shape),
    )


def flat_crests(half_width: float) -> Case:
    given = {"half_width": mp.mpf(half_width), "period": 1, "mean_pressure": 1, "lib": mp}
    profile = sie.Periodic(sie.Flat(half_width), 1.0)
    return Case(
        "row of flats",
        sie.Scene(profile=profile, modulus=1.0, normal_load=1.0),
        (-half_width, half_width),
        lambda x: flat_row.pressure(mp.mpf(x), **given),
    )


def closed_forms() -> Iterator[Record]:
    rows = []
    for case in (parabolas(0.3, 1.2), flats(0.3, 1.2), wave(0.4), crests(0.3), flat_crests(0.35)):
        yield Doing(case.name)
        edges, p = case.errors()
        wrong_edges, wrong = case.errors(1.0 + 1e-9)
        rows.append((case.name, edges, p))
        named = "a load 1e-9 too large"
        if not any(sie.solve(case.scene).sharp):
            yield Claim(
                f"{case.name}: error of the edges", BY, edges, wrong_edges, named, high=EDGES
            )
        yield Claim(f"{case.name}: error of the pressure", BY, p, wrong, named, high=PRESSURE)
    yield Table("Closed forms", ("contact", "edges / narrowest patch", "pressure / peak"), rows)


# -- gaps that close ------------------------------------------------------------------------------


def gaps(quick: bool) -> Iterator[Record]:
    sizes = 10.0 ** -np.arange(1.0, 11.0, 3.0 if quick else 1.0)
    families: dict[str, Callable[[float], Case]] = {
        "two parabolas": lambda gap: parabolas(0.5 * gap, 0.5 * gap + 1.0),
        "two flats": lambda gap: flats(0.5 * gap, 0.5 * gap + 1.0),
        "row of flats": lambda gap: flat_crests(0.5 - 0.5 * gap),
    }
    for name, make in families.items():
        yield Doing(f"{name}, gaps")
        found = np.array([make(float(gap)).errors() for gap in sizes])
        wrong = make(float(sizes[0])).errors(1.0 + 1e-9)
        for what, k, bar in (("edges", 0, EDGES), ("pressure", 1, PRESSURE)):
            if what == "edges" and "flats" in name:
                continue
            yield Claim(
                f"{name}, gaps down to {sizes[-1]:.0e} of a patch: largest error of the {what}",
                BY, largest(found[:, k]), wrong[k], "a load 1e-9 too large", high=bar,
            )  # fmt: skip
            yield Curve("gaps", f"{name}, {what}", sizes, found[:, k], "both")
    yield from stated(sizes[sizes > 1e-9])


def stated(sizes: Array) -> Iterator[Record]:
    """A row of parabolas: the gap lies at x = 1/2, where doubles do not resolve it."""
    cases = [crests(float(gap)) for gap in sizes]
    errors = np.array([case.errors()[1] for case in cases])
    certificates: list[Any] = [sie.solve(case.scene).check() for case in cases]
    known = np.array([max(c.error, c.measured_to) for c in certificates])
    yield Claim(
        f"row of parabolas, gaps down to {sizes[-1]:.0e}: error of the pressure over what the "
        "certificate states",
        "certificate", largest(errors / known), largest(errors / known.min()),
        "a certificate that states the same for all gaps", high=1.0,
    )  # fmt: skip
    yield Curve("gaps", "row of parabolas, pressure", sizes, errors, "both")
    yield Curve("gaps", "row of parabolas, certified", sizes, known, "dashed")


# -- events ---------------------------------------------------------------------------------------


def waved(load: float) -> sie.Solution:
    profile = sie.FromFunction(lambda x: x - 0.6 * np.sin(12.0 * x + 0.7), domain=(-2.0, 2.0))
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=load))


def narrowest_patch(solution: sie.Solution) -> float:
    return min(b - a for a, b in solution.patches)


def narrowest_gap(solution: sie.Solution) -> float:
    return min(b - a for (_, a), (b, _) in itertools.pairwise(solution.patches))


def approached(
    size: Callable[[sie.Solution], float], first: float, second: float
) -> tuple[Array, list[sie.Solution]]:
    """Distances of loads from the event at which a size vanishes like a square root, over that
    load, and the solutions; each load is ten times nearer than the one before.
    """
    loads, solutions = [first, second], [waved(first), waved(second)]
    for _ in range(NEARER):
        one, other = (size(s) ** 2 for s in solutions[-2:])
        event = loads[-1] - other * (loads[-1] - loads[-2]) / (other - one)
        loads.append(event + 0.1 * (loads[-1] - event))
        solutions.append(waved(loads[-1]))
    last = size(solutions[-1]) ** 2
    event = loads[-1] - last * (loads[-1] - loads[-2]) / (last - size(solutions[-2]) ** 2)
    return np.abs(np.array(loads[2:-1]) / event - 1.0), solutions[2:-1]


def exponent(x: Array, y: Sequence[float]) -> float:
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def events() -> Iterator[Record]:
    """The appearance and the merger nearest to the load 0.228, at which there are three patches."""
    yield Doing("events")
    for what, size, second in (
        ("patch that appears", narrowest_patch, 0.226),
        ("gap that closes", narrowest_gap, 0.235),
    ):
        away, near = approached(size, 0.228, second)
        sizes = [size(s) for s in near]
        loads = [s.normal_load for s in near]
        yield Claim(
            f"narrowest {what}: its exponent in the distance of the load, less 1/2",
            "square root of a fold",
            abs(exponent(away, sizes) - 0.5), abs(exponent(away, loads) - 0.5),
            "the load, which stays", high=ROOT,
        )  # fmt: skip
        certificates: list[Any] = [s.check() for s in near]
        yield Claim(
            f"answers next to a {what}, and not certified", "certificate",
            sum(not c.ok for c in certificates), len(near), "all of them", high=0.0,
        )  # fmt: skip
        if size is narrowest_patch:
            stated = [c.condition * float(e) for c, e in zip(certificates, away, strict=True)]
            yield Claim(
                "condition of a patch that appears times the distance of the load, less 1/2",
                "certificate: d ln r / d ln P of a square root", abs(stated[-1] - 0.5),
                abs(certificates[0].condition * float(away[-1]) - 0.5),
                "the condition stated for the first load", high=ROOT,
            )  # fmt: skip
        yield Curve("events", f"narrowest {what}", away, sizes, "both")
    s = waved(0.228)
    x = np.linspace(*s.edges, 1201)
    yield Curve("events: pressure", "P = 0.228 E*", x, s.pressure(x))


# -- the wave -------------------------------------------------------------------------------------


def waves(quick: bool) -> Iterator[Record]:
    """From 1e-12 of the closing pressure up to it."""
    yield Doing("wave")
    parts = [1e-12, 1e-8, 1e-4, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0 - 1e-4, 1.0 - 1e-6]
    parts = parts[:: 3 if quick else 1]
    errors = [wave(part).errors() for part in parts]
    alone = [apart_of_hertz(wave(part)) for part in parts]
    yield Claim(
        "wave from first touch to full contact: largest error of the pressure", BY,
        largest(p for _, p in errors), largest(alone), "Hertz on each crest alone", high=1e-11,
    )  # fmt: skip
    full = sie.solve(sie.Scene(
        profile=wave(0.5).scene.profile, modulus=1.0, normal_load=0.5 * math.pi * 1.25
    ))  # fmt: skip
    x = np.linspace(-0.5, 0.5, 41)
    shape = {"wavelength": 1, "amplitude": 0.5, "modulus": 1, "lib": mp}
    complete = [
        wavy.complete_pressure(mp.mpf(v), mean_pressure=mp.mpf(full.normal_load), **shape)
        for v in x.tolist()
    ]
    yield checked(
        partial(apart, full.pressure(x), complete), 1.0, 1.0 + 1e-9,
        what="wave in full contact: error of the pressure", by=BY,
        named="pressures 1e-9 too large", high=PRESSURE,
    )  # fmt: skip
    x = np.linspace(-0.5, 0.5, 801)
    for part in (0.02, 0.2, 0.5, 0.8, 0.99):
        p = sie.solve(wave(part).scene).pressure(x)
        yield Curve("wave", f"{part:g} of the closing pressure", x, p)
    yield Curve("wave", "full contact", np.linspace(-0.5, 0.5, 801), full.pressure(x))


def apart_of_hertz(case: Case) -> float:
    """The error of Hertz under the load of one crest, of the curvature of a crest."""
    solution, radius = sie.solve(case.scene), 0.5 / math.pi**2
    b = float(hertz.half_width(normal_load=solution.normal_load, radius=radius, modulus=1.0))
    x = samples(solution)
    p = hertz.pressure(x, half_width=b, radius=radius, modulus=1.0)
    return apart(p, [case.pressure(v) for v in x.tolist()])


# -- growth ---------------------------------------------------------------------------------------


def shortening(points: int) -> sie.Profile:
    """A rough profile, repeated with period 2, whose waves are as long as 4 to 50 spacings."""
    rng = np.random.default_rng(SEED)
    k = np.arange(points // 50, points // 4)
    spectrum = np.zeros(points // 2 + 1, dtype=complex)
    spectrum[k] = k**-1.3 * np.exp(2j * np.pi * rng.uniform(size=len(k)))
    h = np.fft.irfft(spectrum, points)
    h = np.roll(h, -int(np.argmax(h))) * 10.0 / (points * h.std())
    x = np.linspace(0.0, 2.0, points + 1)
    return sie.Periodic(sie.Sampled(x, np.append(h, h[0])), 2.0)


def growing(quick: bool) -> Iterator[Record]:
    sizes = SIZES[not quick]
    rows: list[tuple[float, ...]] = []
    steps: list[float] = []
    for points in sizes:
        yield Doing(f"growth, {points} points")
        profile = shortening(points)
        solution, number, seconds = timed(profile, process_time)
        steps.append(work(partial(timed, profile, process_time)).steps)
        certificate: Any = solution.check()
        allowed = max(certificate.tol, certificate.measured_to)
        rows.append((points, number, 1e3 * seconds, certificate.error / allowed))
    n, times = np.array(sizes, dtype=float), np.array([row[2] for row in rows])
    worst = max(row[3] for row in rows)
    yield Claim(
        "exponent of the steps in the number of points, at a fixed density of patches", BY,
        exponent(n, steps), exponent(n, (n * n).tolist()), "every pair of points",
        high=GROWTH,
    )  # fmt: skip
    yield Claim(
        "rough profiles of those sizes: error over what the certificate allows", "certificate",
        worst, 1e3 * worst, "a thousand times the error", high=1.0,
    )  # fmt: skip
    yield Curve("growth", "this package", n, times / 1e3, "both")
    yield Table(
        "Points of a rough profile at a fixed density of patches",
        ("points", "patches", "time [ms]", "error / certified"), rows,
        "The time is that of the patches and their edges, on one processor.",
    )  # fmt: skip


def compute(quick: bool) -> Iterator[Record]:
    yield from closed_forms()
    yield from gaps(quick)
    yield from events()
    yield from waves(quick)
    yield from roughness(quick)
    yield from growing(quick)
