"""An indenter given by a trace: a cubic spline through measured heights, or along them."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.inheritance import override

from . import fitting
from .base import Profile
from .indenter import of_any_x
from .slope import Slope
from .splines import (
    Spline,
    cross_validated,
    interpolating_spline,
    longest_lambda,
    smoothing_spline,
)
from .trace_files import Column, read_trace
from .trace_units import Reading, Side, as_gap, factors, scale_of, side_of, stated
from .trace_values import Mended, Smoothing, checked, scaled, smoothing_of

Array = NDArray[np.float64]
SHOWN = 60  # points that are printed; a longer trace is summarised


class SplineProfile(Profile):
    """A profile by its spline; nothing is known beyond the ends, which are no corners."""

    @property
    @abstractmethod
    def _spline(self) -> Spline:
        """The spline, computed once."""

    @cached_property
    def pieces(self) -> Slope:
        """H of the spline, a parabola between neighbouring points."""
        return self._spline.slope

    @of_any_x
    @override
    def height(self, x: Array) -> Array:
        return self._spline(x)

    @property
    @override
    def ends_are_corners(self) -> tuple[bool, bool]:
        return False, False


@dataclass(frozen=True, init=False, repr=False, eq=False)
class Sampled(SplineProfile):
    """A measured profile: a cubic spline through the heights h at the points x, or along them.

    Parameters
    ----------
    x : array_like, shape (n,)
        At least 4 ascending lengths.
    h : array_like, shape (n,)
        Heights in the same unit. h is the gap, which grows away from the contact; the height of a
        surface has the other sign.
    smoothing : float or "gcv", default 0
        0 for the interpolating spline, not-a-knot at its ends, for traces without noise. λ > 0, in
        length³, for the smoothing spline. "gcv" chooses λ by generalised cross validation.
    mend : bool, default False
        Sort x, average the heights of equal x and leave out nan, instead of refusing them.

    Attributes
    ----------
    points, heights : ndarray, shape (n,)
        The trace, mended if that was asked for; both read-only.
    mended : Mended
        What `mend` did: `left_out`, `averaged` (numbers of points) and `sorted` (bool).
    reading : Reading
        How a file was read: `file`, `units`, `length`, `side`; empty without one.

    Raises
    ------
    ValueError
        If x and h are not a trace, or λ is so large that a straight line remains.

    Notes
    -----
    The smoothing spline minimises Σ(h - f(x))² + λ ∫f''² dx. h' is a quadratic polynomial on each
    piece. Nothing is known beyond the ends of the trace: a contact that would reach an end raises
    `ContactError`, as the end of a trace is no corner of the indenter. `Periodic` repeats a trace:
    where its ends meet, by a periodic spline.

    References
    ----------
    C. H. Reinsch (1967), Numer. Math. 10. G. Wahba (1990), Spline Models for Observational Data.

    Examples
    --------
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
    reading: Reading

    def __init__(
        self, x: ArrayLike, h: ArrayLike, smoothing: Smoothing = 0.0, mend: bool = False
    ) -> None:
        points, heights, mended = checked(x, h, mend)
        for array in (points, heights):
            array.flags.writeable = False
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "smoothing", smoothing_of(smoothing, longest_lambda(points)))
        self._noted(mended, Reading())

    @classmethod
    def read(
        cls,
        path: str | Path,
        columns: tuple[Column, Column] = (0, 1),
        scale: float | tuple[float, float] | None = None,
        skip: int = 0,
        *,
        units: str | tuple[str, str] = "",
        heights: Side | Literal[""] = "",
        length: str = "",
        smoothing: Smoothing = 0.0,
        mend: bool = False,
    ) -> Sampled:
        """The trace in a file.

        Parameters
        ----------
        path : str or Path
            Text in columns, or (with the extra `traces`) a format that SurfaceTopography reads.
        columns : pair of int or str, default (0, 1)
            The columns of x and h, by number from 0 or by name in the header. For text only.
        scale : float or pair of float, optional
            One factor for x and h, or one for each, in place of units: 1e-3 makes mm of µm. A
            negative factor for h turns the heights of a surface over.
        skip : int, default 0
            Lines at the top that are no part of the table. Comments (#, %) and headers are passed
            over without it. For text only.
        units : str or pair of str, optional
            The unit of the columns of the file, or of x and of h, like "um" or ("mm", "um"). Those
            that the head of the file states are used without it.
        heights : {"gap", "surface"}, optional
            What the column h is: the gap, or the height z of a surface, positive out of the
            material, whose gap max z - z is. The gap if it is not stated.
        length : str, optional
            The unit of lengths of the scene, to which the units are converted; mm need none.
        smoothing : float or "gcv", default 0
            As in `Sampled`.
        mend : bool, default False
            As in `Sampled`; lines that lack a value are left out too.

        Returns
        -------
        Sampled

        Raises
        ------
        ValueError
            If the file holds no trace; the message gives the numbers of the lines. If it states
            units and there is no length to convert them to, or a scale that contradicts them.
        OSError
            If the file cannot be read.

        Examples
        --------
        >>> Sampled.read("pad.csv", units="um", length="mm", heights="surface")  # doctest: +SKIP
        Sampled(x=<201 points from -2 to 2 in pad.csv>, h=<from 0 to 0.01>)
        """
        x, h, in_head = read_trace(path, columns, skip, keep_missing=mend)
        known, file, given = stated(units), Path(path).name, scale_of(scale)
        side = side_of(heights, given)
        known = known if any(known) else in_head
        x, h = scaled(x, h, factors(file, known, length, given))
        made = cls(x, as_gap(h) if heights == "surface" else h, smoothing, mend)
        converted, factor = length if any(known) else "", "" if scale is None else repr(scale)
        return made._noted(made.mended, Reading(file, known, converted, factor, side))

    def __repr__(self) -> str:
        x, h = self.points, self.heights
        if len(x) <= SHOWN:
            named = f"x={tuple(x.tolist())!r}, h={tuple(h.tolist())!r}"
        else:
            file = f" in {self.reading.file}" if self.reading.file else ""
            named = (
                f"x=<{len(x)} points from {x[0]:.6g} to {x[-1]:.6g}{file}>, "
                f"h=<from {h.min():.6g} to {h.max():.6g}>"
            )
        return f"Sampled({named}{f', smoothing={self.smoothing!r}' if self.smoothing else ''})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sampled):
            return NotImplemented
        return (
            self.smoothing == other.smoothing
            and np.array_equal(self.points, other.points)
            and np.array_equal(self.heights, other.heights)
        )

    def __hash__(self) -> int:
        return hash((self.points.tobytes(), (self.heights + 0.0).tobytes(), self.smoothing))

    # -- the spline -------------------------------------------------------------------------------

    @cached_property
    def lam(self) -> float:
        """λ of the smoothing spline, in length³; 0 if the spline interpolates."""
        if self.smoothing == "gcv":
            return cross_validated(self.points, self.heights)
        return float(self.smoothing)

    @cached_property
    def _spline(self) -> Spline:
        if self.lam:
            return smoothing_spline(self.points, self.heights, self.lam)
        return interpolating_spline(self.points, self.heights)

    # -- the quality of the measurement ---------------------------------------------------------

    @property
    def misfit(self) -> float:
        """Root mean square of h - spline over the points, a length."""
        return float(np.sqrt(np.mean((self.heights - self.height(self.points)) ** 2)))

    @property
    def gaps(self) -> tuple[fitting.Gap, ...]:
        """Steps of x much longer than the others, (lo, hi, missing): the spline bridges them."""
        return fitting.gaps(self.points)

    @cached_property
    def outliers(self) -> tuple[int, ...]:
        """Indices of the points that stand out of the noise. They stay in the trace."""
        return fitting.outliers(self.points, self.heights)

    @cached_property
    def cleaned(self) -> Sampled:
        """The trace less its outliers, smoothed by cross validation: the surface without noise."""
        if self.smoothing == "gcv" and not self.outliers:
            return self
        return self.without_outliers().smoothed("gcv")

    @property
    def line(self) -> tuple[float, float]:
        """(height at x = 0, slope) of the least-squares line, which `levelled` subtracts."""
        return fitting.line(self.points, self.heights)

    # -- other traces made of this one ------------------------------------------------------------

    def smoothed(self, smoothing: Smoothing = "gcv") -> Sampled:
        """The same trace with another smoothing.

        Parameters
        ----------
        smoothing : float or "gcv", default "gcv"
            As in `Sampled`.

        Returns
        -------
        Sampled
            A new trace with the same heights.

        Raises
        ------
        ValueError
            If the smoothing is none of the above, or leaves a straight line.

        Examples
        --------
        >>> Sampled([0, 1, 2, 3], [0, 1, 4, 9]).smoothed(0.5).lam
        0.5
        """
        return self._remade(self.points, self.heights, smoothing)

    def without_outliers(self) -> Sampled:
        """The trace without the points that stand out of its noise, `outliers`.

        Returns
        -------
        Sampled

        Examples
        --------
        >>> x = np.linspace(-1.0, 1.0, 101)
        >>> spiked = Sampled(x, np.where(x == 0.5, 0.3, x**2))
        >>> len(spiked.without_outliers().points)
        100
        """
        x, h = (np.delete(values, self.outliers) for values in (self.points, self.heights))
        return self._remade(x, h, self.smoothing)

    def levelled(self, between: tuple[float, float] | None = None) -> Sampled:
        """The trace less a least-squares line.

        Parameters
        ----------
        between : (float, float), optional
            The part of x, lengths, through which the line is laid: a flat base, or the surface
            beside a pad. The whole trace if it is not given.

        Returns
        -------
        Sampled
            A new trace with the same smoothing.

        Raises
        ------
        ValueError
            If fewer than two points are in that part.

        Examples
        --------
        >>> Sampled([0, 1, 2, 3], [1, 3, 5, 7]).levelled().heights.round(12) + 0.0
        array([0., 0., 0., 0.])
        """
        ends = (-np.inf, np.inf) if between is None else between
        lo, hi = (arguments.real("between", end) for end in ends)
        part = (self.points >= lo) & (self.points <= hi)
        if np.count_nonzero(part) < 2:
            raise ValueError(
                f"between = ({lo:g}, {hi:g}) holds {np.count_nonzero(part)} points of the trace: "
                "a line needs at least 2"
            )
        offset, slope = fitting.line(self.points[part], self.heights[part])
        heights = self.heights - (offset + slope * self.points)
        return self._remade(self.points, heights, self.smoothing)

    def _remade(self, x: Array, h: Array, smoothing: Smoothing) -> Sampled:
        """Another trace that is made of this one."""
        return Sampled(x, h, smoothing)._noted(self.mended, self.reading)

    def _noted(self, mended: Mended, reading: Reading) -> Sampled:
        """The trace, which was just built, with what was mended and how it was read."""
        object.__setattr__(self, "mended", mended)
        object.__setattr__(self, "reading", reading)
        return self
