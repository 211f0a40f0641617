"""The error of the pressure by the noise of a trace: an estimate beside the certificate.

The contact is that of a trace's spline f; the surface without noise is another one. With
x = m + r cos θ and the error of the slope δH = Σ c_n cos nθ, the error of the pressure to first
order is, by inversion of (1) on the computed contact (G = E*/2),

    δp = G [ Σ_{n>=1} c_n sin nθ + (C - c_0' cos θ)/sin θ ]

    C = -c_1/2                                      P given
    (C - c_0')/κ2 = -(C + c_0')/κ1                  half-width given: both edges move alike
    c_0' = c_0                                      tilt given
    c_2/4 - c_0'/2 + (m/r)(c_1/2 + C) = 0           moment given

The singular terms are edges that move: G (C - c_0') = κ2 δx2 / r, G (C + c_0') = -κ1 δx1 / r, where
p -> κ θ at the edge. There the first order ends, and sqrt(2 κ |G (C ∓ c_0')|) is the largest error.
All of it is linear in δH, which has two parts:

- the spline in use less the reference (`Sampled.reference`), a spline through the trace without its
  outliers, smoothed by cross validation: this part is known;
- the reference less the surface: s² (B'B + λE)^-1 is the covariance of its coefficients, s² follows
  from its misfit (`smoothing.slope_deviations`).

The report states |δp| of the first part and SPREAD standard deviations of the second. It assumes
noise that is independent from point to point. Roughness that is correlated over several points is
taken for a part of the surface, as cross validation takes it, unless the trace was smoothed so much
further that the misfit shows it: then all that was smoothed away counts as an error. A wrong scale
and the radius of the stylus are not covered.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.arguments import named_rows
from sie.contact.known_contact import Edges
from sie.numerics.interval import EPS, Interval
from sie.problem.scene import Scene
from sie.profiles.fitting import Gap
from sie.profiles.placed_traces import PlacedTrace, traces_in
from sie.profiles.sampled import Sampled
from sie.profiles.splines import slope_deviations
from sie.profiles.trace_values import Mended
from sie.traction.of_slope import SlopeDensity

if TYPE_CHECKING:
    from sie.patches.answer import SeveralPatches
    from sie.patches.noise import PatchErrors

Array = NDArray[np.float64]

SPREAD = 2.5  # standard deviations: of some dozens of independent points few contacts have a larger
PLACES = 64  # at which the error of the pressure is computed
FEWEST_NODES, MOST_NODES = 128, 1024  # of the slope's error; beyond, roughness is sampled only
NODES_PER_POINT = 2.0
INNER = 0.9  # of the contact
NEAR_EDGE = 0.1  # θ at which κ is taken: 0.005 r from the edge
DRAWS = 6  # of the noise, on several patches
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


def trace_reports(
    scene: Scene, edges: Edges, found: SlopeDensity | SeveralPatches
) -> tuple[TraceReport, ...]:
    """A report for each trace in the profile of a scene that was solved, in one patch or several.

    On several patches the error of the reference is drawn: noise of its misfit, smoothed as the
    reference is.
    """
    several = not isinstance(found, SlopeDensity)
    period = scene.profile.period if several else np.inf
    repeated = period < np.inf
    reports = []
    for placed in traces_in(scene.profile):
        points = placed.trace.points
        ends = float(points[0]), float(points[-1])
        extent = ends if repeated else placed.extent(*edges.contact[:2])
        reference = placed.trace.reference(extent)
        errors = (
            _errors(placed, reference, scene, edges, found)
            if isinstance(found, SlopeDensity)
            else _drawn(placed, reference, scene, found)
        )
        report = _report(placed, edges, reference, errors, period)
        reports.append(replace(report, aside=report.aside and not repeated))
    return tuple(reports)


def _drawn(
    placed: PlacedTrace, reference: Sampled, scene: Scene, several: SeveralPatches
) -> PatchErrors:
    from sie.patches.noise import changes  # noqa: PLC0415 -- for contact in several patches only

    trace, period = placed.trace, scene.profile.period
    x = reference.points
    noise = _rms(placed._replace(trace=reference).misfits(reference, period))
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
    errors: Errors | PatchErrors,
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
        aside=(middle - contact.m) * tilt > 0.5 * contact.r * abs(tilt),
        pressure_error=errors.pressure,
        inner_error=errors.inner,
        edge_errors=errors.edges,
        unsure_patches=getattr(errors, "unsure", 0),
    )


def _rms(misfits: Array) -> float:
    return float(np.sqrt(np.mean(misfits**2)))


class Errors(NamedTuple):
    """Errors of p over its peak, everywhere and in the inner part of the contact; of x1 and x2."""

    pressure: float
    inner: float
    edges: tuple[float, float]


def _errors(
    placed: PlacedTrace, reference: Sampled, scene: Scene, edges: Edges, density: SlopeDensity
) -> Errors:
    contact, sharp = edges.contact, np.array(edges.sharp)
    place = np.pi * (np.arange(PLACES) + 0.5) / PLACES
    p = density(contact.m + contact.r * np.cos(place))
    near = density(contact.m + contact.r * np.cos([np.pi - NEAR_EDGE, NEAR_EDGE])) / NEAR_EDGE
    near = np.maximum(near, EPS * p.max())
    kappa = np.where(sharp, np.inf, near)  # a corner does not move
    angle = _angles(placed, contact)
    regular, moved = _operator(angle, place, contact, kappa, scene)

    # The singular term C ± c_0' of the nearer edge is taken apart
    turned = np.stack((0.5 * np.tan(0.5 * place), 0.5 / np.tan(0.5 * place)), axis=1)
    nearer = (place < 0.5 * np.pi).astype(int)
    own = turned[np.arange(PLACES), nearer]
    whole = regular + turned @ moved
    weights = np.concatenate((whole, whole - own[:, None] * moved[nearer], moved))
    bound = _bound(placed, reference, contact.m + contact.r * np.cos(angle), weights)
    first_order, others, at_edges = np.split(density.half_modulus * bound, (PLACES, 2 * PLACES))

    largest = np.where(sharp, np.inf, np.sqrt(2.0 * at_edges) * np.sqrt(near))
    capped = others + np.minimum(own * at_edges[nearer], largest[nearer])
    error = np.minimum(first_order, capped) / p.max()
    x1, x2 = (contact.r * at_edges / kappa).tolist()
    return Errors(
        max(float(error.max()), *(largest[~sharp] / p.max()).tolist(), 0.0),
        float(error[np.abs(np.cos(place)) <= INNER].max()),
        (x1, x2),
    )


def _angles(placed: PlacedTrace, contact: Interval) -> Array:
    """Chebyshev's angles, as many as the points of the trace ask for."""
    x = placed.x(placed.trace.points)
    inside = NODES_PER_POINT * np.count_nonzero((x > contact.x1) & (x < contact.x2))
    n = int(np.clip(inside, FEWEST_NODES, MOST_NODES))
    angles: Array = np.pi * (np.arange(n) + 0.5) / n
    return angles


