"""Wrong programs by name: the error, and the resulting pressure.

The certificate must detect each, whatever its size.

`Wrong` stands in for a solution's pressure. Some are formulas with a term wrong, some are this
package with one of its parts replaced.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import sie

Array = np.ndarray[Any, Any]
Values = Callable[[Array], Array]


class Wrong:
    """A density with other values; `claims` are wrong attributes (resultant, moment)."""

    def __init__(self, density: Any, values: Values, **claims: Any) -> None:
        self.__dict__.update(claims, right=density, values=values)

    def __call__(self, x: Any) -> Array:
        return self.values(np.asarray(x, dtype=float))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.right, name)


def with_pressure(scene: sie.Scene, values: Values | None = None, **claims: Any) -> sie.Solution:
    """A solution whose pressure has other values, and whose attributes may be wrong."""
    solution = sie.solve(scene)
    right = solution.pressure
    solution.__dict__["pressure"] = Wrong(right, values or right, **claims)
    return solution


class WrongState:
    """A state of slip with another shear."""

    def __init__(self, state: Any, shear: Wrong) -> None:
        self.right, self.shear = state, shear

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.right, name)


def with_shear(scene: sie.Scene, values: Values) -> sie.Solution:
    """A solution whose shear takes other values."""
    solution = sie.solve(scene)
    state = solution.tangential
    solution.__dict__["tangential"] = WrongState(state, Wrong(state.shear, values))
    return solution


PUNCH = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, half_width=1.0)
SKEW = sie.Scene(
    profile=sie.Piecewise((-0.5, 1.0), ((0.25, 0.5), (0.0,), (-2.0, 2.0))),
    modulus=1.0,
    half_width=1.125,
)
SMOOTH = sie.Scene(
    profile=sie.FromFunction(np.sinh, domain=(-30.0, 30.0), parity="even"),
    modulus=1.0,
    half_width=1.5,
)


def closed_form(x: Any, second: float = 1.0, b: float = 1.0) -> Array:
    """The pressure of PUNCH (Ciavarella, Hills & Monno 1998, eq. 32); `second` multiplies the
    second logarithm.
    """
    a = 0.5
    x = np.abs(x)
    phi, phi0 = np.arcsin(np.clip(x / b, 0, 1)), np.arcsin(a / b)
    with np.errstate(all="ignore"):
        first = x * np.log(np.abs(np.sin(phi + phi0) / np.sin(phi - phi0)))
        logs = first + second * a * np.log(
            np.abs(np.tan((phi + phi0) / 2) * np.tan((phi - phi0) / 2))
        )
    return ((np.pi - 2 * phi0) * b * np.cos(phi) + np.where(np.isfinite(logs), logs, 0.0)) / (
        2 * np.pi
    )


def root(x: Any) -> Array:
    return np.sqrt(np.maximum((1 - x) * (1 + x), 1e-30))


def gauss_chebyshev(
    scene: sie.Scene, n: int = 40, shift: float = 0.0, at: int = 7, half: float = 0.0
) -> Values:
    """p = E*/2 sqrt(1 - s²) Σ g_{k+1} U_k(s) from n nodes, one of them shifted, or all of them by
    `half` a spacing.
    """
    solution = sie.solve(scene)
    m, r = solution.centre, solution.half_width
    theta = (np.arange(n) + 0.5 + half) * np.pi / n
    s = np.cos(theta)
    s[at] += shift
    H = scene.profile.slope(m + r * s) + solution.tilt
    theta = (np.arange(n) + 0.5) * np.pi / n
    g = 2 / n * np.cos(np.arange(n)[:, None] * theta) @ H

    def values(x: Any) -> Array:
        phi = np.arccos(np.clip((x - m) / r, -1, 1))
        return 0.5 * scene.Estar * np.sin(np.arange(1, n) * phi[..., None]) @ g[1:]

    return values
