"""Units of length in the head of a trace, and the reading of its columns.

A unit stands behind the name of a column, as in "x [um]", "Lateral um" or "z_um", or a line of the
head has a unit for each column, as in "µm µm". A number before it makes it a quantity, which is no
unit of a column.
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments

Array = NDArray[np.float64]
Side = Literal["gap", "surface"]
SIDES = ("gap", "surface")
Scale = tuple[float, float] | None
CLOSE = 1e-9  # of a factor: a given scale is that of the units, to rounding

METRES = {
    "km": "1e3", "m": "1", "dm": "1e-1", "cm": "1e-2", "mm": "1e-3", "um": "1e-6", "nm": "1e-9",
    "pm": "1e-12", "å": "1e-10", "in": "254e-4", "mil": "254e-7",
}  # fmt: skip
WORDS = {
    "meter": "m", "millimeter": "mm", "micrometer": "um", "micron": "um", "nanometer": "nm",
    "angstrom": "å", "inch": "in",
}  # fmt: skip
BRACKETS = r"[\[(]\s*([^\W\d]+)\s*[\])]"


class Reading(NamedTuple):
    """How the columns of a file were read.

    file      its name; "" for a trace that is not from a file
    units     of x and of h, where they are known, and "" where not
    length    the unit of the scene's lengths; "" where it was not needed
    scale     the factors that were given, as text; "" for none
    side      "gap", "surface", or "" where it was not stated and the gap is assumed
    """

    file: str = ""
    units: tuple[str, str] = ("", "")
    length: str = ""
    scale: str = ""
    side: Side | Literal[""] = ""

    def __str__(self) -> str:
        x, h = self.units
        taken = f"x in {x or '?'} and h in {h or '?'}" if x or h else "without units"
        if self.scale:
            taken += f", times {self.scale}"
        elif self.length:
            taken += f", converted to {self.length}"
        sides = {
            "gap": "h is the gap",
            "surface": "h is the height of a surface, turned over",
            "": 'h is taken for the gap (heights = "surface" if it is that of a surface)',
        }
        return f"{self.file}: {taken}; {sides[self.side]}"


def unit_named(text: str) -> str:
    """The unit of length that a text names, "" for any other text."""
    name = text.strip().lower().replace("µ", "u").replace("μ", "u").rstrip(".")
    name = name.replace("metre", "meter")
    return name if name in METRES else WORDS.get(name, WORDS.get(name.removesuffix("s"), ""))


def units_of_head(
    lines: list[str], separator: str, width: int, indices: tuple[int, ...]
) -> tuple[str, str]:
    """The units of two columns by the last line of the head that has some, "" where none."""
    for line in reversed(lines):
        found = _units_of_line(line.strip().lstrip("#% "), separator, width)
        x, h = (found[k] if k < len(found) else "" for k in indices)
        if (x and h) or ((x or h) and len(found) == width):
            return x, h
    return "", ""


def _units_of_line(line: str, separator: str, width: int) -> list[str]:
    words = [unit_named(word) for word in re.split(r"[\s,;]+", line) if word]
    if words and all(words):
        return words
    in_brackets = re.findall(BRACKETS, line)
    if not separator and len(in_brackets) == width:
        return [unit_named(unit) for unit in in_brackets]
    return [_unit_of_cell(cell) for cell in (line.split(separator) if separator else line.split())]


def _unit_of_cell(cell: str) -> str:
    """The unit in brackets, or in the last of several words, in "Lateral um" or "x_um"."""
    cell = cell.strip().strip('"')
    bracketed = re.findall(BRACKETS, cell)
    if bracketed:
        return unit_named(bracketed[-1])
    *before, last = re.split(r"[\s_/]+", cell)
    return "" if not before or re.search(r"\d$", before[-1]) else unit_named(last)


def stated(units: Any) -> tuple[str, str]:
    """The units of x and h as a caller gives them. ValueError where they are no lengths."""
    both = (units, units) if isinstance(units, str) else tuple(units or ())
    if not units:
        return "", ""
    if len(both) != 2 or not all(isinstance(u, str) and unit_named(u) for u in both):
        known = ", ".join(METRES)
        raise ValueError(f"units = {units!r} are not units of x and h: give one or two of {known}")
    return unit_named(both[0]), unit_named(both[1])


def scale_of(scale: Any) -> Scale:
    """The given factors of x and h, or None. ValueError for factors that make no trace."""
    if scale is None:
        return None
    pair = tuple(scale) if isinstance(scale, (tuple, list)) else (scale, scale)
    if len(pair) != 2:
        raise ValueError(
            f"scale = {scale!r} is not a factor or a pair: give one for x and one for h"
        )
    x, h = (arguments.finite("scale", f) for f in pair)
    if x <= 0.0 or h == 0.0:
        raise ValueError(
            f"scale = {scale!r}: the factor of x must be positive and that of h not zero"
        )
    return x, h


def side_of(heights: Any, scale: Scale) -> Side | Literal[""]:
    """The side that heights or the sign of a scale states. ValueError where they contradict."""
    if heights and not arguments.among(heights, SIDES):
        raise ValueError(f'heights = {heights!r} is not known: give "gap" or "surface"')
    turned = scale is not None and scale[1] < 0.0
    if turned and heights:
        raise ValueError(
            f"scale = {scale!r} turns the heights over, beside heights = {heights!r}: give "
            'heights = "surface" and a positive scale'
        )
    side: Side | Literal[""] = "surface" if turned else heights
    return side


def factors(file: str, units: tuple[str, str], length: str, scale: Scale) -> tuple[float, float]:
    """The factors that the units ask for, or the given ones where they are the same.

    ValueError where a unit is unknown or lacks, or where the scale contradicts the units.
    """
    x, h = units
    head = f"{file} has x in {x or 'no stated unit'} and h in {h or 'no stated unit'}"
    known = unit_named(length)
    if scale is not None:
        if x and h:  # with no length their ratio is known
            ratios = [_ratio(u, length) for u in units] if known else [1.0, _ratio(h, x)]
            wanted = ratios if known else [scale[0] * f for f in ratios]
            given = [abs(f) for f in scale]
            if any(abs(f - w) > CLOSE * w for f, w in zip(given, wanted, strict=True)):
                raise ValueError(
                    f"{head}, which scale = ({given[0]:g}, {given[1]:g}) contradicts: leave scale "
                    f"out, or give ({wanted[0]:g}, {wanted[1]:g}), or units = ... if the head is "
                    "wrong"
                )
        return scale
    if not x and not h:
        return 1.0, 1.0
    if not (x and h):
        raise ValueError(f'{head}: state both, as units = ("{x or h}", "{x or h}")')
    length = length or ("mm" if x == h == "mm" else "")  # as scene files have it
    if not unit_named(length):
        wanting = f"length = {length!r} is no unit" if length else "the scene's unit is not stated"
        raise ValueError(
            f'{head}, and {wanting}: give length = "mm" or another, the unit to convert them to'
        )
    return _ratio(x, length), _ratio(h, length)


def _ratio(unit: str, length: str) -> float:
    """How many of a length a unit is."""
    return float(Fraction(METRES[unit]) / Fraction(METRES[unit_named(length)]))


def as_gap(h: Array) -> Array:
    """The gap of a surface of these heights: from the highest point down."""
    finite = h[np.isfinite(h)]
    return (finite.max() if finite.size else 0.0) - h
