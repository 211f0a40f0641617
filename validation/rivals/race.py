"""The common part of all races of `work_precision`: unit of time, colours, and curves."""

from __future__ import annotations

from typing import Any

import numpy as np

from analytic import rounded_flat
from validation.harness.records import Curve

PATIENCE = 0.04  # seconds for each point of a curve, about
PROMISE = 1e-13
COLOURS = {
    "this package": "black",
    "Gauss-Chebyshev, one series": "tab:blue",
    "collocation (sie.CauchyEquation)": "tab:green",
    "Erdogan-Gupta, dense": "tab:orange",
    "FFT boundary elements": "tab:red",
    "Tamaas": "tab:purple",
    "ContactMechanics": "tab:brown",
    "Gauss quadrature of the potential": "tab:orange",
    "the series (22), (23)": "tab:blue",
}
_X = np.linspace(-0.9995, 0.9995, 1001)

Point = tuple[int, float, float, float]  # size, error, seconds, ratio to the closed form


def closed_form() -> Any:
    """The unit of time: the closed form of the rounded punch by `analytic`, to full accuracy."""
    return rounded_flat.pressure(_X, half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0)


def curve(figure: str, name: str, points: list[Point], **about: Any) -> Curve:
    n, errors, seconds, ratios = map(list, zip(*points, strict=True))
    about |= {
        "colour": COLOURS[name],
        "strong": name == "this package",
        "sizes": n,
        "ratio to the closed form": ratios,
    }
    return Curve(figure, name, [1e3 * s for s in seconds], errors, "both", about)
