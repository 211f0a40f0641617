"""The error of the pressure by the noise of a trace: an estimate beside the certificate.

The contact is that of a trace's spline f; the surface without noise is another one. The error of
the slope has two parts, and the change of the pressure by each is linear in it (`patches.noise`, in
one patch or several):

- the spline in use less the reference (`Sampled.reference`), a spline through the trace without its
  outliers, smoothed by cross validation: this part is known;
- the reference less the surface: draws of independent noise, smoothed as the reference is, whose
  size is that of the misfit about the contact (`splines.noise_level`).

The report states |δp| of the first part and SPREAD standard deviations of the second. It assumes
noise that is independent from point to point. Roughness that is correlated over several points is
taken for a part of the surface, as cross validation takes it, unless the trace was smoothed so much
further that the misfit shows it: then all that was smoothed away counts as an error. A wrong scale
and the radius of the stylus are not covered.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sie.arguments import named_rows
from sie.contact.known_contact import Edges
from sie.problem.scene import Scene
from sie.profiles.fitting import Gap
from sie.profiles.placed_traces import PlacedTrace, traces_in
from sie.profiles.sampled import Sampled
from sie.profiles.splines import noise_level
from sie.profiles.trace_values import Mended

if TYPE_CHECKING:
    from sie.patches.answer import SeveralPatches
    from sie.patches.noise import PatchErrors

Array = NDArray[np.float64]

SPREAD = 2.5  # standard deviations: of some dozens of independent points few contacts have a larger
DRAWS = 12  # of the noise
NAMED = 3  # outliers or gaps that a row names


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
    averaged : float
        The number of points over which it averages, (λ/Δ³)^(1/4), Δ their mean distance. Below
        about 1 the spline follows the noise too.
    separated : bool
        Whether cross validation averages over more than a point. Where it does not, noise that is
        correlated from point to point is not in the errors below.
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
    aside : bool
        Whether the contact lies off the middle of the trace, where that line is low.
    pressure_error : float
        Largest error of the pressure over its peak, estimated from the misfit. It is no part of the
        certificate.
    inner_error : float
        The same over the inner 90 % of the contact: next to an edge that moves by e the pressure
        changes as sqrt(e).
    edge_errors : (float, float)
        Errors of x1 and x2, lengths, from the same; 0 for a corner of the indenter.
    unsure_patches : int
        The number of patches, of several, of which an edge moves by more than half of their width.
    """

    points: int
    smoothing: float
    averaged: float
    separated: bool
    misfit: float
    outliers: tuple[tuple[float, float], ...]
    gaps: tuple[Gap, ...]
    mended: Mended
    tilt: float
    aside: bool
    pressure_error: float
    inner_error: float
    edge_errors: tuple[float, float]
    unsure_patches: int = 0

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
        smoothing = f"smoothed over {self.averaged:.2g}, λ = {self.smoothing:.3g}"
        smoothing = smoothing if self.smoothing else "interpolated"
        rows = [("trace", f"{self.points} points, {smoothing}, misfit {self.misfit:.3g} rms")]
        done = (
            (self.mended.left_out, f"{self.mended.left_out} points without a value left out"),
            (
                self.mended.averaged,
                f"{self.mended.averaged} points averaged with others of equal x",
            ),
            (self.mended.sorted, "x sorted"),
        )
        mended = ", ".join(text for is_done, text in done if is_done)
        rows += [("mended", mended)] if mended else []
        missing = (f"{gap.missing} from {gap.lo:.6g} to {gap.hi:.6g}" for gap in self.gaps[:NAMED])
        rows.append(("missing points", _listed(missing, len(self.gaps))))
        off = (f"{off:+.3g} at x = {x:.6g}" for x, off in self.outliers[:NAMED])
        rows.append(("outliers", _listed(off, len(self.outliers), ", kept")))
        low = "; the contact lies where it is low: is the trace level?" if self.aside else ""
        rows.append(("levelling left", f"slope {self.tilt:.3g} of the line through the trace{low}"))
        x1, x2 = self.edge_errors
        inner = f"{self.inner_error:.1e} away from the edges"
        rows += [
            ("noise estimate", f"p to {self.pressure_error:.1e} of its peak, {inner}"),
            ("", f"x1 to {x1:.1e}, x2 to {x2:.1e}; the certificate is of the equations alone"),
        ]
        taken = (
            "correlated noise is taken for the shape and not counted: smooth further, if there is "
            "any"
        )
        rows += [] if self.separated else [("", taken)]
        unsure = f"of {self.unsure_patches} patches an edge moves by more than half of their width"
        rows += [("", unsure)] if self.unsure_patches else []
        return named_rows(*rows)


def _listed(shown: Iterable[str], count: int, after: str = "") -> str:
    more = f" and {count - NAMED} more" if count > NAMED else ""
    return f"{', '.join(shown)}{more}{after}" if count else "none"


def trace_reports(scene: Scene, several: SeveralPatches) -> tuple[TraceReport, ...]:
    """A report for each trace in the profile of a scene that was solved."""
    reports = []
    for placed in traces_in(scene.profile):
        extent = placed.extent(*several.edges.contact[:2])
        if scene.profile.period < np.inf:
            points = placed.trace.points
            extent = float(points[0]), float(points[-1])
        reference = placed.trace.reference(extent)
        errors = _errors(placed, reference, scene, several)
        reports.append(_report(placed, several.edges, reference, errors, scene.profile.period))
    return tuple(reports)


def _errors(
    placed: PlacedTrace, reference: Sampled, scene: Scene, several: SeveralPatches
) -> PatchErrors:
    """What the known error and draws of the noise change."""
    from sie.patches.noise import changes  # noqa: PLC0415 -- for traces only

    trace, period = placed.trace, scene.profile.period
    x = reference.points
    contact = placed.direction * np.array(several.edges.contact[:2]) + placed.origin
    lo, hi = (x[0], x[-1]) if period < np.inf else np.sort(np.clip(contact, x[0], x[-1]))
    noise = noise_level(x, reference.heights, reference.lam, (float(lo), float(hi)))
    known = placed.misfits(reference, period) - placed.misfits(trace, period)
    draws = np.random.default_rng(0).normal(scale=noise, size=(DRAWS, len(x)))
    return changes(
        several.found,
        several.pressure,
        [
            placed.with_heights(trace.points, known, 0.0, period),
            *(placed.with_heights(x, draw, reference.lam, period) for draw in draws),
        ],
        SPREAD,
        scene.moment is not None,
    )


def _report(
    placed: PlacedTrace,
    edges: Edges,
    reference: Sampled,
    errors: PatchErrors,
    period: float,
) -> TraceReport:
    trace, contact = placed.trace, edges.contact
    x = placed.x(trace.points)
    tilt = placed.direction * trace.line[1] + placed.tilt + edges.tilt
    middle = 0.5 * float(x[0] + x[-1])
    over = placed.misfits(reference, period)
    return TraceReport(
        points=len(x),
        smoothing=trace.lam,
        averaged=trace.averaged,
        separated=reference.averaged > 1.0,
        misfit=_rms(placed.misfits(trace, period)),
        outliers=tuple((float(x[k]), float(over[k])) for k in trace.outliers),
        gaps=placed.gaps(),
        mended=trace.mended,
        tilt=tilt,
        aside=period == np.inf and (middle - contact.m) * tilt > 0.5 * contact.r * abs(tilt),
        pressure_error=errors.pressure,
        inner_error=errors.inner,
        edge_errors=errors.edges,
        unsure_patches=errors.unsure,
    )


def _rms(misfits: Array) -> float:
    return float(np.sqrt(np.mean(misfits**2)))
