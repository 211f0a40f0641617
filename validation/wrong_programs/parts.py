"""Wrong programs: shear, load paths, sliding, full stick, traces, stress, many pieces.

Each is this package with one of its parts replaced while it solves; its answer is held against a
closed form that shares no code with it.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import Any
from unittest.mock import PropertyMock, patch

import numpy as np
from scipy.interpolate import CubicSpline

import sie
from analytic import (
    bonded_flat,
    cattaneo,
    cattaneo_rounded,
    hertz,
    interior,
    rounded_flat,
    sliding_rounded_flat,
)
from sie.friction import memory, partial_slip
from sie.numerics import cauchy_sums
from sie.paths import history
from sie.profiles import sampled
from sie.profiles.splines import Spline
from sie.stress import half_plane
from sie.traction import piece_quadrature, potential

Part = Callable[[], AbstractContextManager[Any]]

P, F, Q = 0.3, 0.5, 0.09
PLACES = np.array([-0.9, -0.42, 0.03, 0.31, 0.77])
PUNCH = {"half_flat": 0.5, "radius": 1.0, "modulus": 1.0}
RIM = sie.RoundedFlat(0.5, 1.0)
SLIPPING = sie.Scene(profile=RIM, modulus=1.0, normal_load=P, friction=F, tangential_load=Q)
B = float(hertz.half_width(normal_load=P, radius=1.0, modulus=1.0))


def number(part: Part, answer: Callable[[], Any], exact: Callable[[], Any], wrong: bool) -> float:
    """Largest difference over the largest value; inf where the wrong program refuses to answer."""
    with part() if wrong else nullcontext(), np.errstate(all="ignore"):
        try:
            found = np.asarray(answer())
        except (sie.ContactError, ValueError, ZeroDivisionError):
            return float("inf")
    true = np.asarray(exact())
    return float(np.abs(found - true).max() / np.abs(true).max())


def _instead(target: Any, name: str, wrong: Callable[..., Any]) -> Part:
    """`wrong` is given the right function first."""
    right = getattr(target, name)
    return lambda: patch.object(target, name, lambda *args, **given: wrong(right, *args, **given))


def _property(target: Any, name: str, change: Callable[[Any], Any]) -> Part:
    get = getattr(target, name).fget

    class Changed(PropertyMock):
        def __get__(self, instance: Any, owner: Any = None) -> Any:
            return change(get(instance))

    return lambda: patch.object(target, name, new_callable=Changed)


# -- shear and load paths -------------------------------------------------------------------------


def _shear() -> Any:
    solution = sie.solve(SLIPPING)
    return solution.shear(solution.half_width * PLACES)


def _true_shear() -> Any:
    x = sie.solve(SLIPPING).half_width * PLACES
    return cattaneo_rounded.shear(x, **PUNCH, normal_load=P, friction=F, tangential_load=Q)


def _followed(what: Callable[[Any], Any]) -> Any:
    """Hertz: Q up to 0.8 f P, and down to 0.2 f P."""
    scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=P, friction=F)
    return what(sie.follow(scene, sie.Path([(P, 0.8 * F * P), (P, 0.2 * F * P)]))[1])


def _unloading() -> Any:
    return _followed(lambda state: state.shear(B * PLACES))


def _true_unloading() -> Any:
    loads = {
        "normal_load": P,
        "friction": F,
        "largest_load": 0.8 * F * P,
        "tangential_load": 0.2 * F * P,
    }
    return cattaneo.unloading_shear(B * PLACES, half_width=B, **loads)


def _cycle() -> Any:
    scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=P, friction=F)
    first, _, last = sie.follow(scene, sie.Path([(P, Q), (P, -Q), (P, Q)]))
    return [last.energy_lost - first.energy_lost]


def _true_cycle() -> Any:
    return [float(cattaneo.dissipation(normal_load=P, friction=F, tangential_load=Q, modulus=1.0))]


def _once(corners: Any) -> Any:
    """Masing's rule with 1 in place of 2."""
    return tuple((depth, min(max(weight, -1.0), 1.0)) for depth, weight in corners)


def _bulk() -> Any:
    scene = sie.Scene(
        profile=sie.Parabola(1.0),
        modulus=1.0,
        normal_load=P,
        friction=F,
        tangential_load=Q,
        bulk_stress=0.02,
    )
    return sie.solve(scene).shear(B * PLACES)


def _true_bulk() -> Any:
    return cattaneo.bulk_shear(
        B * PLACES, half_width=B, normal_load=P, friction=F, tangential_load=Q, bulk_stress=0.02
    )


# -- dissimilar bodies ----------------------------------------------------------------------------

FRICTIONAL = sie.Scene(
    profile=RIM, modulus=1.0, dundurs=0.15, friction=2.0, sliding=1, normal_load=P
)
BONDED = sie.Scene(
    profile=sie.Flat(1.0),
    modulus=1.0,
    dundurs=0.3,
    friction=float("inf"),
    normal_load=1.0,
    tangential_load=-0.4,
    moment=0.0,
)


def _sliding() -> Any:
    return sie.solve(FRICTIONAL).pressure(0.6 * PLACES)


def _true_sliding() -> Any:
    return sliding_rounded_flat.pressure(0.6 * PLACES, **PUNCH, normal_load=P, coupling=0.3)


def _stuck() -> Any:
    solution = sie.solve(BONDED)
    return np.asarray(solution.pressure(PLACES)) + 1j * np.asarray(solution.shear(PLACES))


