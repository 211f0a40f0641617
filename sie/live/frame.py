"""The fixed axes of an indenter's pictures, and the surface that is drawn in them.

The axes hold the answer under the largest load of the slider. They stay while sliders move, so that
a small load looks small; the page widens them where an answer exceeds them.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sie import Scene, Solution
from sie.errors import ContactError
from sie.io.beside_scene import Units

from .setting import ACROSS, DEPTH, DOWN, OF_FILE, ROUNDED, WEDGE, Setting, sliders, solution_of

Array = NDArray[np.float64]

MARGIN = 1.8  # half of the picture's width over the half-width of the contact
SHOWN = 0.9  # of the points lie below the top of the picture of an infinite traction
POINTS = 121


@dataclass(frozen=True)
class Frame:
    """The limits of the axes.

    lo, hi      the positions x, length
    p, q        the largest pressure and shear, stress
    height      the largest height of the deformed surface, length
    mises       the largest Mises stress, stress; 0 where it is not known
    """

    lo: float
    hi: float
    p: float
    q: float
    height: float
    mises: float

    @property
    def columns(self) -> Array:
        """The positions of the stress."""
        return np.linspace(self.lo, self.hi, ACROSS)

    @property
    def rows(self) -> Array:
        """The depths of the stress."""
        return np.linspace(0.0, DEPTH * (self.hi - self.lo), DOWN)


@lru_cache(maxsize=8)
def frame_of(shape: str, file: Scene | None) -> Frame:
    """The axes of an indenter, for all settings of its sliders.

    Raises
    ------
    ContactError, ValueError
        If there is no answer at any of its loads.
    """
    values = {control.name: control.values for control in sliders(file)}
    first = Setting.of_words({"shape": shape}, file)
    flats = values["flat"] if shape == ROUNDED else (first.flat,)
    loads = (*values["load"][::-1], first.load)
    frames = [_first_frame(replace(first, flat=flat), loads) for flat in {flats[0], flats[-1]}]
    return Frame(
        min(frame.lo for frame in frames),
        max(frame.hi for frame in frames),
        *(max(getattr(frame, name) for frame in frames) for name in ("p", "q", "height", "mises")),
    )


def _first_frame(setting: Setting, loads: tuple[float, ...]) -> Frame:
    """The axes of the first of the loads that has an answer."""
    for load in loads[:-1]:
        with suppress(ContactError, ValueError):
            return _frame(solution_of(replace(setting, load=load)))
    return _frame(solution_of(replace(setting, load=loads[-1])))


def _frame(solution: Solution) -> Frame:
    (lo, hi), friction = solution.edges, solution.scene.friction
    middle, half = (lo + hi) / 2, MARGIN * (hi - lo) / 2
    p, _ = tops(solution, *inside(solution)[1:])
    x = np.linspace(middle - half, middle + half, POINTS)
    _, body = surface(solution, x)
    frame = Frame(
        float(x[0]), float(x[-1]), p, (friction or 1.0) * p, float(np.nanmax(np.abs(body))), 0.0
    )
    try:
        return replace(frame, mises=float(mises(solution, frame)[1]))
    except (ContactError, ValueError):  # Poisson's ratio is not known
        return frame


def inside(solution: Solution) -> tuple[Array, Array, Array]:
    """Positions in the contact, closer together at its edges, and the finite p and q there."""
    lo, hi = solution.edges
    x = (lo + hi) / 2 + (hi - lo) / 2 * np.sin(np.linspace(-np.pi / 2, np.pi / 2, POINTS))
    pressure, shear = solution.pressure(x), solution.shear(x)
    finite = np.isfinite(pressure) & np.isfinite(shear)
    return x[finite], pressure[finite], shear[finite]


def tops(solution: Solution, pressure: Array, shear: Array) -> tuple[float, float]:
    """The tops of the pictures of p and q: beyond them a curve goes to infinity."""
    infinite = len(pressure) < POINTS
    p, q = (np.quantile(v, SHOWN) if infinite else v.max() for v in (pressure, np.abs(shear)))
    return 1.08 * float(p), 1.08 * float(q)


def mises(solution: Solution, frame: Frame) -> tuple[Array, float]:
    """The Mises stress on the grid of a frame, and the largest that is drawn."""
    values = solution.stress(frame.columns[None, :], frame.rows[:, None]).mises
    # A peak at one point would leave one colour for all others.
    top = float(np.quantile(values[np.isfinite(values)], 0.998))
    return np.nan_to_num(values, posinf=top), top


def surface(solution: Solution, x: Array) -> tuple[Array, Array]:
    """Heights of the indenter and of the deformed body, which has all of the deformation.

    In the frame of the indenter. The indenter's is nan beyond its ends. There the surface
    continues from the nearest edge e by the line of contact's displacement,
    2/(π E*) ∫p(t) ln|(x - t)/(e - t)| dt.
    """
    punch = indenter(solution, x)
    outside = ~np.isfinite(punch)
    punch[outside] = np.nan
    body = np.full_like(punch, np.nan)
    body[~outside] = punch[~outside] - solution.gap(x[~outside])
    if outside.any():
        lo, hi = solution.edges
        angle = np.pi * (np.arange(2 * POINTS) + 0.5) / (2 * POINTS) - np.pi / 2
        t = (lo + hi) / 2 + (hi - lo) / 2 * np.sin(angle)
        force = solution.pressure(t) * np.cos(angle) * (hi - lo) * np.pi / (4 * POINTS)
        away = x[outside]
        edge = np.where(away < (lo + hi) / 2, lo, hi)
        logarithm = np.log(np.abs((away[:, None] - t) / (edge[:, None] - t)))
        Estar = solution.scene.Estar
        body[outside] = indenter(solution, edge) + 2 / (np.pi * Estar) * (logarithm @ force)
    return punch, body


def indenter(solution: Solution, x: Array) -> Array:
    """The tilted indenter's height; inf beyond its ends."""
    return np.asarray(solution.scene.profile.height(x) + solution.tilt * x, dtype=float)


def words(shape: str, units: Units | None) -> dict[str, str]:
    """How a quantity of a shape is named: over R and E*, or with the units of the file."""
    if shape == OF_FILE:
        kinds = ("length", "force", "stress")
        return {kind: f"{{}} ({getattr(units, kind)})" if units else "{}" for kind in kinds}
    unit = "L" if shape == WEDGE else "R"
    return {"length": f"{{}} / {unit}", "force": f"{{}} / (E* {unit})", "stress": "{} / E*"}
