"""The page's indenters and sliders, and the size of its pictures.

Lengths are in R and stresses in E*. P₀ = 1e-4 E* R presses a steel cylinder to 650 MPa.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from sie.problem.scene import Scene
from sie.profiles.row import Row
from sie.profiles.shapes import Parabola, Wedge

ROUNDED, WEDGE, OF_FILE = "rounded flat", "wedge", "scene file"
LOAD = 1e-4  # P₀ of the four indenters, over E* R
SHAPES = {
    "parabola": Parabola(1.0),
    WEDGE: Wedge(0.01),
    "two parabolas": Row([Parabola(1.0).shifted(-0.011), Parabola(0.5).shifted(0.011)]),
}
ACROSS, DOWN = 81, 51  # points of the picture of the stress, which the page refines
DEPTH = 0.62  # of that picture over its width
NODES = (4, 8, 16, 32, 64, 128)  # of the textbook's method


@dataclass(frozen=True)
class Control:
    """One slider: its name, what stands beside it, its values, and the one it starts with.

    `more` moves it under the fold of the page.
    """

    name: str
    label: str
    values: tuple[float, ...]
    start: float
    more: bool = False

    def nearest(self, value: float) -> float:
        """The value of the slider nearest to a number."""
        return min(self.values, key=lambda known: abs(known - value))

    def starting(self, value: float) -> Control:
        """The slider with this value too, which it starts with."""
        return replace(self, values=tuple(sorted({*self.values, value})), start=value)


def _steps(low: float, high: float, step: float) -> tuple[float, ...]:
    return tuple(round(low + step * k, 10) for k in range(round((high - low) / step) + 1))


LIVE = (
    Control("flat", "flat part a/R", _steps(0.001, 0.010, 0.001), 0.005),
    Control("load", "load P/P₀", _steps(0.1, 2.0, 0.1), 1.0),
    Control("tilt", "tilt / (p̄/E*)", _steps(-1.0, 1.0, 0.05), 0.0),
    Control("friction", "friction f", _steps(0.0, 1.0, 0.05), 0.5),
    Control("share", "tangential load Q/(f P)", _steps(-1.0, 1.0, 0.05), 0.6),
    Control("bulk", "bulk stress σ/p̄", _steps(-1.0, 1.0, 0.05), 0.0, more=True),
    Control("beta", "Dundurs' β", _steps(0.0, 0.5, 0.05), 0.0, more=True),
)
# Each combination is solved before the page is saved.
_KEPT = {
    "flat": (0.002, 0.005, 0.01),
    "load": (0.3, 1.0, 2.0),
    "tilt": (0.0, 0.5),
    "friction": (0.5,),
    "share": (0.0, 0.6, 0.9),
    "bulk": (0.0, 0.4),
    "beta": (0.0, 0.3),
}
SAVED = tuple(replace(control, values=_KEPT[control.name]) for control in LIVE)


def shapes(file: Scene | None) -> tuple[str, ...]:
    """The indenters to choose from; that of the file is the first."""
    return (*((OF_FILE,) if file is not None else ()), ROUNDED, *SHAPES)
