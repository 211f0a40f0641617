"""Readers of the entries of a scene file.

Each returns the value of the entry that `where` names, or raises ValueError with the remedy.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

from sie.arguments import shortened

Reader = Callable[[str, Any], Any]


def number(where: str, value: Any) -> float:
    """A number, as a float."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(
            f"{where} = {shown(value)} is not a number: "
            'write a plain number without quotes, or a length, load or stress like "20 um"'
        )
    try:
        return float(value)
    except OverflowError:
        raise ValueError(
            f"{where} = {shown(value)} is beyond the floating-point range: choose other units"
        ) from None


def text(where: str, value: Any) -> str:
    """One line of text."""
    if not isinstance(value, str):
        raise ValueError(f'{where} = {shown(value)} is not text: put it in quotes, "..."')
    if not value.isprintable():
        raise ValueError(
            f"{where} = {shown(value)} is not one line of plain text: "
            "leave out line ends and control characters"
        )
    return value


def flag(where: str, value: Any) -> bool:
    """A truth value."""
    if not isinstance(value, bool):
        raise ValueError(
            f"{where} = {shown(value)} is neither true nor false: write one of them, without quotes"
        )
    return value


def listed(where: str, value: Any) -> list[Any]:
    """A list."""
    if not isinstance(value, list):
        raise ValueError(f"{where} = {shown(value)} is not a list: put it in square brackets")
    return value


def numbers(where: str, value: Any) -> tuple[float, ...]:
    """A list of numbers."""
    if isinstance(value, list) and all(type(v) is float for v in value):
        return tuple(value)  # a trace, without a name for each of its numbers
    return tuple(number(f"{where}[{k}]", v) for k, v in enumerate(listed(where, value)))


def rows(where: str, value: Any) -> tuple[tuple[float, ...], ...]:
    """A list of lists of numbers."""
    return tuple(numbers(f"{where}[{k}]", v) for k, v in enumerate(listed(where, value)))


def rows_or_text(where: str, value: Any) -> tuple[tuple[float, ...], ...] | str:
    """A list of lists of numbers, or a text."""
    return text(where, value) if isinstance(value, str) else rows(where, value)


def texts(where: str, value: Any) -> tuple[str, ...]:
    """A list of texts."""
    return tuple(text(f"{where}[{k}]", v) for k, v in enumerate(listed(where, value)))


def text_or_pair(where: str, value: Any) -> str | tuple[str, ...]:
    """A text, or a list of texts."""
    return texts(where, value) if isinstance(value, list) else text(where, value)


def number_or_text(where: str, value: Any) -> float | str:
    """A number or a text."""
    return value if isinstance(value, str) else number(where, value)


def number_or_pair(where: str, value: Any) -> float | tuple[float, ...]:
    """A number or a list of numbers."""
    return numbers(where, value) if isinstance(value, list) else number(where, value)


def flag_or_pair(where: str, value: Any) -> bool | tuple[float, ...]:
    """A truth value or a pair of numbers."""
    if not isinstance(value, list):
        return flag(where, value)
    if len(value) != 2:
        raise ValueError(f"{where} = {shown(value)} is not a pair: give two ends, [lo, hi]")
    return numbers(where, value)


def whole(where: str, value: Any) -> int:
    """A whole number."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(
            f"{where} = {shown(value)} is not a whole number: write one, without quotes"
        )
    return value


def columns(where: str, value: Any) -> tuple[int | str, ...]:
    """A pair of column numbers or names."""
    if len(listed(where, value)) != 2:
        raise ValueError(f"{where} = {shown(value)} is not a pair: give the columns of x and of h")
    return tuple(
        v if isinstance(v, str) else whole(f"{where}[{k}]", v) for k, v in enumerate(value)
    )


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
    try:
        text = (
            {True: "true", False: "false"}[value]
            if isinstance(value, bool)
            else f'"{value}"'
            if isinstance(value, str)
            else str(value)
        )
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
