"""The paper's appendix: each side of each equation to 50 digits, and both packages.

The left-hand sides are principal values by quadrature in mpmath; "identity" is how many digits the
right-hand side agrees to. The closed forms of `analytic` are evaluated in mpmath and in NumPy, and
`sie` is given a profile whose pressure is that integral (`validation.appendix_equations`). Where
the form that our copy of the paper prints is not the identity, its digits are listed as errata.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from validation.appendix_equations import DIGITS, EQUATIONS, Equation, Setting, mp
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Doing, Record, Table

TITLE = "The appendix: (24) to (35)"
SECONDS = (1.5, 3.0)
TIMED = False

WRONG = mp.mpf(10) ** -20  # relative change of φ0 that a checker of 50 digits must detect

# (a, b, x, R): doubles, so that both packages solve the same problem
QUICK = ((0.5, 1.25, 0.75, 2.0),)
CASES = (
    *QUICK,
    (0.25, 1.5, 0.125, 1.0),
    (0.875, 1.125, 1.0, 0.5),
    (0.0625, 2.0, -1.5, 3.0),
    (0.75, 0.8125, 0.25, 100.0),
)


def digits(value: Any, truth: Any) -> float:
    """The number of digits that agree: -log10 of the relative difference, at most the context's."""
    difference = abs(mp.mpmathify(value) / truth - 1)
    return smallest((mp.dps, -mp.log10(difference) if difference else mp.inf))


NAMES = ("identity", "printed", "analytic in mpmath", "analytic in NumPy", "sie")


def agreed(equation: Equation, s: Setting) -> dict[str, float]:
    """Digits of each form in the left-hand side; only those that there are."""
    truth = equation.left(s)
    found = {"identity": digits(equation.right(s), truth)}
    if equation.printed is not None:
        found["printed"] = digits(equation.printed(s), truth)
    if equation.closed is not None:
        found |= {
            "analytic in mpmath": digits(equation.closed(s, mp), truth),
            "analytic in NumPy": digits(equation.closed(s, np), truth),
        }
    if equation.solver is not None:
        found["sie"] = digits(equation.solver(s), truth)
    return found


def wrong_digits(equation: Equation, s: Setting, spoiled: Setting) -> dict[str, float]:
    """The same for wrong inputs: φ0 or a off by WRONG, or answers rounded to ten digits."""
    truth = equation.left(s)
    found = {"identity": digits(equation.right(spoiled), truth)}
    if equation.closed is not None:
        exactly = digits(equation.closed(replace(s, a=mp.mpf(s.a) * (1 + WRONG)), mp), truth)
        found |= {
            "analytic in mpmath": exactly,
            "analytic in NumPy": digits(_to_ten(equation.closed(s, np)), truth),
        }
    if equation.solver is not None:
        found["sie"] = digits(_to_ten(equation.solver(s)), truth)
    return found


def _to_ten(value: float) -> float:
    return float(f"{float(value):.9e}")


def compute(quick: bool) -> Iterator[Record]:
    rows: list[tuple[Any, ...]] = []
    # Each setting keeps its integrals.
    settings = [Setting(*case) for case in (QUICK if quick else CASES)]
    spoiled = Setting(*QUICK[0], spoiled=WRONG)
    for equation in EQUATIONS:
        yield Doing(equation.name)
        found = [agreed(equation, s) for s in settings]
        least = {name: smallest(f[name] for f in found) for name in found[0]}
        most = largest(f.get("printed", 0.0) for f in found)
        yield from _claims(equation, least, most, wrong_digits(equation, settings[0], spoiled))
        rows.append((equation.name, equation.says, *(least.get(name) for name in NAMES)))
    yield Table(
        "Digits agreed with principal-value quadrature, the fewest over the cases",
        ("equation", "says", *NAMES), rows,
        "Cases (a, b, x, R): " + "; ".join(map(str, QUICK if quick else CASES)),
    )  # fmt: skip
    for name in NAMES:
        some = [
            (k, row[2 + NAMES.index(name)])
            for k, row in enumerate(rows)
            if row[2 + NAMES.index(name)] is not None
        ]
        yield Curve(
            "digits",
            name,
            [k for k, _ in some],
            [v for _, v in some],
            "points",
            {"names": [row[0] for row in rows]},
        )


def _claims(
    equation: Equation, least: dict[str, float], printed: float, wrong: dict[str, float]
) -> Iterator[Claim]:
    named = "φ0 changed by 1e-20 of itself"
    yield Claim(
        f"{equation.name}, {equation.says}: digits",
        "paper, appendix",
        least["identity"],
        wrong["identity"],
        named,
        low=DIGITS - 1,
    )
    if "printed" in least:
        yield Claim(
            f"{equation.name} as printed: digits", "paper, appendix (our copy)", printed,
            least["identity"], "the corrected form",
            low=DIGITS - 1, erratum=equation.erratum,
        )  # fmt: skip
    for name, low in (
        ("analytic in mpmath", DIGITS - 1),
        ("analytic in NumPy", 14.0),
        ("sie", 13.0),
    ):
        if name in least:
            words = (
                "a changed by 1e-20 of itself" if low > 20 else "the answer rounded to ten digits"
            )
            yield Claim(
                f"{equation.name}, {name}: digits",
                "README",
                least[name],
                wrong[name],
                words,
                low=low,
            )
