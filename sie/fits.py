"""What a trace is like: the straight line through it, and the rounded flat that comes nearest.

    h = c + t x + (|x - x0| - a)_+² / (2R)          a flat base of half-length a, arcs of radius R, centre x0, tilt t

c, t and 1/R enter linearly, so that the search is for x0 and a alone (variable projection, Golub & Pereyra 1973): a scan of both first,
since a trace of a nearly flat pad has other minima, then least squares with all five.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SCAN = 24  # values of x0 and of a in the scan
MOST_SCANNED = 2000  # points of the trace


@dataclass(frozen=True)
class RoundedFlatFit:
    """h ≈ offset + tilt x + (|x - centre| - half_flat)_+² / (2 radius), by least squares.

    rms, largest    what is left of h: the root of the mean square, and the largest
    residuals       at every point of the trace

    The profile is `sie.RoundedFlat(fit.half_flat, fit.radius).shifted(fit.centre).tilted(fit.tilt)`.
    """

    half_flat: float
    radius: float
    centre: float
    tilt: float
    offset: float
    residuals: tuple[float, ...]

    @property
    def rms(self) -> float:
        return float(np.sqrt(np.mean(np.square(self.residuals))))

    @property
    def largest(self) -> float:
        return float(np.abs(self.residuals).max())

    def __repr__(self) -> str:
        numbers = ", ".join(f"{name}={getattr(self, name):.6g}" for name in ("half_flat", "radius", "centre", "tilt", "offset"))
        return f"RoundedFlatFit({numbers}; residuals {self.rms:.2g} rms, {self.largest:.2g} at most)"


def line(x: Array, h: Array) -> tuple[float, float]:
    """(height at x = 0, slope) of the least-squares line."""
    m = float(x.mean())
    slope = float((x - m) @ (h - h.mean()) / ((x - m) @ (x - m)))
    return float(h.mean()) - slope * m, slope


def rounded_flat(x: Array, h: Array) -> RoundedFlatFit:
    """The nearest rounded flat. Raises ValueError where the trace does not rise on both sides of a base."""
    from scipy.optimize import least_squares  # noqa: PLC0415

    m, r = 0.5 * float(x[0] + x[-1]), 0.5 * float(x[-1] - x[0])
    scale = float(np.ptp(h)) or 1.0
    s, y = (x - m) / r, (h - h.mean()) / scale

    def model(s0: float, a: float) -> Array:
        return np.stack((np.ones_like(s), s, 0.5 * np.maximum(np.abs(s - s0) - a, 0.0) ** 2), axis=1)

    start = _scanned(s, y)
    linear = np.linalg.lstsq(model(*start), y, rcond=None)[0]
    found = least_squares(lambda v: model(v[0], v[1]) @ v[2:] - y, [*start, *linear], xtol=1e-14, ftol=1e-14, gtol=1e-14)
    s0, a, c, t, curvature = found.x.tolist()
    a = abs(a)
    rises = np.abs(s - s0) > a
    if curvature <= 0.0 or not (rises & (s < s0)).any() or not (rises & (s > s0)).any():
        raise ValueError(
            "no flat with rounded edges is near this trace: it must rise on both sides of a base; "
            "a trace of surface heights has the other sign, scale = (1, -1) turns it over"
        )
    residuals = h - (scale * (model(s0, a) @ [c, t, curvature]) + h.mean())
    tilt = scale * t / r
    return RoundedFlatFit(
        half_flat=a * r,
        radius=r * r / (scale * curvature),
        centre=m + s0 * r,
        tilt=tilt,
        offset=scale * c + float(h.mean()) - tilt * m,
        residuals=tuple(residuals.tolist()),
    )


def _scanned(s: Array, y: Array) -> tuple[float, float]:
    """(s0, a) with the least sum of squares on a grid, among arcs that rise."""
    step = max(len(s) // MOST_SCANNED, 1)
    s, y = s[::step], y[::step]
    best, place = np.inf, (0.0, 0.5)
    for s0 in np.linspace(-0.8, 0.8, SCAN).tolist():
        for a in np.linspace(0.0, 0.95, SCAN).tolist():
            arcs = 0.5 * np.maximum(np.abs(s - s0) - a, 0.0) ** 2
            A = np.stack((np.ones_like(s), s, arcs), axis=1)
            normal = A.T @ A
            if np.linalg.cond(normal) > 1e12:
                continue
            c = np.linalg.solve(normal, A.T @ y)
            misfit = float(((y - A @ c) ** 2).sum())
            if c[2] > 0.0 and misfit < best:
                best, place = misfit, (s0, a)
    return place