def _true_stuck() -> Any:
    given = {"half_width": 1.0, "normal_load": 1.0, "dundurs": 0.3, "shear_load": -0.4}
    return bonded_flat.pressure(PLACES, **given) + 1j * bonded_flat.shear(PLACES, **given)


# -- traces, many pieces, stress ------------------------------------------------------------------


def _natural(x: Any, h: Any) -> Any:
    c = CubicSpline(x, h, bc_type="natural").c.T[:, ::-1].copy()
    return Spline(x, c, np.zeros(len(c)))


def _trace() -> Any:
    x = np.linspace(-1.2, 1.3, 26)
    return sie.solve(
        sie.Scene(profile=sie.Sampled(x, 0.5 * x * x), modulus=1.0, half_width=1.0)
    ).pressure(PLACES)


def _cut_parabola() -> Any:
    profile = sie.Piecewise(np.linspace(-2.0, 2.0, 1001).tolist(), [(0.0, 1.0)] * 1000)
    kinked = profile + sie.RoundedFlat(0.5, 1.0)  # else nothing jumps and nothing is summed
    return sie.solve(sie.Scene(profile=kinked, modulus=1.0, half_width=1.0)).pressure(PLACES)


def _true_parabola() -> Any:
    return hertz.pressure(PLACES, radius=1.0, modulus=1.0, half_width=1.0)


def _true_cut() -> Any:
    return _true_parabola() + rounded_flat.pressure(PLACES, **PUNCH, half_width=1.0)


def _fewer_terms(right: Any, A: Any, *rest: Any) -> Any:
    return right(A[: len(A) // 2], *rest)


X, Y = np.array([-0.7, 0.2, 1.1]), np.array([[0.05], [0.3], [40.0]])


def _stress() -> Any:
    scene = sie.Scene(profile=RIM, modulus=1.0, half_width=1.0, friction=0.3, sliding=1)
    stress = sie.solve(scene).stress(X, Y)
    return np.array([stress.xx, stress.yy, stress.xy])


def _true_stress() -> Any:
    xx, yy, xy = interior.rounded_flat(X, Y, **PUNCH, half_width=1.0, friction=0.3)[:3]
    return np.array([xx, yy, xy])


def _no_derivative(right: Any, *args: Any) -> Any:
    Phi, dPhi, Fq = right(*args)
    return Phi, 0.0 * dPhi, Fq


PARTS: tuple[tuple[str, str, Callable[[bool], float]], ...] = (
    (
        "sign of the slip zones",
        "slip against the load",
        partial(
            number,
            _instead(partial_slip, "_one_signed", lambda f, s, g: f(s, -g)),
            _shear,
            _true_shear,
        ),
    ),
    (
        "reduced load P - Q",
        "friction left out of P - Q/f",
        partial(
            number,
            _instead(partial_slip, "remaining", lambda _, f, P, Q: P - abs(Q)),
            _shear,
            _true_shear,
        ),
    ),
    (
        "reduced load off by 1e-10",
        "P - Q/f off in the tenth digit",
        partial(
            number,
            _instead(partial_slip, "remaining", lambda right, *a: right(*a) * (1 + 1e-10)),
            _shear,
            _true_shear,
        ),
    ),
    (
        "Masing's factor",
        "1 in place of 2 after a turn of the load",
        partial(
            number, _property(memory.LoadMemory, "corners", _once), _unloading, _true_unloading
        ),
    ),
    (
        "energy of a branch",
        "a cycle counts one branch",
        partial(
            number,
            _instead(
                history,
                "step_energy",
                lambda right, followed, k: right(followed, k) / (2 if k else 1),
            ),
            _cycle,
            _true_cycle,
        ),
    ),
    (
        "bulk stress as strain",
        "τ = σ/2 in place of σ/4",
        partial(number, _property(sie.Scene, "tau", lambda t: 2.0 * t), _bulk, _true_bulk),
    ),
    (
        "edge rule of similar bodies",
        "Gauss-Chebyshev weights next to frictional edges",
        partial(
            number,
            _instead(piece_quadrature, "gauss_jacobi", lambda right, n, a, b: right(n, a, -0.5)),
            _sliding,
            _true_sliding,
        ),
    ),
    (
        "sign of β f in sliding",
        "friction pulls the other way",
        partial(number, _property(sie.Scene, "slides", lambda s: -s), _sliding, _true_sliding),
    ),
    (
        "sign of β when bonded",
        "the bodies exchanged",
        partial(number, _property(sie.Scene, "beta", lambda b: -b), _stuck, _true_stuck),
    ),
    (
        "natural spline",
        "h'' = 0 at the ends of a trace",
        partial(
            number,
            _instead(sampled, "interpolating_spline", lambda _, x, h: _natural(x, h)),
            _trace,
            _true_parabola,
        ),
    ),
    (
        "half the far-field terms",
        "moments of far pieces cut off",
        partial(number, _instead(cauchy_sums, "_series", _fewer_terms), _cut_parabola, _true_cut),
    ),
    (
        "far field off by 1e-9",
        "sums over far pieces",
        partial(
            number,
            _instead(cauchy_sums, "_series", lambda right, *a: right(*a) * (1 + 1e-9)),
            _cut_parabola,
            _true_cut,
        ),
    ),
    (
        "dropped Φ'",
        "stress inside without y Φ'",
        partial(number, _instead(half_plane, "potentials", _no_derivative), _stress, _true_stress),
    ),
    (
        "sign of far stress",
        "the outer series with the other sign",
        partial(
            number,
            _instead(potential, "far", lambda right, *a, **g: tuple(-v for v in right(*a, **g))),
            _stress,
            _true_stress,
        ),
    ),
)
