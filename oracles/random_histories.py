"""Random load paths of every kind, in units without dimensions, for tests and the validation.

A point is (P/P0, Q/F, σ/S, turn): F = f P0, S = 4 F/(π a), a the half-width of the contact under
P0; `turn` is a tilt over a/R, or a moment over P0 a. Amplitudes are such that

    |dQ| > |dP| + |dσ| + 2 |dθ|

in each step from a turning point, or that one quantity alone turns: then slip starts at both edges.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float, float, float]


def random_path(kind: str, rng: np.random.Generator) -> list[Point]:
    """Three to seven turning points of a path of this kind, one of `KINDS` or `MARCHED`."""
    return [(*map(float, row),) for row in (KINDS | MARCHED)[kind](rng)]  # type: ignore[misc]


def _rows(*columns: float | NDArray[np.float64]) -> NDArray[np.float64]:
    return np.stack(np.broadcast_arrays(*columns), axis=1)


def _one_load(rng: np.random.Generator) -> NDArray[np.float64]:
    """Q at constant P, any turning points."""
    return _rows(1.0, rng.uniform(-0.9, 0.9, rng.integers(3, 7)), 0.0, 0.0)


def _oblique(rng: np.random.Generator) -> NDArray[np.float64]:
    """P and Q at any rates."""
    P = rng.uniform(0.6, 1.3, rng.integers(3, 6))
    return _rows(P, rng.uniform(-0.8, 0.8, len(P)) * P, 0.0, 0.0)


def _in_phase(rng: np.random.Generator) -> NDArray[np.float64]:
    """P, Q, σ and tilt in proportion, with a loop in the cycle; contacts are nested."""
    t, pulse = np.array([0.0, *_cycle(rng)]), rng.uniform(-0.1, 0.1)
    tilt, sigma = pulse * rng.uniform(-0.4, 0.4), rng.uniform(-0.1, 0.1)
    return _rows(1.0 + t * pulse, t * rng.uniform(0.35, 0.5), t * sigma, t * tilt)


def _mean(rng: np.random.Generator) -> NDArray[np.float64]:
    """The same about a mean Q."""
    rows = _in_phase(rng)[1:]
    rows[:, 1] += rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 0.3)
    return rows


def _cycle(rng: np.random.Generator) -> NDArray[np.float64]:
    """From 1 to -1 and back with a loop on the way, and to -1, in shares of an amplitude."""
    low, high = np.sort(rng.uniform(-0.8, 0.8, 2))
    return np.array([1.0, -1.0, high, low, 1.0, -1.0])


def _proportional(rng: np.random.Generator) -> NDArray[np.float64]:
    """Q and σ in one proportion at constant P, which slip keeps of one direction."""
    t, Q = _cycle(rng), rng.uniform(0.3, 0.8)
    return _rows(1.0, t * Q, t * Q * rng.uniform(-0.8, 0.8), 0.0)


def _from_zero(rng: np.random.Generator) -> NDArray[np.float64]:
    """The same between zero and a maximum, R = 0."""
    t, Q = np.array([0.0, 1.0, 0.0, 1.0, 0.0]), rng.uniform(0.3, 0.8)
    return _rows(1.0, t * Q, t * Q * rng.uniform(-0.8, 0.8), 0.0)


def _tension(rng: np.random.Generator) -> NDArray[np.float64]:
    """σ alone, which slips in opposite directions at the edges, R = 0 or fully reversed."""
    low = rng.choice([0.0, -1.0])
    t = np.array([1.0, low, 1.0, low])
    return _rows(1.0, 0.0, rng.uniform(0.2, 0.7) * t, 0.0)


def _out_of_phase(rng: np.random.Generator) -> NDArray[np.float64]:
    """σ a quarter of a cycle behind Q."""
    turn = np.array([1.0, 0.0, -1.0, 0.0, 1.0])
    behind = np.array([0.0, 1.0, 0.0, -1.0, 0.0])
    Q = rng.uniform(0.3, 0.7)
    return _rows(1.0, Q * turn, rng.uniform(-0.5, 0.5) * Q * behind, 0.0)


def _rolling(rng: np.random.Generator) -> NDArray[np.float64]:
    """P, Q and tilt in phase, R = 0."""
    t, Q = np.array([0.0, 1.0, 0.0, 1.0]), rng.uniform(0.4, 0.7)
    return _rows(1.0 + t * rng.uniform(-0.1, 0.1), t * Q, 0.0, t * rng.uniform(-0.06, 0.06))


def _held(rng: np.random.Generator) -> NDArray[np.float64]:
    """Q held while σ cycles, fully reversed."""
    Q, t = rng.uniform(0.2, 0.5), np.array([0.0, 1.0, -1.0, 1.0])
    return _rows(1.0, rng.choice([-1.0, 1.0]) * Q, t * rng.uniform(0.2, 0.9) * (1.0 - Q), 0.0)


def _under_tension(rng: np.random.Generator) -> NDArray[np.float64]:
    """σ held while Q cycles, fully reversed."""
    t, sigma = np.array([0.0, 1.0, -1.0, 1.0]), rng.uniform(0.1, 0.4)
    return _rows(1.0, t * rng.uniform(0.3, 0.6), rng.choice([-1.0, 1.0]) * sigma, 0.0)


KINDS: dict[str, Callable[[np.random.Generator], NDArray[np.float64]]] = {
    "constant P": _one_load,
    "oblique": _oblique,
    "proportional": _proportional,
    "R = 0": _from_zero,
    "σ alone": _tension,
    "in phase": _in_phase,
    "in phase, mean Q": _mean,
    "out of phase": _out_of_phase,
    "moment": _rolling,
}
# Slip turns at one edge alone: layers do not answer these.
MARCHED: dict[str, Callable[[np.random.Generator], NDArray[np.float64]]] = {
    "mean Q, σ cycles": _held,
    "mean σ, Q cycles": _under_tension,
}
