"""The page's indenters and sliders, and the size of its pictures."""

from __future__ import annotations

from dataclasses import dataclass, replace

from sie.problem.scene import Scene
from sie.profiles.row import Row
from sie.profiles.shapes import Parabola, Wedge

ROUNDED, OF_FILE = "rounded flat", "scene file"
SHAPES = {
    "parabola": Parabola(1.0),
    "wedge": Wedge(0.3),
    "two parabolas": Row([Parabola(1.0).shifted(-0.7), Parabola(0.5).shifted(0.7)]),
}
ACROSS, DOWN, BANDS = 120, 60, 14  # of the picture of the stress


@dataclass(frozen=True)
class Control:
    """One slider: its name, what stands beside it, its values, and the one it starts with."""

    name: str
    label: str
    values: tuple[float, ...]
    start: float

    def nearest(self, value: float) -> float:
        """The value of the slider nearest to a number."""
        return min(self.values, key=lambda known: abs(known - value))

    def starting(self, value: float) -> Control:
        """The slider with this value too, which it starts with."""
        return replace(self, values=tuple(sorted({*self.values, value})), start=value)


def _steps(low: float, high: float, step: float) -> tuple[float, ...]:
    return tuple(round(low + step * k, 10) for k in range(round((high - low) / step) + 1))


LIVE = (
    Control("ratio", "flat part a/b", _steps(0.05, 0.95, 0.05), 0.5),
    Control("load", "load P / P₀", _steps(0.1, 3.0, 0.1), 1.0),
    Control("tilt", "tilt / (p̄/E*)", _steps(-1.0, 1.0, 0.05), 0.0),
    Control("friction", "friction f", _steps(0.0, 1.0, 0.05), 0.5),
    Control("share", "tangential load Q/(f P)", _steps(-1.0, 1.0, 0.05), 0.6),
    Control("bulk", "bulk stress σ/p̄", _steps(-1.0, 1.0, 0.05), 0.0),
    Control("beta", "Dundurs' β", _steps(0.0, 0.5, 0.05), 0.0),
)
# Each combination is solved before the page is saved.
SAVED = (
    Control("ratio", "flat part a/b", (0.2, 0.5, 0.8), 0.5),
    Control("load", "load P / P₀", (0.3, 1.0, 3.0), 1.0),
    Control("tilt", "tilt / (p̄/E*)", (0.0, 0.5), 0.0),
    Control("friction", "friction f", (0.5,), 0.5),
    Control("share", "tangential load Q/(f P)", (0.0, 0.6, 0.9), 0.6),
    Control("bulk", "bulk stress σ/p̄", (0.0, 0.4), 0.0),
    Control("beta", "Dundurs' β", (0.0, 0.3), 0.0),
)


def shapes(file: Scene | None) -> tuple[str, ...]:
    """The indenters to choose from; that of the file is the first."""
    return (*((OF_FILE,) if file is not None else ()), ROUNDED, *SHAPES)
