"""Derivatives of one quantity by every number of a scene, and first-order uncertainty.

Of the heights of a trace the derivatives are found together (reverse mode). A quantity J of one
patch is linear in δh', whose own derivative is piecewise linear between the points: with R(t) the
answer to a slope that steps up by 1 at t, and δh'' = γ_i at the points,

    δJ = δh'(x_0) R(x_0) + Σ γ_i ∫ hat_i(t) R(t) dt

R is elementary: with t = m + r cos ψ the integrals of a step are I0 = ψ, I1 = sin ψ and C2 =
ψ/2 - sin(2ψ)/4, and its pressure at x is, beside the singular ends,

    E*/(2π) ln |(A + B)/(A - B)|,   A² = (x - x1)(x2 - t),   B² = (t - x1)(x2 - x)

The transpose of the equations of the spline then leads from the weights of the γ to those of the
heights, at the cost of one spline.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.contact.edge_integrals import NOTHING
from sie.contact.known_contact import Normal
from sie.errors import ContactError
from sie.numerics.interval import Interval
from sie.profiles.sampled import Sampled
from sie.profiles.splines import not_a_knot_bands

from .derivative import Derivative, OfPatches, peaks
from .parameters import held, parameters
from .rates import Response, integrals_of, response

Array = NDArray[np.float64]

OF_CONTACT = (
    "half_width", "centre", "left_edge", "right_edge", "contact_length", "normal_load", "moment",
    "tilt",
)  # fmt: skip
PEAKS = ("peak_pressure", "peak_tension", "elastic_limit")
HEIGHTS = "profile.heights"
NODES, HALVINGS = 12, 52  # of a panel; towards the logarithm under a peak


def known_quantity(quantity: str) -> str:
    """The name. ValueError if it is none that has derivatives."""
    if not arguments.among(quantity, (*OF_CONTACT, *PEAKS)):
        known = ", ".join((*OF_CONTACT, *PEAKS))
        raise ValueError(f"quantity {quantity!r} has no gradient: choose among {known}")
    return quantity


def gradient(solution: Any, quantity: str) -> dict[str, Any]:
    """As `Solution.gradient`."""
    known_quantity(quantity)
    found: dict[str, Any] = {}
    refused: ContactError | None = None
    trace = isinstance(solution.scene.profile, Sampled)
    for name in (*parameters(solution.scene, heights=False), *((HEIGHTS,) if trace else ())):
        try:
            found[name] = by_name(solution, quantity, name)
        except ContactError as error:  # of one number; the others have derivatives
            refused = error
    if not found and refused is not None:
        raise refused
    return found


def by_name(solution: Any, quantity: str, name: str) -> Any:
    """The derivative of a quantity by a number of the scene, or by all heights of its trace."""
    if name == HEIGHTS:
        return of_heights(solution, quantity)
    return float(getattr(Derivative(solution, name), quantity))


class Uncertainty:
    """The standard deviations that those of the numbers of a scene cause, to first order.

    `solution.uncertainty(deviations)` makes it. The numbers are taken as independent, and their
    deviations as small.
    """

    def __init__(self, solution: Any, deviations: Mapping[str, float]) -> None:
        self._solution = solution
        self._deviations = {
            name: arguments.not_negative(f"the deviation of {name}", value)
            for name, value in deviations.items()
        }
        self._derivatives = {
            name: Derivative(solution, name) for name in self._deviations if name != HEIGHTS
        }

    def shares(self, quantity: str) -> dict[str, float]:
        """The deviations that each number alone causes in a quantity.

        Parameters
        ----------
        quantity : str
            As of `Solution.gradient`.

        Returns
        -------
        dict of str to float
            Deviations by name, in the unit of the quantity.

        Raises
        ------
        ValueError
            For another quantity.
        """
        known_quantity(quantity)
        found = {n: abs(getattr(d, quantity)) for n, d in self._derivatives.items()}
        if HEIGHTS in self._deviations:
            found[HEIGHTS] = float(np.linalg.norm(of_heights(self._solution, quantity)))
        return {name: deviation * found[name] for name, deviation in self._deviations.items()}

    def of(self, quantity: str) -> float:
        """The standard deviation of a quantity.

        Parameters
        ----------
        quantity : str
            As of `Solution.gradient`.

        Returns
        -------
        float
            The root of the sum of the squares of `shares`.
        """
        return math.hypot(*self.shares(quantity).values())


# -- all heights of a trace ------------------------------------------------------------------------


def of_heights(solution: Any, quantity: str) -> Array:
    """The derivatives by the heights of a trace, (n,)."""
    profile, found = solution.scene.profile, solution.normal
    if not isinstance(profile, Sampled):
        raise ValueError(f'"{HEIGHTS}" are those of a trace: the profile is {profile!r}')
    together = profile.lam == 0.0 and isinstance(found, Normal) and quantity not in PEAKS[1:]
    if not together:
        names = (f"{HEIGHTS}[{k}]" for k in range(len(profile.points)))
        return np.array([by_name(solution, quantity, name) for name in names])
    place = _one_peak(solution) if quantity == "peak_pressure" else None
    factors = _factors(solution, quantity, place)
    first, weights = _weights(solution, profile.points, factors, place)
    return transposed_spline(profile.points, first, weights)


def _one_peak(solution: Any) -> float:
    places = peaks(solution)
    if len(places) > 1:
        raise ContactError(
            f"the largest pressure is reached at {len(places)} places, where its derivative by the "
            "heights is one-sided: break the symmetry a little"
        )
    return places[0]


def _factors(solution: Any, quantity: str, place: float | None) -> tuple[float, float, float]:
    """What the integrals I0, I1 and C2 of δh' contribute to a quantity, to a peak by its ends."""
    scene, edges = solution.scene, solution.normal.edges
    H, contact = integrals_of(solution.normal, scene.profile), edges.contact

    def part(**integral: float) -> float:
        integrals = H, NOTHING._replace(**integral)
        rate = response(edges, 0.5 * scene.Estar, integrals, held(scene))
        if place is None:
            return float(getattr(_OnePatch(rate), quantity))
        ratio = math.sqrt(contact.from_right(place) / contact.from_left(place))
        k1, k2 = rate.intensities
        return 0.5 * (k1 * ratio + k2 / ratio)

    return part(I0=1.0), part(I1=1.0), part(C2=1.0)


