"""Quantities with units in a scene file, "500 N/mm" or "20 um", as numbers in the file's units.

Numbers without a unit stay as they are, in the units that [units] names. A text of a number and a
unit, where a quantity with a dimension belongs, is converted by pint. The arithmetic is exact, so
that "20 um" in mm is the number 0.02. Loads of a plane contact are forces per length. With
[units] checked = true, or where anything is converted, force has to be stress × length.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from types import ModuleType
from typing import Any

from .toml_values import shown

LENGTH, FORCE, STRESS = "a length", "a force per length", "a stress"
MOMENT, ANGLE = "a moment per length", "an angle"
# The dimension of each key that has one, by table.
BODY = {"young": STRESS}
PROFILE = dict.fromkeys(
    (
        "radius", "half_flat", "half_width", "x", "h", "breaks", "domain", "levelled", "shifted",
        "raised", "period",
    ), LENGTH,
) | {"tilted": ANGLE}  # fmt: skip
TABLES: dict[str, Mapping[str, str]] = {
    "profile": PROFILE,
    "body": BODY,
    "indenter": BODY,
    "pair": {"modulus": STRESS},
    "load": {
        "normal_load": FORCE,
        "tangential_load": FORCE,
        "half_width": LENGTH,
        "tilt": ANGLE,
        "moment": MOMENT,
        "bulk_stress": STRESS,
    },
    "fatigue": {"shear_limit": STRESS, "yield_stress": STRESS, "depth": LENGTH},
}
# Tables in [profile] that are like it.
TERMS = ("of", "plus")
# Lower-case names of the columns of [load] path, and what they are without names.
COLUMNS = {
    "p": FORCE, "normal_load": FORCE, "q": FORCE, "tangential_load": FORCE, "sigma": STRESS,
    "σ": STRESS, "bulk_stress": STRESS, "tilt": ANGLE, "moment": MOMENT,
}  # fmt: skip
UNNAMED = ("P", "Q", "sigma")
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
    """

    labels: Mapping[str, str]
    factors: dict[tuple[str, str], Fraction | None] = field(default_factory=dict)
    registry: Any = None

    def number(self, where: str, value: Any, dimension: str) -> Any:
        """The value in the units of the file; what is no quantity is returned as it is."""
        if isinstance(value, list):
            return [self.number(f"{where}[{k}]", v, dimension) for k, v in enumerate(value)]
        if not isinstance(value, str) or len(value) > LONGEST:
            return value
        found = _QUANTITY.fullmatch(value)
        if not found:
            return value
        if self.registry is None:
            what = f"{where} = {shown(value)} is not a number, and a unit"
            self.begin(what, "write a plain number")
        size, unit = found.groups()
        if (unit, dimension) not in self.factors:
            self.factors[unit, dimension] = self._factor(unit, self.target(dimension))
        factor = self.factors[unit, dimension]
        if factor is None:
            example = self.target(dimension) if dimension != ANGLE else "deg"
            raise ValueError(
                f"{where} = {shown(value)} is not a number and not {dimension}: give it in "
                f"{example} or another unit of that kind"
            )
        try:
            return float(Fraction(size) * factor)
        except OverflowError:
            raise ValueError(
                f"{where} = {shown(value)} is beyond the floating-point range in "
                f"{self.target(dimension)}: choose other units"
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

    def target(self, dimension: str) -> str:
        """The unit of the file for a dimension."""
        if dimension == ANGLE:
            return "radian"
        if dimension == MOMENT:
            return f"{self.labels['force']} {self.labels['length']}"
        return self.labels[{LENGTH: "length", FORCE: "force", STRESS: "stress"}[dimension]]

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


def in_units(
    top: Mapping[str, Any], labels: Mapping[str, str], checked: bool
) -> tuple[dict[str, Any], bool]:
    """The tables of a scene file with numbers in place of quantities, and whether it uses units.

    ValueError for a quantity of a wrong dimension, or if pint is needed and not installed.
    """
    convert = Converter(labels)
    if checked:
        convert.begin("[units] checked = true", "leave checked out")
    tables = {
        name: _converted(f"[{name}]", value, TABLES.get(name, {}), convert)
        for name, value in top.items()
    }
    load = tables.get("load")
    if isinstance(load, dict) and isinstance(load.get("path"), list):
        tables["load"] = load | {"path": _rows(load["path"], load.get("columns"), convert)}
    return tables, convert.registry is not None


def _converted(where: str, value: Any, keys: Mapping[str, str], convert: Converter) -> Any:
    """A table, or the tables of a list, with numbers in place of quantities."""
    if isinstance(value, list) and all(isinstance(part, dict) for part in value):
        return [_converted(where, part, keys, convert) for part in value]
    if not isinstance(value, dict):
        return value
    terms = {
        key: _converted(f"[[profile.{key}]]", value[key], keys, convert)
        for key in TERMS
        if key in value and keys is PROFILE
    }
    return (
        value
        | terms
        | {
            key: convert.number(f"{where} {key}", value[key], dimension)
            for key, dimension in keys.items()
            if key in value
        }
    )


def _rows(path: Sequence[Any], columns: Any, convert: Converter) -> list[Any]:
    """The rows of a load path; each column has its dimension."""
    names = columns if isinstance(columns, list) else UNNAMED
    kinds = [COLUMNS.get(name.lower()) if isinstance(name, str) else None for name in names]
    return [
        [
            convert.number(f"[load] path[{i}][{j}]", v, kind) if kind else v
            for j, (v, kind) in enumerate(zip(row, [*kinds, *[None] * len(row)], strict=False))
        ]
        if isinstance(row, list)
        else row
        for i, row in enumerate(path)
    ]
