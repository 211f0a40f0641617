"""The error of the pressure by the noise of a trace: an estimate beside the certificate.

The contact is that of a trace's spline f; the surface without noise is another one. The error of
the slope has two parts, and the changes of pressure and edges by each are linear in it
(`patches.newton.response`):

- the spline in use less the reference (`Sampled.cleaned`), a spline through the trace without its
  outliers, smoothed by cross validation: this part is known;
- the reference less the surface: draws of independent noise, smoothed as the reference is, whose
  size is that of the misfit about the contact (`splines.noise_level`).

The report states |δp| of the first part and SPREAD standard deviations of the second. Next to a
smooth edge that moves by δ the pressure changes as that at the distance δ from it, which is no
first order. The noise is assumed to be independent from point to point. Roughness that is
correlated over several points is taken for a part of the surface, as cross validation takes it:
what was smoothed away beyond that counts as an error. A wrong scale and the radius of the stylus
are not covered.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.arguments import named_rows
from sie.patches.answer import SeveralPatches
from sie.patches.density import PatchPressure
from sie.patches.newton import response
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.fitting import Gap
from sie.profiles.of_profile import of_profile
from sie.profiles.placed_traces import PlacedTrace, traces_in
from sie.profiles.row import Periodic
from sie.profiles.sampled import Sampled
from sie.profiles.splines import noise_level
from sie.profiles.trace_values import Mended

Array = NDArray[np.float64]

SPREAD = 2.5  # standard deviations: of some dozens of independent points few contacts have a larger
DRAWS = 12  # of the noise
NAMED = 3  # outliers or gaps that a row names
INNER, PLACES = 0.9, 16  # of each patch: the part where the pressure is compared, and at how many
TOLERANCE = 1e-15  # to which an error that is a function is resolved


@dataclass(frozen=True)
class TraceReport:
    """A trace, its smoothing and repair, and the errors that its noise causes.

    Lengths are in the units of the scene, places are its x.

    Parameters
    ----------
    points : int
        The number of points.
    smoothing : float
        λ of the spline in use, length³; 0 if it interpolates.
    misfit : float
        Root of the mean square of the heights less the spline, length.
    outliers : tuple of (float, float)
        (x, height over the reference) of points that stand out of the noise; none is removed.
    gaps : tuple of Gap
        (lo, hi, missing points) of intervals without points, which the spline bridges.
    mended : Mended
        Points left out without a value, points averaged at equal x, and whether x was sorted.
    tilt : float
        Slope of the line through the trace and of the scene: the levelling that is left to do.
    pressure_error : float
        Largest error of the pressure over its peak, estimated from the misfit. It is no part of the
        certificate.
    edge_errors : (float, float)
        Errors of x1 and x2, lengths, from the same; 0 for a corner of the indenter.
    """

    points: int
    smoothing: float
    misfit: float
    outliers: tuple[tuple[float, float], ...]
    gaps: tuple[Gap, ...]
    mended: Mended
    tilt: float
    pressure_error: float
    edge_errors: tuple[float, float]

    def as_dict(self) -> dict[str, Any]:
        """The report for JSON.

        Returns
        -------
        dict
            Numbers, lists and strings by name.
        """
        pairs = {"outliers": list(map(list, self.outliers)), "edge_errors": list(self.edge_errors)}
        named = {"gaps": [gap._asdict() for gap in self.gaps], "mended": self.mended._asdict()}
        return asdict(self) | pairs | named

    def __str__(self) -> str:
        smoothing = f"smoothed, λ = {self.smoothing:.3g}" if self.smoothing else "interpolated"
        left_out, averaged, is_sorted = self.mended
        done = (
            (left_out, f"{left_out} points without a value left out"),
            (averaged, f"{averaged} points averaged with others of equal x"),
            (is_sorted, "x sorted"),
        )
        mended = [text for is_done, text in done if is_done]
        missing = [f"{gap.missing} from {gap.lo:.6g} to {gap.hi:.6g}" for gap in self.gaps]
        off = [f"{off:+.3g} at x = {x:.6g}" for x, off in self.outliers]
        x1, x2 = self.edge_errors
        return named_rows(
            ("trace", f"{self.points} points, {smoothing}, misfit {self.misfit:.3g} rms"),
            ("mended", _listed(mended)),
            ("missing points", _listed(missing)),
            ("outliers", _listed(off)),
            ("levelling left", f"slope {self.tilt:.3g} of the line through the trace"),
            ("noise estimate", f"p to {self.pressure_error:.1e} of its peak, x1 to {x1:.1e}, x2 to "
             f"{x2:.1e}, by noise that is independent from point to point"),
        )  # fmt: skip


def _listed(texts: list[str]) -> str:
    more = f" and {len(texts) - NAMED} more" if len(texts) > NAMED else ""
    return ", ".join(texts[:NAMED]) + more if texts else "none"


def trace_reports(scene: Scene, several: SeveralPatches) -> tuple[TraceReport, ...]:
    """A report for each trace in the profile of a scene that was solved."""
    return tuple(_report(placed, scene, several) for placed in traces_in(scene.profile))


def _report(placed: PlacedTrace, scene: Scene, several: SeveralPatches) -> TraceReport:
    trace, edges, period = placed.trace, several.edges, scene.profile.period
    x, contact = placed.x(trace.points), edges.contact
    ends = float(trace.points[0]), float(trace.points[-1])
    if period == np.inf:
        ends = placed.extent(*contact[:2])
    reference = trace.cleaned
    misfits, over = (placed.misfits(spline, period) for spline in (trace, reference))
    pressure_error, edge_errors = _implied(
        _errors(placed, reference, over - misfits, ends, period), scene, several
    )
    return TraceReport(
        points=len(x),
        smoothing=trace.lam,
        misfit=float(np.sqrt(np.mean(misfits**2))),
        outliers=tuple((float(x[k]), float(over[k])) for k in trace.outliers),
        gaps=placed.gaps(),
        mended=trace.mended,
        tilt=placed.direction * trace.line[1] + placed.tilt + edges.tilt,
        pressure_error=pressure_error,
        edge_errors=edge_errors,
    )


def _errors(
    placed: PlacedTrace, reference: Sampled, known: Array, ends: tuple[float, float], period: float
) -> list[Profile]:
    """The known error of the heights, and draws of the noise about the contact."""
    x = reference.points
    lo, hi = np.clip(ends, x[0], x[-1]).tolist()
    noise = noise_level(x, reference.heights, reference.lam, (lo, hi))
    draws = np.random.default_rng(0).normal(scale=noise, size=(DRAWS, len(x)))
    found = [
        placed.with_heights(placed.trace.points, known, 0.0),
        *(placed.with_heights(x, draw, reference.lam) for draw in draws),
    ]
    return found if period == np.inf else [Periodic(one, period) for one in found]


def _implied(
    errors: list[Profile], scene: Scene, several: SeveralPatches
) -> tuple[float, tuple[float, float]]:
    """The error of the pressure over its peak and those of the edges, by those of the profile."""
    found, pressure, G = several.found, several.pressure, several.pressure.half_modulus
    if scene.moment is not None:
        found = replace(found, given=found.given._replace(moment=scene.moment / G))
    P, domain = found.state.patches, found.operator.pieces.domain
    angle = np.pi * (np.arange(PLACES) + 0.5) / PLACES
    places = P.c[:, None] - INNER * P.r[:, None] * np.cos(angle)
    changes, moves = [], []
    for error in errors:
        pieces = of_profile(error, domain, TOLERANCE)
        operator, tilt, moved = response(found, pieces, np.zeros(2 * P.number + 1))
        changes.append(PatchPressure(operator, G, tilt, 0.0)(places))
        moves.append(np.abs(moved).reshape(-1, 2))
    p, edges = _together(changes), _together(moves)
    capped = np.where(edges > 0.0, np.minimum(edges, P.r[:, None]), 0.0)
    beside = pressure(np.stack((P.a, P.b), axis=1) + capped * (1, -1))
    outer = np.where(edges > 0.0, beside, 0.0)
    largest = max(float(p.max()), float(outer.max())) / float(pressure(places).max())
    return largest, (float(edges[0, 0]), float(edges[-1, 1]))


def _together(changes: list[Array]) -> Array:
    """The change by the first error, and SPREAD standard deviations of those by the draws."""
    return np.abs(changes[0]) + SPREAD * np.sqrt(np.mean(np.square(changes[1:]), axis=0))