class _OnePatch(OfPatches):
    """The derivatives of one patch that follow from its response."""

    def __init__(self, rate: Response) -> None:
        super().__init__((rate.edges,))
        self.normal_load, self.moment, self.tilt = rate[1:4]


def _weights(
    solution: Any, x: Array, factors: tuple[float, float, float], place: float | None
) -> tuple[float, Array]:
    """R at the first point, and ∫ hat_i R dt of all points."""
    contact: Interval = solution.normal.edges.contact
    G = 0.5 * solution.scene.Estar

    def answer(t: Array) -> Array:
        left, right = (
            np.clip(apart, 0.0, 2.0 * contact.r)
            for apart in (contact.from_left(t), contact.from_right(t))
        )
        psi = 2.0 * np.arctan2(np.sqrt(right), np.sqrt(left))
        R = factors[0] * psi + factors[1] * np.sin(psi)
        R += factors[2] * (0.5 * psi - 0.25 * np.sin(2.0 * psi))
        if place is not None:
            A = np.sqrt(contact.from_left(place) * right)
            B = np.sqrt(left * contact.from_right(place))
            step = np.abs(place - np.clip(t, contact.x1, contact.x2))
            apart = 2.0 * contact.r * step / (A + B)  # |A - B|, without cancellation
            R += G / math.pi * np.log((A + B) / np.where(apart == 0.0, A + B, apart))
        return np.asarray(R)

    towards = 2.0 * contact.r * 0.5 ** np.arange(HALVINGS)
    centres = (contact.x1, contact.x2) if place is None else (contact.x1, contact.x2, place)
    cuts = np.concatenate([np.append(c + towards, np.append(c - towards, c)) for c in centres])
    ends = np.union1d(x, cuts[(cuts > x[0]) & (cuts < x[-1])])
    node, weight = np.polynomial.legendre.leggauss(NODES)
    half = 0.5 * np.diff(ends)[:, None]
    t = ends[:-1, None] + half * (1.0 + node)
    k = np.searchsorted(x, ends[:-1], side="right") - 1
    share = (t - x[k, None]) / np.diff(x)[k, None]
    value = half * weight * answer(t)
    total = np.bincount(k, (value * (1.0 - share)).sum(axis=1), len(x))
    total += np.bincount(k + 1, (value * share).sum(axis=1), len(x))
    return float(answer(x[:1])[0]), np.asarray(total, dtype=float)


def transposed_spline(x: Array, first: float, weights: Array) -> Array:
    """The weights of the heights, by those of f' at the first point and of f'' at all points.

    It is the transpose of `profiles.splines.interpolating_spline`, not-a-knot at its ends.
    """
    from scipy.linalg import solve_banded  # noqa: PLC0415 -- heavy, and for traces only

    step = np.diff(x)
    w, out = weights.copy(), np.zeros(len(x))
    # f'(x0) = chord - step (2 γ0 + γ1)/6
    w[:2] -= first * step[0] * np.array([2.0, 1.0]) / 6.0
    out[:2] += first * np.array([-1.0, 1.0]) / step[0]
    system, begin, end = not_a_knot_bands(step)
    system[0, 1:], system[2, :-1] = system[2, :-1].copy(), system[0, 1:].copy()  # transposed
    inner = w[1:-1].copy()
    inner[:2] += w[0] * begin
    inner[-2:] += w[-1] * end
    bends = 6.0 * solve_banded((1, 1), system, inner, check_finite=False)
    chords = np.append(0.0, bends) - np.append(bends, 0.0)
    out[1:] += chords / step
    out[:-1] -= chords / step
    return out
