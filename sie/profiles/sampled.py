"""An indenter given by a trace: heights that a profilometer measured, a spline through them or along them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Integral
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.errors import ContactError

from . import fitting
from .base import Derived, Placed, Profile, of_any_x
from .slope import Slope
from .splines import (
    cross_validated,
    explains,
    interpolating_spline,
    longest_lambda,
    smoothing_spline,
)
from .trace_files import Column, is_text, read_columns, read_topography

Array = NDArray[np.float64]
Smoothing = float | Literal["gcv"]
INF = float("inf")

FEWEST = 4  # points of a cubic
SHOWN = 60  # points that are printed; a longer trace is summed up
SMALLEST_STEP = 1e-12  # of the trace's length
SHORTEST, LONGEST = 1e-100, 1e100  # of lengths and heights: beyond, their powers are no doubles


class Mended(NamedTuple):
    """What `mend` did to a trace.

    left_out    points without a value
    averaged    points that were averaged with others of the same x, to rounding
    sorted      whether x did not ascend
    """

    left_out: int = 0
    averaged: int = 0
    sorted: bool = False


@dataclass(frozen=True, init=False, repr=False, eq=False)
class Sampled(Profile):
    """h at the points x: the gap, which grows away from the contact. (A trace of a surface's height has the other sign.)

    x, h        ascending points without gaps in the numbers, and heights, at least 4 of each, in the same unit of length
    smoothing   0: the interpolating cubic spline, not-a-knot at the ends (SciPy's CubicSpline): for traces without noise
                λ > 0: the smoothing spline that minimises Σ(h - f(x))² + λ∫f''² (SciPy's make_smoothing_spline), λ in length³
                "gcv": the same, λ chosen by generalised cross validation
    mend        sort x, average the heights of equal x and leave out what is nan, instead of refusing it; `mended` tells what it did

    The slope is a quadratic polynomial on each piece. Beyond the trace's ends nothing is known: a contact that would reach an end is
    refused (the end of a trace is not a corner of the indenter). Raises ValueError for anything that is not a trace.

    >>> x = np.linspace(-1.0, 1.0, 201)
    >>> pad = Sampled(x, x**2 / 100.0)
    >>> pad
    Sampled(x=<201 points from -1 to 1>, h=<from 0 to 0.01>)
    >>> round(float(pad.slope(0.25)), 12)
    0.005
    """

    points: Array
    heights: Array
    smoothing: Smoothing
    mended: Mended
    source: str

    def __init__(
        self, x: ArrayLike, h: ArrayLike, smoothing: Smoothing = 0.0, mend: bool = False
    ) -> None:
        points, heights, mended = _trace(x, h, mend)
        for array in (points, heights):
            array.flags.writeable = False
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "smoothing", _smoothing(smoothing, points))
        object.__setattr__(self, "mended", mended)
        object.__setattr__(self, "source", "")

    @classmethod
    def read(
        cls,
        path: str | Path,
        columns: tuple[Column, Column] = (0, 1),
        scale: float | tuple[float, float] = 1.0,
        skip: int = 0,
        *,
        smoothing: Smoothing = 0.0,
        mend: bool = False,
    ) -> Sampled:
        """The trace in a file: text in columns, or (with the extra `traces`) any format that SurfaceTopography reads.

        columns     of x and h, by number from 0 or by their names in the header
        scale       factors for x and h, or one for both: 1e-3 makes mm of µm; a negative one for h turns a surface's height into a gap
        skip        lines at the top to pass over; comments (#, %) and headers are passed over anyway
        smoothing, mend    as in `Sampled`; mend leaves out lines that lack a value

        Raises ValueError, with the numbers of the lines, where values are missing, and OSError where there is no file.
        """
        factors = _factors(scale)
        if is_text(path):
            pair = arguments.listed("columns", columns, "those of x and of h")
            if len(pair) != 2 or not all(isinstance(column, (Integral, str)) for column in pair):
                raise ValueError(
                    f"columns = {columns!r} is not a pair: give the columns of x and of h"
                )
            if isinstance(skip, bool) or not isinstance(skip, Integral) or skip < 0:
                raise ValueError(f"skip = {skip!r} is not a number of lines: give 0 or more")
            x, h = read_columns(path, pair, int(skip), keep_missing=mend)
        else:
            x, h = read_topography(path)
        with np.errstate(over="ignore"):
            scaled = factors[0] * x, factors[1] * h
        if (np.isinf(scaled) & np.isfinite((x, h))).any():
            raise ValueError(
                f"scale = {scale!r} takes the trace beyond the range of doubles: {arguments.REMEDY}"
            )
        made = cls(*scaled, smoothing, mend)
        given = {
            "columns": (columns, (0, 1)),
            "scale": (scale, 1.0),
            "skip": (skip, 0),
            "smoothing": (smoothing, 0.0),
            "mend": (mend, False),
        }
        options = "".join(
            f", {name}={value!r}" for name, (value, default) in given.items() if value != default
        )
        object.__setattr__(made, "source", f"Sampled.read({str(path)!r}{options})")
        return made

    def __repr__(self) -> str:
        if self.source:
            return self.source
        x, h = self.points, self.heights
        if len(x) <= SHOWN:
            named = f"x={tuple(x.tolist())!r}, h={tuple(h.tolist())!r}"
        else:
            named = f"x=<{len(x)} points from {x[0]:.6g} to {x[-1]:.6g}>, h=<from {h.min():.6g} to {h.max():.6g}>"
        return f"Sampled({named}{f', smoothing={self.smoothing!r}' if self.smoothing else ''})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sampled):
            return NotImplemented
        same = self.smoothing == other.smoothing and len(self.points) == len(other.points)
        return same and bool(
            (self.points == other.points).all() and (self.heights == other.heights).all()
        )

    def __hash__(self) -> int:
        return hash((self.points.tobytes(), (self.heights + 0.0).tobytes(), self.smoothing))

    # -- the spline ---------------------------------------------------------------------------------------------------

    @cached_property
    def lam(self) -> float:
        """λ of the smoothing spline in use; 0 where the spline interpolates."""
        return (
            cross_validated(self.points, self.heights)
            if self.smoothing == "gcv"
            else float(self.smoothing)
        )

    @cached_property
    def _spline(self) -> tuple[Array, Array]:
        """(breaks, coefficients of h about the left end of each piece, low order first)."""
        return (
            smoothing_spline(self.points, self.heights, self.lam)
            if self.lam
            else interpolating_spline(self.points, self.heights)
        )

    @cached_property
    def pieces(self) -> Slope:
        breaks, c = self._spline
        return Slope(breaks, breaks[:-1], c[:, 1:] * np.arange(1.0, 4.0), np.full(len(c), 2))

    @of_any_x
    def height(self, x: ArrayLike) -> Array:
        breaks, c = self._spline
        x = arguments.reals("x", x)
        k = np.clip(np.searchsorted(breaks, x, side="right") - 1, 0, len(c) - 1)
        u = x - breaks[k]
        h = c[k, 0] + u * (c[k, 1] + u * (c[k, 2] + u * c[k, 3]))
        return np.where((x < breaks[0]) | (x > breaks[-1]), INF, h)

    @property
    def ends_are_corners(self) -> tuple[bool, bool]:
        return False, False

    # -- what is known of the measurement -----------------------------------------------------------

    @property
    def misfit(self) -> float:
        """What the spline leaves of the heights, as the root of the mean square."""
        return float(np.sqrt(np.mean((self.heights - self.height(self.points)) ** 2)))

    @property
    def gaps(self) -> tuple[fitting.Gap, ...]:
        """Where points are missing: intervals much longer than the other steps of x; the spline bridges them."""
        return fitting.gaps(self.points)

    @cached_property
    def outliers(self) -> tuple[int, ...]:
        """The indices of points that stand out of the noise. They stay in the trace."""
        return fitting.outliers(self.points, self.heights)

    @cached_property
    def _cleaned(self) -> Sampled:
        """The trace less its outliers, smoothed by cross validation."""
        kept = np.delete(np.arange(len(self.points)), self.outliers)
        return Sampled(self.points[kept], self.heights[kept], "gcv")

    def reference(self, between: tuple[float, float]) -> Sampled:
        """The best guess of the surface without noise: less its outliers, by cross validation.

        Where its own smoothing is stronger, and the misfit between two x agrees with it: by that.
        """
        clean = self if self.smoothing == "gcv" and not self.outliers else self._cleaned
        as_good = self.lam > clean.lam and explains(
            clean.points, clean.heights, self.lam, clean.lam, between
        )
        return clean.smoothed(self.lam) if as_good else clean

    @property
    def line(self) -> tuple[float, float]:
        """(height at x = 0, slope) of the least-squares line, which `levelled` takes out."""
        return fitting.line(self.points, self.heights)

    # -- other traces made of this one ----------------------------------------------------------------------------------

    def smoothed(self, smoothing: Smoothing = "gcv") -> Sampled:
        """The same trace with another smoothing."""
        return self._remade(self.heights, smoothing)

    def levelled(self, between: tuple[float, float] | None = None) -> Sampled:
        """The trace less the least-squares line through it, or through its part between two x (a flat base, or what is beside a pad)."""
        lo, hi = (
            (-INF, INF) if between is None else (arguments.real("between", end) for end in between)
        )
        part = (self.points >= lo) & (self.points <= hi)
        if np.count_nonzero(part) < 2:
            raise ValueError(
                f"between = ({lo:g}, {hi:g}) holds {np.count_nonzero(part)} points of the trace: a line needs at least 2"
            )
        offset, slope = fitting.line(self.points[part], self.heights[part])
        return self._remade(self.heights - (offset + slope * self.points), self.smoothing)

    def fit_rounded_flat(self) -> fitting.RoundedFlatFit:
        """Half-flat a, radius R, centre and tilt of the rounded flat nearest to the measured points, with what it leaves of them."""
        return fitting.rounded_flat(self.points, self.heights)

    def _remade(self, heights: Array, smoothing: Smoothing) -> Sampled:
        made = Sampled(self.points, heights, smoothing)
        object.__setattr__(made, "mended", self.mended)
        return made


# -- traces in other profiles ----------------------------------------------------------------------


class PlacedTrace(NamedTuple):
    """A trace in a profile: its x is direction x + origin, its slope counts times direction, + tilt."""

    trace: Sampled
    direction: float = 1.0
    origin: float = 0.0
    tilt: float = 0.0

    def x(self, points: Array) -> Array:
        """Where points of the trace are in the profile."""
        return self.direction * (points - self.origin)


def traces_in(profile: Profile) -> Iterator[PlacedTrace]:
    """The traces that a profile is made of, tilted, shifted, mirrored and added as it may be."""
    parts = profile.placed if isinstance(profile, Derived) else (Placed(profile, 1.0, 0.0, 0.0),)
    for part, sign, shift, tilt in parts:
        if isinstance(part, Sampled):
            yield PlacedTrace(part, sign, -sign * shift, tilt)


def explained(error: ContactError, profile: Profile) -> ContactError:
    """The refusal of a contact, with the reason and the remedy that a trace has. Nothing is solved."""
    trace = next((placed.trace for placed in traces_in(profile)), None)
    if trace is None or not error.reached:
        return error
    if "end" in error.reached:
        advice = fitting.reason_at_an_end(trace.points, trace.heights)
    else:
        advice = "sie.least_smoothing(scene) finds how much smoothing makes it one patch"
    return type(error)(f"{error.args[0]}; {advice}", **error.reached) if advice else error


# -- what is not a trace -------------------------------------------------------------------------------------------------


def _trace(x: ArrayLike, h: ArrayLike, mend: bool) -> tuple[Array, Array, Mended]:
    points, heights = (_numbers(name, values) for name, values in (("x", x), ("h", h)))
    if len(points) != len(heights):
        raise ValueError(
            f"{len(points)} values of x and {len(heights)} of h: give a height for each point"
        )
    missing = ~(np.isfinite(points) & np.isfinite(heights))
    mended = Mended()
    if missing.any():
        if not mend:
            k = int(np.argmax(missing))
            raise ValueError(
                f"{np.count_nonzero(missing)} of {len(points)} points of the trace are not finite, the first x[{k}] = {points[k]:g}, "
                f"h[{k}] = {heights[k]:g}: leave them out, or give mend = True"
            )
        points, heights = points[~missing], heights[~missing]
    if mend:
        points, heights, averaged, in_disorder = _ascending(points, heights)
        mended = Mended(int(np.count_nonzero(missing)), averaged, in_disorder)
    wrong = np.flatnonzero(np.diff(points) <= 0.0)
    if wrong.size:
        k = int(wrong[0])
        what = (
            "is given twice"
            if points[k] == points[k + 1]
            else f"is followed by {points[k + 1]:.9g}"
        )
        raise ValueError(
            f"x does not ascend at {len(wrong)} places, the first x[{k}] = {points[k]:.9g} {what}: "
            "mend = True sorts x and averages the heights of equal x"
        )
    if len(points) < FEWEST:
        raise ValueError(
            f"{len(points)} points are no trace: a cubic spline needs at least {FEWEST}"
        )
    _refuse_out_of_range(points, heights)
    return points, heights, mended


def _ascending(x: Array, h: Array) -> tuple[Array, Array, int, bool]:
    """x sorted, heights of the same x (to rounding) averaged, how many fewer, x in disorder or not."""
    order = np.argsort(x, kind="stable")
    x, h, in_disorder = x[order], h[order], bool((np.diff(order) < 0).any())
    closest = SMALLEST_STEP * (0.5 * x[-1:] - 0.5 * x[:1])
    first = np.append(True, np.diff(x) > closest)[: len(x)]
    count = np.diff(np.append(np.flatnonzero(first), len(x)))
    means = np.bincount(np.cumsum(first) - 1, h) / count
    return x[first], means, len(x) - len(count), in_disorder


def _refuse_out_of_range(points: Array, heights: Array) -> None:
    length = 0.5 * points[-1] - 0.5 * points[0]
    size = max(float(np.abs(points).max()), float(np.abs(heights).max()))
    least = float(np.diff(points).min())
    if size > LONGEST or length < SHORTEST:
        what = f"reaches {size:.3g}" if size > LONGEST else f"is {2.0 * length:.3g} long"
        raise ValueError(
            f"the trace {what}: choose a unit in which its length and its heights are between {SHORTEST:g} and {LONGEST:g}"
        )
    if least < SMALLEST_STEP * length:
        k = int(np.argmin(np.diff(points)))
        raise ValueError(
            f"x[{k}] = {points[k]:.17g} and x[{k + 1}] = {points[k + 1]:.17g} differ by rounding: "
            "leave one of them out, or give mend = True, which averages them"
        )


def _numbers(name: str, values: Any) -> Array:
    try:
        given = np.asarray(values)
        array = np.array(given, dtype=float) if given.dtype.kind in "biufO" else None
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None:
        raise ValueError(f"{name} is not a list of numbers: give an array of floats")
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}: give a list of numbers")
    return array + 0.0  # no -0.0: equal traces have equal hashes


def _smoothing(smoothing: Any, points: Array) -> Smoothing:
    if arguments.among(smoothing, ("gcv",)):
        return "gcv"
    if isinstance(smoothing, str):
        raise ValueError(
            f'smoothing = {smoothing!r} is not known: give 0, a number λ > 0, or "gcv"'
        )
    lam = arguments.not_negative("smoothing", smoothing)
    if lam > longest_lambda(points):
        raise ValueError(
            f"smoothing = {lam:g} leaves a straight line of the trace: give less than {longest_lambda(points):.3g}"
        )
    return lam


def _factors(scale: Any) -> Sequence[float]:
    factors = tuple(scale) if isinstance(scale, (tuple, list)) else (scale, scale)
    if len(factors) != 2:
        raise ValueError(
            f"scale = {scale!r} is not a factor or a pair: give one for x and one for h"
        )
    factors = tuple(arguments.finite("scale", f) for f in factors)
    if factors[0] <= 0.0 or factors[1] == 0.0:
        raise ValueError(
            f"scale = {scale!r}: the factor of x must be positive and that of h not zero"
        )
    return factors
