"""What an entry of a scene file may be, as JSON Schema, and how the reader takes it by that.

A shape is a schema: a type, words in an enum, an array of one shape, or one of two shapes.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NoReturn

from sie.arguments import LARGEST_COEFFICIENT, positive, shortened, suggestion

Shape = dict[str, Any]


def in_range(**limits: float) -> Shape:
    """A number; an editor refuses it beyond the limits, the scene beyond its own."""
    return {"type": "number", **limits}


def choice(words: Iterable[str]) -> Shape:
    """One of a few words."""
    return {"enum": [*words]}


def list_of(shape: Shape, **size: int) -> Shape:
    """A list of entries of a shape."""
    return {"type": "array", "items": shape, **size}


def either(first: Shape, other: Shape) -> Shape:
    """An entry of the first shape where the value has its type, otherwise of the other one."""
    return {"anyOf": [first, other]}


NUMBER, POSITIVE, TEXT = in_range(), in_range(exclusiveMinimum=0.0), {"type": "string"}
FLAG, WHOLE = {"type": "boolean"}, {"type": "integer"}
NUMBERS, TEXTS = list_of(NUMBER), list_of(TEXT)
TWO = {"minItems": 2, "maxItems": 2}


def value_of(where: str, value: Any, shape: Shape) -> Any:
    """The value of the entry that `where` names. ValueError, with the remedy, for another shape."""
    kind = shape.get("type")
    if "anyOf" in shape:
        first, other = shape["anyOf"]
        fits = isinstance(value, list if first.get("type") == "array" else str)
        return value_of(where, value, first if fits else other)
    if kind == "array":
        return _list(where, value, shape)
    if kind == "number":
        number = _number(where, value)
        at_least_0 = shape.get("exclusiveMinimum") == 0.0
        return positive(where, number, LARGEST_COEFFICIENT) if at_least_0 else number
    if kind == "boolean":
        return _of_type(where, value, bool, "neither true nor false: write one of them")
    if kind == "integer":
        return _of_type(where, value, int, "not a whole number: write one")
    if kind is None and _text(where, value) not in shape["enum"]:
        raise ValueError(f'{where} = "{value}" is not known: {suggestion(value, shape["enum"])}')
    return _text(where, value)


def _list(where: str, value: Any, shape: Shape) -> tuple[Any, ...]:
    if not isinstance(value, list):
        raise ValueError(f"{where} = {shown(value)} is not a list: put it in square brackets")
    if "maxItems" in shape and len(value) != 2:
        raise ValueError(f"{where} = {shown(value)} is not a pair: give two, [first, second]")
    if shape["items"] is NUMBER and all(type(v) is float for v in value):
        return tuple(value)  # a trace, without a name for each of its numbers
    return tuple(value_of(f"{where}[{k}]", v, shape["items"]) for k, v in enumerate(value))


def _number(where: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(
            f"{where} = {shown(value)} is not a number: write a plain number without quotes and "
            "unit, in the units of the file"
        )
    try:
        return float(value)
    except OverflowError:
        raise ValueError(
            f"{where} = {shown(value)} is beyond the floating-point range: choose other units"
        ) from None


def _text(where: str, value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f'{where} = {shown(value)} is not text: put it in quotes, "..."')
    if not value.isprintable():
        raise ValueError(
            f"{where} = {shown(value)} is not one line of plain text: "
            "leave out line ends and control characters"
        )
    return value


def _of_type(where: str, value: Any, python_type: type, said: str) -> Any:
    if type(value) is not python_type:
        raise ValueError(f"{where} = {shown(value)} is {said}, without quotes")
    return value


def table_of(where: str, value: Any) -> dict[str, Any]:
    """A table."""
    if isinstance(value, dict):
        return value
    if isinstance(value, list):
        raise ValueError(
            f"[{where}] is a list: write the header [{where}] once, in single brackets"
        )
    raise ValueError(
        f"{where} = {shown(value)} is not a table: write the header [{where}] and its keys below it"
    )


def shown(value: Any) -> str:
    """A value as TOML writes it, shortened."""
    if isinstance(value, bool):
        return str(value).lower()
    try:
        text = f'"{value}"' if isinstance(value, str) else str(value)
    except ValueError:  # Python writes no integer of more than 4300 digits
        text = "an integer of thousands of digits"
    return shortened(" ".join(text.split()))


def refuse_unread(path: str, problem: OSError, remedy: str) -> NoReturn:
    """Raise ValueError for a file that a scene names and that cannot be read."""
    absent = isinstance(problem, FileNotFoundError)
    why = "there is no such file" if absent else problem.strerror
    raise ValueError(
        f'path = "{shortened(path)}" is not read, {why}: '
        f"give {remedy}, from where the scene file is"
    ) from None
