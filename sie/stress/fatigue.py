"""Fatigue parameters of a stress history on their critical planes.

    Smith, Watson & Topper    max over planes of  σ_n,max Δε_n/2,  0 where σ_n,max < 0
    Findley                   max over planes of  τ_a + k σ_n,max
    Fatemi & Socie            max over planes of  γ_a (1 + k σ_n,max/σ_y),  not below 0

τ_a is the amplitude of the shear stress on a plane, γ_a = τ_a/μ that of the engineering shear
strain, Δε_n the range of the normal strain, all over the states of a cycle. All planes are
compared, not only those whose normals lie in the plane of the problem (`critical_plane`): below a
pressure σ_zz lies far from σ_xx ~ σ_yy, and the planes of Findley and of Fatemi and Socie then
have normals out of the plane. With plane strain and 0 <= ν <= 1/2 that of Smith, Watson and Topper
has not.

References: Smith, Watson & Topper, J. Materials 5 (1970) 767-778; Findley, J. Eng. Ind. 81 (1959)
301-306; Fatemi & Socie, Fatigue Fract. Eng. Mater. Struct. 11 (1988) 149-165; Socie & Marquis,
Multiaxial Fatigue (2000), chs. 5 and 6 (half the longest chord as amplitude of a shear).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.errors import ContactError
from sie.progress_bar import reported, step_done

from .critical_plane import Parameter, StressHistory, on_grid, worst_planes
from .surface_search import columns, largest

Array = NDArray[np.float64]

# The part of a value by which a few planes may miss it.
TOO_SMALL = 0.2


@dataclass(frozen=True, eq=False)
class CriticalPlane:
    """A fatigue parameter at points, and the plane on which it is largest.

    All fields are arrays of the shape of the points.

    Parameters
    ----------
    value : ndarray of float
        The parameter: stress (Smith, Watson and Topper; Findley) or strain (Fatemi and Socie).
    x, y : ndarray of float
        Positions and depths, length.
    angle : ndarray of float
        Angle of the plane's normal, seen in the x-y plane, from x towards the depth, radians, in
        [0, π).
    out_of_plane : ndarray of float
        Angle of the normal out of the x-y plane, radians, in [0, π/2]. Its opposite is as critical.
    amplitude : ndarray of float
        Amplitude of the normal strain, the shear stress or the engineering shear strain there.
    normal_stress : ndarray of float
        Largest normal stress on the plane over the cycle, stress.
    """

    value: Array
    x: Array
    y: Array
    angle: Array
    out_of_plane: Array
    amplitude: Array
    normal_stress: Array


def smith_watson_topper(states: Sequence[Any]) -> Parameter:
    """The parameter of Smith, Watson and Topper. ValueError without the body's constants."""
    body = states[0].tractions.known_body
    return Parameter(1.0, 0.0, body.young, body.poisson)


def findley(k: float) -> Parameter:
    """Findley's parameter."""
    return Parameter(arguments.not_negative("k", k))


def fatemi_socie(states: Sequence[Any], k: float, yield_stress: float) -> Parameter:
    """The parameter of Fatemi and Socie. ValueError without the body's constants."""
    weight = arguments.not_negative("k", k) / arguments.positive("yield_stress", yield_stress)
    return Parameter(weight, 1.0, states[0].tractions.known_body.shear_modulus)


@reported("critical planes, depth")
def at_points(
    states: Sequence[Any], parameter: Parameter, x: ArrayLike | None, y: ArrayLike
) -> CriticalPlane:
    """The critical planes at points; without x, at the worst place of each depth."""
    if x is None:
        y = arguments.reals("y", y)
        x = np.reshape(
            [_worst_x(states, parameter, depth) for depth in y.ravel().tolist()], y.shape
        )
    x, y = arguments.of_one_shape(arguments.reals("x", x), arguments.reals("y", y))
    if not x.size:
        return CriticalPlane(*(np.zeros(x.shape) for _ in fields(CriticalPlane)))
    h = _history(states, x.ravel(), y.ravel())
    value, phi, psi = worst_planes(h, parameter)
    found = (value, x, y, np.mod(0.5 * phi, np.pi), psi, *parameter.planes(h, phi, psi))
    return CriticalPlane(*(np.reshape(field, x.shape)[()] for field in found))


def _worst_x(states: Sequence[Any], parameter: Parameter, y: float) -> float:
    """The position at a depth where the parameter is largest."""
    step_done()
    x = columns([state.tractions for state in states], y)
    h = _history(states, x, y)
    values = on_grid(h, parameter)
    best = values.max()
    high = np.flatnonzero(values >= best - TOO_SMALL * abs(best))
    values[high] = worst_planes(h.at(high), parameter).value
    return largest(x, values, lambda x: worst_planes(_history(states, x, y), parameter).value)[0]


def _history(states: Sequence[Any], x: Array, y: float | Array) -> StressHistory:
    """The stresses of all states at points. ContactError where one is infinite."""
    stresses = [state.stress(x, y) for state in states]
    xx, yy, xy, zz = (np.stack([getattr(s, n) for s in stresses]) for n in ("xx", "yy", "xy", "zz"))
    infinite = ~(np.isfinite(xx) & np.isfinite(yy) & np.isfinite(xy)).all(axis=0)
    if infinite.any():
        raise ContactError(
            f"the stress is infinite at x = {x[infinite][0]:g}, a sharp edge or a corner: "
            "ask for the critical plane at a depth, y > 0"
        )
    return StressHistory(0.5 * (xx + yy), 0.5 * (yy - xx) + 1j * xy, zz)
