"""The strength of the rounded punch, and the tension of its surface, by closed forms.

E* = b = R = 1; ratio is a/b. The closed forms share no code with the package, whose answers
`limit` and `weakest` give.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import minimize, minimize_scalar

from analytic import interior, rounded_flat
from sie import charts

NU = charts.POISSON


def form(ratio: float) -> dict[str, float]:
    return {"half_flat": ratio, "half_width": 1.0, "radius": 1.0, "modulus": 1.0}


def root_j2(ratio: float, f: float, x: Any, y: Any) -> Any:
    """b √J2 / P by the closed forms."""
    if ratio:
        stress = interior.rounded_flat(x, y, **form(ratio), friction=f)
    else:
        stress = interior.hertz(x, y, half_width=1.0, radius=1.0, modulus=1.0, friction=f)
    P = rounded_flat.load(**form(ratio))
    return np.sqrt(interior.second_invariant(stress, poisson=NU)) / P


class Weakest(NamedTuple):
    """P/(bk), and where the material yields first; x and y in units of b."""

    limit: float
    x: float
    y: float


def closed_weakest(ratio: float, f: float) -> Weakest:
    """The weakest point by the closed forms: a scan and a simplex, inside and on the surface."""
    x, y = np.linspace(-1.2, 1.2, 97), np.linspace(0.02, 1.2, 60)[:, None]
    inside = root_j2(ratio, f, x, y)
    i, j = np.unravel_index(int(inside.argmax()), inside.shape)
    exact = {"xatol": 1e-9, "fatol": 1e-15}
    below = minimize(
        lambda v: -float(root_j2(ratio, f, v[0], abs(v[1]))),
        [x[j], y[i, 0]],
        method="Nelder-Mead",
        options=exact,
    )
    s = np.linspace(-1.0, 1.0, 2001)[1:-1]
    surface = root_j2(ratio, f, s, 0.0)
    k = int(surface.argmax())
    around = {
        "bounds": (s[max(k - 1, 0)], s[min(k + 1, len(s) - 1)]),
        "method": "bounded",
        "options": {"xatol": 1e-9},
    }
    top = minimize_scalar(lambda v: -float(root_j2(ratio, f, v, 0.0)), **around)
    if below.fun <= top.fun:
        return Weakest(-1.0 / float(below.fun), float(below.x[0]), abs(float(below.x[1])))
    return Weakest(-1.0 / float(top.fun), float(top.x), 0.0)


def limit(ratio: float, f: float = 0.0) -> float:
    """P/(bk) by the package."""
    return charts.punch(ratio, f).elastic_limit().ratio


def weakest(ratio: float, f: float) -> Weakest:
    """The weakest point by the package."""
    found = charts.punch(ratio, f).elastic_limit()
    return Weakest(found.ratio, *found.places[-1])


def closed_tension(ratio: float, c: Any) -> Any:
    """2 [E*(b-a)/(2R) - F_c(b)] over P/(πb); F_c the potential of the pressure in a contact of
    half-width c, none if c <= a.
    """
    P = rounded_flat.load(**form(ratio))

    def at(c: float) -> float:
        taken = 0.0
        if c > ratio:
            taken = complex(
                rounded_flat.potential(1.0, half_flat=ratio, half_width=c, radius=1.0, modulus=1.0)
            ).real
        return 2 * ((1 - ratio) / 2 - taken) * np.pi / P

    return np.array([at(float(v)) for v in np.atleast_1d(c)])
