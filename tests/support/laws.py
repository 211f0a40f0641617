"""What every contact obeys, measured from values of the pressure alone, in doubles, by a quadrature
of the tests' own.

    x = m - r cos ψ,  ψ in [0, π],  dx = r sin ψ dψ

16 Gauss-Legendre nodes on panels graded to every break and halved between them.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Pressure = Callable[[Array], Any]
Ends = tuple[float, float]
Places = Sequence[float]

GRADED_TO = 1e-13  # of the panel at a break: the logarithm left there weighs less than rounding
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def rule(interval: Ends, breaks: Places = (), extra: Places = ()) -> tuple[Array, Array]:
    """Nodes x inside the contact and weights of ∫ dx, graded to the breaks and to `extra`."""
    x1, x2 = interval
    m, r = 0.5 * (x1 + x2), 0.5 * (x2 - x1)
    inner = [b for b in {*breaks, *extra} if x1 < b < x2]
    marks = np.array([0.0, *sorted(np.arccos(np.clip((m - b) / r, -1, 1)) for b in inner), np.pi])
    cuts = [marks]
    for lo, hi in pairwise(marks):
        steps = (hi - lo) * 0.5 * 0.25 ** np.arange(0, 40)
        steps = steps[steps > GRADED_TO]
        # towards an edge nothing is graded: in ψ even a sharp one is smooth, and x next to it has
        # no digits
        cuts += [
            lo + (hi - lo) * np.linspace(0, 1, 25),
            lo + steps * (lo > 0.0),
            hi - steps * (hi < np.pi),
        ]
    ends = np.unique(np.concatenate(cuts))
    ends = ends[(ends >= 0.0) & (ends <= np.pi)]
    half = 0.5 * np.diff(ends)
    psi = (0.5 * (ends[:-1] + ends[1:])[:, None] + half[:, None] * NODES).ravel()
    x = np.where(
        psi < 0.5 * np.pi, x1 + 2 * r * np.sin(0.5 * psi) ** 2, x2 - 2 * r * np.cos(0.5 * psi) ** 2
    )
    weight = (half[:, None] * WEIGHTS).ravel() * r * np.sin(psi)
    keep = (x > x1) & (x < x2) & ~np.isin(x, breaks)
    return x[keep], weight[keep]


def load_and_moment(pressure: Pressure, interval: Ends, breaks: Places = ()) -> tuple[float, float]:
    """∫p dx and ∫p (x - m) dx."""
    x, weight = rule(interval, breaks)
    p = weight * pressure(x)
    return float(p.sum()), float((p * (x - 0.5 * (interval[0] + interval[1]))).sum())


def principal_value(pressure: Pressure, interval: Ends, x: float, breaks: Places = ()) -> float:
    """1/π PV∫ p(t)/(x - t) dt at one x inside: the integral of p(x) is a logarithm."""
    x1, x2 = interval
    t, weight = rule(interval, breaks, extra=(x,))
    here = float(pressure(np.array([x]))[0])
    t, weight = t[t != x], weight[t != x]
    return (
        float((weight * (pressure(t) - here) / (x - t)).sum() + here * np.log((x - x1) / (x2 - x)))
        / np.pi
    )


def rounding_of_principal_value(
    pressure: Pressure, interval: Ends, x: float, breaks: Places = ()
) -> float:
    """What `principal_value` changes by if p does by the rounding of its places t and x."""
    x1, x2 = interval
    t, weight = rule(interval, breaks, extra=(x,))
    t, weight = t[t != x], weight[t != x]
    middle = 0.5 * (x1 + x2)

    def change(at: Array) -> Any:
        return np.abs(pressure(np.nextafter(at, middle)) - pressure(at))

    here = float(change(np.array([x]))[0])
    of_x = (weight / np.abs(x - t)).sum() + abs(np.log((x - x1) / (x2 - x)))
    return float((weight * change(t) / np.abs(x - t)).sum() + here * of_x) / np.pi


def rounding_of_x(pressure: Pressure, interval: Ends, breaks: Places = ()) -> float:
    """∫|p(x + 1 ulp) - p(x)| dx: what no pressure of a double x can avoid."""
    x, weight = rule(interval, breaks)
    beside = np.nextafter(x, 0.5 * (interval[0] + interval[1]))
    return float((weight * np.abs(pressure(beside) - pressure(x))).sum())


def peak(pressure: Pressure, interval: Ends, breaks: Places = ()) -> float:
    """The largest pressure 1e-3 r from the edges and 1e-6 r from the breaks, or farther."""
    x1, x2 = interval
    r = 0.5 * (x2 - x1)
    beside = [b + 1e-6 * r * side for b in breaks for side in (-1.0, 1.0)]
    x = np.append(np.linspace(x1 + 1e-3 * r, x2 - 1e-3 * r, 201), beside)
    return float(pressure(x[(x > x1) & (x < x2) & ~np.isin(x, breaks)]).max())
