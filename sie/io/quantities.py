"""Quantities with units in a scene file, "500 N/mm" or "20 um", as numbers in the file's units.

Numbers without a unit stay as they are, in the units that [units] names. A text of a number and a
unit, where a quantity with a dimension belongs, is converted by pint. The arithmetic is exact, so
that "20 um" in mm is the number 0.02. Loads of a plane contact are forces per length. With
[units] checked = true, or where anything is converted, force has to be stress × length.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from types import ModuleType
from typing import Any

from .toml_values import shown

LENGTH, FORCE, STRESS = "a length", "a force per length", "a stress"
MOMENT, ANGLE = "a moment per length", "an angle"
# A number, then a product of powers of names. Nothing else reaches pint, which would compute it.
_NAME = r"[^\W\d_]+(?:(?:\*\*|\^)?-?[1-9]|[²³])?"
_UNIT = rf"(?:°|%|{_NAME})(?:\s*[*/·⋅ ]\s*{_NAME})*"
_QUANTITY = re.compile(rf"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{{1,3}})?)\s*({_UNIT})\s*")
_BETWEEN = re.compile(r"\s*([*/·⋅])\s*")
LONGEST = 60


@dataclass
class Converter:
    """The factors of units, in exact numbers, each asked of pint once.

    labels      the names of [units]: length, force and stress
    registry    the units of pint, None as long as nothing was converted or checked
    """

    labels: Mapping[str, str]
    factors: dict[tuple[str, str], Fraction | None] = field(default_factory=dict)
    registry: Any = None

    def number(self, where: str, value: Any, dimension: str) -> Any:
        """The value in the units of the file; what is no quantity is returned as it is."""
        if isinstance(value, list):
            return [self.number(f"{where}[{k}]", v, dimension) for k, v in enumerate(value)]
        short = isinstance(value, str) and len(value) <= LONGEST
        quantity = _QUANTITY.fullmatch(value) if short else None
        if not quantity:
            return value
        if self.registry is None:
            what = f"{where} = {shown(value)} is not a number, and a unit"
            self.begin(what, "write a plain number")
        size, unit = quantity.groups()
        target = self._target(dimension)
        if (unit, target) not in self.factors:
            self.factors[unit, target] = self._factor(unit, target)
        factor = self.factors[unit, target]
        if factor is None:
            raise ValueError(
                f"{where} = {shown(value)} is not a number and not {dimension}: give it in "
                f"{'deg' if dimension == ANGLE else target} or another unit of that kind"
            )
        try:
            return float(Fraction(size) * factor)
        except OverflowError:
            raise ValueError(
                f"{where} = {shown(value)} is beyond the floating-point range in {target}: "
                "choose other units"
            ) from None

    def begin(self, what: str, otherwise: str) -> None:
        """Ask pint for its units, and check those of the file. ValueError without pint."""
        try:
            self.registry = _registry(importlib.import_module("pint"))
        except ImportError:
            raise ValueError(
                f'{what} needs pint: pip install "plane-contact[units]", or {otherwise}'
            ) from None
        for name, label in self.labels.items():
            if not re.fullmatch(_UNIT, label[:LONGEST]) or self._factor(label, label) is None:
                raise ValueError(
                    f"[units] {name} = {shown(label)} is not a unit that pint knows: write it "
                    "like mm, N/mm or MPa"
                )
        product = f"{self.labels['stress']} {self.labels['length']}"
        if self._factor(product, self.labels["force"]) != 1:
            raise ValueError(
                f"[units] force = {shown(self.labels['force'])} is not stress × length, {product}: "
                "loads of a plane contact are per length, like N/mm with mm and MPa"
            )

    def _target(self, dimension: str) -> str:
        """The unit of the file for a dimension."""
        length, force, stress = (self.labels[name] for name in ("length", "force", "stress"))
        moment = f"{force} {length}"
        units = {LENGTH: length, FORCE: force, STRESS: stress, MOMENT: moment, ANGLE: "radian"}
        return units[dimension]

    def _factor(self, unit: str, target: str) -> Fraction | None:
        """How many of the target a unit is; None if pint does not know it or it is another kind."""
        try:
            size = self.registry.Quantity(Fraction(1), _product(unit))
            return Fraction(size.to(_product(target)).magnitude)
        except Exception:  # pint raises whatever its parser meets
            return None


@lru_cache(maxsize=1)
def _registry(pint: ModuleType) -> Any:
    """The units of pint in exact numbers; it takes a third of a second to make."""
    return pint.UnitRegistry(non_int_type=Fraction)


def _product(unit: str) -> str:
    """A unit as pint reads it, with * between factors."""
    return "*".join(_BETWEEN.sub(r"\1", unit).replace("·", "*").replace("⋅", "*").split())
