"""What an entry of a scene file may be: how it is read, and what its JSON Schema says.

A reader returns the value of the entry that `where` names, or raises ValueError with the remedy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, NoReturn

from sie.arguments import positive, shortened, suggestion

Json = dict[str, Any]


class Kind(NamedTuple):
    """A kind of entry: its reader, and the schema of what it takes."""

    read: Callable[[str, Any], Any]
    shape: Json


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


def _flag(where: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError(
            f"{where} = {shown(value)} is neither true nor false: write one of them, without quotes"
        )
    return value


def _whole(where: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(
            f"{where} = {shown(value)} is not a whole number: write one, without quotes"
        )
    return value


def in_range(**limits: float) -> Kind:
    """A number; an editor refuses it beyond the limits of the schema, the scene beyond its own."""
    return Kind(_number, {"type": "number", **limits})


NUMBER, TEXT = in_range(), Kind(_text, {"type": "string"})
FLAG, WHOLE = Kind(_flag, {"type": "boolean"}), Kind(_whole, {"type": "integer"})
POSITIVE = in_range(exclusiveMinimum=0.0)
# A number that nothing else checks.
CONSTANT = Kind(lambda where, value: positive(where, _number(where, value)), POSITIVE.shape)


def choice(words: Iterable[str]) -> Kind:
    """One of a few words."""
    known = [*words]

    def read(where: str, value: Any) -> str:
        if _text(where, value) not in known:
            raise ValueError(f'{where} = "{value}" is not known: {suggestion(value, known)}')
        return str(value)

    return Kind(read, {"enum": known})


def list_of(kind: Kind, pair: str = "") -> Kind:
    """A list of entries of a kind; a pair where it is said what to give as one."""

    def read(where: str, value: Any) -> tuple[Any, ...]:
        if not isinstance(value, list):
            raise ValueError(f"{where} = {shown(value)} is not a list: put it in square brackets")
        if pair and len(value) != 2:
            raise ValueError(f"{where} = {shown(value)} is not a pair: {pair}")
        if kind is NUMBER and all(type(v) is float for v in value):
            return tuple(value)  # a trace, without a name for each of its numbers
        return tuple(kind.read(f"{where}[{k}]", v) for k, v in enumerate(value))

    size = {"minItems": 2, "maxItems": 2} if pair else {}
    return Kind(read, {"type": "array", "items": kind.shape, **size})


def by_type(python_type: type, kind: Kind, other: Kind) -> Kind:
    """An entry of one kind where the value has the type, otherwise of the other kind."""

    def read(where: str, value: Any) -> Any:
        return (kind if isinstance(value, python_type) else other).read(where, value)

    return Kind(read, {"anyOf": [kind.shape, other.shape]})


NUMBERS, TEXTS = list_of(NUMBER), list_of(TEXT)
PAIR = list_of(NUMBER, "give two numbers, [first, second]")


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
