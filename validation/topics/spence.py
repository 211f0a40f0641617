"""Dissimilar bodies pressed with friction: equations (1) and (12) coupled (Spence's problem).

The stick ratio c/b depends on β and f alone. It is compared with values of another formulation in
32 digits, the tractions with both equations by quadrature that the solver did not use, and the
loads with the printed equations on a grid. Goodman's approximation leaves β q out of (1); how far
it is from the coupled answer is measured, and so are its own equations, under Q too. Under Q at
constant P the coupled equations hold from small loads to incipient sliding, the edges are those of
another program, and the energy is the work of friction on the slip between two loads.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

import sie
from oracles import oblique_edges, spence
from sie.certificate.coupled_check import coupled_certificate, shear_certificate
from sie.friction.coupled.flat import flat_punch
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Doing, Map, Record, Table

TITLE = "Dissimilar bodies pressed with friction"
SECONDS = (12.0, 60.0)
TIMED = False

# c/b and b p(0)/P of a flat punch, by the eigenvalue problem in 32 digits with another rule
REFERENCES = {
    (0.1, 0.1): (0.70061786631, 0.32027597518),
    (0.2, 0.3): (0.913700055232, 0.325433464420),
    (0.3, 0.1): (0.0281849146283, 0.345244082252),
    (0.3, 0.5): (0.9246117565700, 0.3349212640270),
    (0.5, 0.2): (0.04084680342861, 0.4068002623182),
    (0.5, 1.0): (0.8895859253767, 0.3739542976491),
}
UNDER_Q = 1e-10, 1e-9  # as EQUATIONS and SHEAR, under Q
PLACES = 1e-10  # of edges under Q, as they are asked for; 2e-14 is measured
SAME = 5e-11  # digits of the references
EQUATIONS, SHEAR = 1e-11, 1e-10  # of the largest pressure in (1), of the largest shear in (12)
OFF = 1e-3  # relative change of β that every checker must detect
PAIR = (0.3, 0.3)
SHARES = (0.0, 0.2, 0.5, 0.8, 0.9, 0.99)
CELLS = (25, 50, 100)
STEEL = (0.07, 0.3)


def solved(profile: sie.Profile, beta: float, friction: float, **given: Any) -> sie.Solution:
    given = given or {"half_width": 1.0}
    return sie.solve(
        sie.Scene(profile=profile, modulus=2.0, dundurs=beta, friction=friction, **given)
    )


def of_shear(certificate: Any) -> float:
    """The residual of equation (12)."""
    return float(certificate.shear.residual)


def compute(quick: bool) -> Iterator[Record]:
    yield Doing("stick ratios")
    yield from references()
    yield from chart(6 if quick else 14)
    yield Doing("both equations")
    yield from equations((0.2, 0.9) if quick else SHARES)
    yield Doing("the grid")
    yield from grids(CELLS[:2] if quick else CELLS)
    yield Doing("both equations under Q")
    yield from edges_under_tangential_load()
    parts = (0.1, 0.9) if quick else (0.01, 0.1, 0.3, 0.6, 0.9, 0.99)
    yield from coupled_under_tangential_load(parts)
    yield from work()
    yield Doing("Goodman's approximation")
    yield from approximation((0.02, 0.1, 0.5) if quick else (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5))
    yield from under_tangential_load((0.3,) if quick else (0.01, 0.1, 0.3, 0.6, 0.9, 1.0 - 1e-6))


def references() -> Iterator[Record]:
    rows, errors, wrong = [], [], []
    for (beta, f), (c, p) in REFERENCES.items():
        flat = solved(sie.Flat(1.0), beta, f, normal_load=1.0)
        rough = solved(sie.Flat(1.0), beta, f, normal_load=1.0, coupling="goodman")
        found = flat.stick[0][1], float(flat.pressure(0.0))
        errors.append(max(abs(found[0] - c), abs(found[1] - p) / p))
        wrong.append(abs(rough.stick[0][1] - c))
        rows.append((beta, f, *found, errors[-1]))
    yield Claim(
        "largest error of c/b and of the pressure on the axis of a flat punch",
        "another formulation, 32 digits",
        largest(errors),
        smallest(wrong),
        "c/b of Goodman's approximation",
        high=SAME,
    )
    widths, close, off = spence.SLIP_WIDTHS, [], []
    for (beta, f), width in widths.items():
        close.append(abs(flat_punch(beta, f).modulus.rest / width - 1.0))
        off.append(abs(flat_punch(beta * (1.0 + OFF), f).modulus.rest / width - 1.0))
    yield Claim(
        "largest relative error of 1 - c/b, from 0.35 to 1.6e-15",
        "the eigenvalue in 40 digits by another rule",
        largest(close),
        smallest(off),
        f"β off by {OFF:.0e} of it",
        high=1e-10,
    )
    yield Table("A flat punch, b = P = 1", ("β", "f", "c/b", "p(0)", "error"), rows)


def chart(n: int) -> Iterator[Record]:
    """c/b over β and f."""
    betas, frictions = np.linspace(0.02, 0.5, n), np.linspace(0.05, 1.0, n)
    ratios = [
        [solved(sie.Flat(1.0), b, f, normal_load=1.0).stick[0][1] for b in betas.tolist()]
        for f in frictions.tolist()
    ]
    yield Map("chart", betas, frictions, ratios)
    for f in (0.1, 0.3, 0.6, 1.0):
        c = [solved(sie.Flat(1.0), b, f, normal_load=1.0).stick[0][1] for b in betas.tolist()]
        yield Curve("stick ratio", f"f = {f:g}", betas, c)


def equations(shares: tuple[float, ...]) -> Iterator[Record]:
    """Rounded flats from a parabola to nearly a flat, a/b given."""
    ones, twelves, wrong_ones, wrong_twelves, rows = [], [], [], [], []
    for share in shares:
        profile = sie.RoundedFlat(share, 1.0) if share else sie.Parabola(1.0)
        for beta, f in (PAIR, STEEL):
            solution = solved(profile, beta, f)
            scene = replace(solution.scene, dundurs=beta * (1.0 + OFF))
            found = solution.check()
            state = solution.pressed[1]
            other = coupled_certificate(state, scene, 1e-13)
            ones.append(found.residual)
            twelves.append(of_shear(found))
            wrong_ones.append(other.residual)
            wrong_twelves.append(of_shear(other))
            load = solution.normal_load
            rows.append((share, beta, f, load, found.residual, of_shear(found)))
    named = f"β off by {OFF:.0e} of it"
    yield Claim(
        "largest residual of equation (1) over the peak pressure, rounded flats",
        "this project: a certificate on every answer",
        largest(ones),
        smallest(wrong_ones),
        named,
        high=EQUATIONS,
    )
    yield Claim(
        "largest residual of equation (12) in stick over the largest shear, rounded flats",
        "this project: a certificate on every answer",
        largest(twelves),
        smallest(wrong_twelves),
        named,
        high=SHEAR,
    )
    header = ("a/b", "β", "f", "P (b = R = E*/2 = 1)", "residual of (1)", "residual of (12)")
    yield Table("Rounded flats", header, rows)


def grids(cells: tuple[int, ...]) -> Iterator[Record]:
    """The load of a parabola whose contact grows cell by cell."""
    beta, f = PAIR
    exact = solved(sie.Parabola(1.0), beta, f).normal_load
    rough = solved(sie.Parabola(1.0), beta, f, half_width=1.0, coupling="goodman").normal_load
    loads = [
        spence.growing_contact(0.5 * ((np.arange(n + 1) + 0.5) / n) ** 2, n, beta, f, 1).load
        for n in cells
    ]
    errors, wrong = ([abs(load / limit - 1.0) for load in loads] for limit in (exact, rough))
    yield Claim(
        "order of the grid's convergence to the load of a parabola",
        "the printed equations on a grid, first order",
        float(np.log2(errors[-2] / errors[-1])),
        float(np.log2(wrong[-2] / wrong[-1])),
        "the load in Goodman's approximation as the limit",
        low=0.9,
        high=1.1,
    )
    yield Curve("grid", "coupled", cells, errors, "both")
    yield Curve("grid", "Goodman's approximation", cells, wrong, "both")


def edges_under_tangential_load() -> Iterator[Record]:
    """Edges of contact and stick against those of another program."""
    errors: list[float] = []
    wrong: list[float] = []
    for (beta, f, part), expected in oblique_edges.EDGES.items():
        loads = {"normal_load": 0.5 * np.pi, "tangential_load": part * f * 0.5 * np.pi}
        for mismatch, misses in ((beta, errors), (beta * (1.0 - OFF), wrong)):
            solution = solved(sie.Parabola(1.0), mismatch, f, **loads)
            x1, x2 = solution.edges
            found = np.array([x1, *solution.stick[0], x2])
            misses.append(float(np.abs(found - expected).max()))
    yield Claim(
        "largest error of the edges of contact and stick under P, then Q, parabola",
        "the four conditions in 16 digits by other rules",
        largest(errors),
        smallest(wrong),
        f"β off by {OFF:.0e} of it",
        high=PLACES,
    )


def coupled_under_tangential_load(parts: tuple[float, ...]) -> Iterator[Record]:
    """Both equations from small loads to incipient sliding, and the zones."""
    ones, twelves, wrong_ones, wrong_twelves = [], [], [], []
    for profile, (beta, f) in ((sie.Parabola(1.0), PAIR), (sie.RoundedFlat(0.5, 1.0), STEEL)):
        ends = []
        for part in parts:
            loads = {"normal_load": 1.0, "tangential_load": part * f}
            solution = solved(profile, beta, f, **loads)
            found, state = solution.check(), solution.coupled[1]
            off = replace(solution.scene, dundurs=beta * (1.0 + OFF))
            other = coupled_certificate(state, off, 1e-13)
            ones.append(found.residual)
            twelves.append(of_shear(found))
            wrong_ones.append(other.residual)
            wrong_twelves.append(of_shear(other))
            x1, x2 = solution.edges
            ends.append([x / solution.half_width for x in (x1, *solution.stick[0], x2)])
        if profile == sie.Parabola(1.0):
            names = "left edge", "left end of stick", "right end of stick", "right edge"
            for name, column in zip(names, np.transpose(ends), strict=True):
                yield Curve("coupled zones", name, parts, column, "both")
    for equation, right, wrong, high in (
        ("(1) over the peak pressure", ones, wrong_ones, UNDER_Q[0]),
        ("(12) in stick over the largest shear", twelves, wrong_twelves, UNDER_Q[1]),
    ):
        yield Claim(
            f"largest residual of {equation} under P, then Q",
            "this project: a certificate on every answer",
            largest(right),
            smallest(wrong),
            f"β off by {OFF:.0e} of it",
            high=high,
        )


def work() -> Iterator[Record]:
    """The energy that Q adds between two loads, and the work of friction on the slip."""
    beta, f = PAIR
    one, other = (
        solved(sie.Parabola(1.0), beta, f, normal_load=1.0, tangential_load=part * f)
        for part in (0.49, 0.51)
    )
    lo, hi = max(one.edges[0], other.edges[0]), min(one.edges[1], other.edges[1])
    angle = (np.arange(1000) + 0.5) * np.pi / 1000
    x = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(angle)
    dx = 0.5 * (hi - lo) * np.sin(angle) * np.pi / 1000
    carried = 0.5 * f * (one.pressure(x) + other.pressure(x))
    done = float(dx @ (carried * (other.slip(x) - one.slip(x))))
    added = other.energy_lost - one.energy_lost
    half = float(dx @ (carried * (other.slip(x) - one.slip(x)) * (x > 0.0)))
    yield Claim(
        "energy that Q adds between two loads against the work of friction on the slip",
        "the balance of work, second order in the step of Q",
        abs(added / done - 1.0),
        abs(added / half - 1.0),
        "the work in x > 0 alone",
        high=1e-3,
    )


def approximation(betas: tuple[float, ...]) -> Iterator[Record]:
    """The error of Goodman's approximation at f = β."""

    def apart(beta: float, friction: float) -> tuple[float, float]:
        full, rough = (
            solved(sie.Parabola(1.0), beta, friction, normal_load=1.0, coupling=coupling)
            for coupling in ("full", "goodman")
        )
        c = [one.stick[0][1] / one.half_width for one in (full, rough)]
        p = [float(one.pressure(0.0)) for one in (full, rough)]
        return c[1] / c[0] - 1.0, abs(p[1] / p[0] - 1.0)

    both = np.array([apart(beta, beta) for beta in betas])
    order = np.log(both[1, 0] / both[0, 0]) / np.log(betas[1] / betas[0])
    wrong = np.log(both[1, 0] / (both[0, 0] + OFF)) / np.log(betas[1] / betas[0])
    yield Claim(
        "order in β at which c/b of Goodman's approximation, f = β, leaves the coupled one",
        "this project: the pressure changes by β q, which is of the order β f",
        float(order),
        float(wrong),
        f"c/b off by {OFF:.0e} at the smaller β",
        low=1.9,
        high=2.1,
    )
    yield Curve("Goodman", "c/b", betas, both[:, 0], "both")
    yield Curve("Goodman", "p(0) of a parabola", betas, both[:, 1], "both")


def under_tangential_load(parts: tuple[float, ...]) -> Iterator[Record]:
    """Goodman's approximation from Q = 0 to sliding, parabola."""
    beta, f = 0.1, 0.1
    ends, residuals, wrong = [], [], []
    for part in parts:
        loads = {"normal_load": 1.0, "tangential_load": part * f}
        solution = solved(sie.Parabola(1.0), beta, f, coupling="goodman", **loads)
        residuals.append(of_shear(solution.check()))
        scene = replace(solution.scene, dundurs=beta * (1.0 + OFF))
        wrong.append(shear_certificate(solution.coupled[1], scene, 1e-13).residual)
        ends.append([c / solution.half_width for c in solution.stick[0]])
    yield Claim(
        "largest residual of (12) in stick over the largest shear under Q, Goodman's approximation",
        "this project: a certificate on every answer",
        largest(residuals),
        smallest(wrong),
        f"β off by {OFF:.0e} of it",
        high=SHEAR,
    )
    for k, side in enumerate(("left end of stick", "right end of stick")):
        yield Curve("tangential", side, parts, [end[k] for end in ends], "both")