def _bound(placed: PlacedTrace, reference: Sampled, x: Array, weights: Array) -> Array:
    """A bound on Σ_k weights[i, k] δH(x_k), (m,)."""
    known, ends = placed.trace, reference.points[[0, -1]]
    at = np.clip(placed.direction * x + placed.origin, *ends)
    deviations = slope_deviations(reference.points, reference.heights, reference.lam, at, weights)
    return np.abs(weights @ (known.slope(at) - reference.slope(at))) + SPREAD * deviations


def _operator(
    angle: Array, place: Array, contact: Interval, kappa: Array, scene: Scene
) -> tuple[Array, Array]:
    """Matrices from δH at the angles to the regular part of δp/G at the places, and to C ± c_0'."""
    n = np.arange(len(angle))
    c = (2.0 / len(angle)) * np.cos(np.outer(n, angle))
    c[0] *= 0.5
    zero, lever = np.zeros(len(angle)), contact.m / contact.r
    one, other = 1.0 / kappa
    load = ([1.0, 0.0], -0.5 * c[1])
    if scene.half_width is not None:
        load = ([one + other, one - other], zero)
    tilt = ([0.0, 1.0], c[0])
    if scene.moment is not None:
        tilt = ([lever, -0.5], -0.25 * c[2] - 0.5 * lever * c[1])
    C, c0 = np.linalg.solve([load[0], tilt[0]], [load[1], tilt[1]])
    return np.sin(np.outer(place, n[1:])) @ c[1:], np.array([C + c0, C - c0])
