"""Entries of a scene file, each with the sentence that refuses it, and the nearest to a name that is not known."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable
from typing import Any

Reader = Callable[[str, Any], Any]
LONGEST = 60  # letters of a value that are shown


def number(where: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(
            f"{where} = {shown(value)} is not a number: write a plain number, without quotes or units"
        )
    try:
        return float(value)
    except OverflowError:
        raise ValueError(
            f"{where} = {shown(value)} is beyond the floating-point range: choose other units"
        ) from None


def text(where: str, value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f'{where} = {shown(value)} is not text: put it in quotes, "..."')
    if not value.isprintable():
        raise ValueError(
            f"{where} = {shown(value)} is not one line of plain text: leave out line ends and control characters"
        )
    return value


def flag(where: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError(
            f"{where} = {shown(value)} is neither true nor false: write one of them, without quotes"
        )
    return value


def listed(where: str, value: Any) -> list[Any]:
    if not isinstance(value, list):
        raise ValueError(f"{where} = {shown(value)} is not a list: put it in square brackets")
    return value


def numbers(where: str, value: Any) -> tuple[float, ...]:
    if isinstance(value, list) and all(type(v) is float for v in value):
        return tuple(value)  # a trace, without a name for each of its numbers
    return tuple(number(f"{where}[{k}]", v) for k, v in enumerate(listed(where, value)))


def rows(where: str, value: Any) -> tuple[tuple[float, ...], ...]:
    return tuple(numbers(f"{where}[{k}]", v) for k, v in enumerate(listed(where, value)))


def texts(where: str, value: Any) -> tuple[str, ...]:
    return tuple(text(f"{where}[{k}]", v) for k, v in enumerate(listed(where, value)))


def number_or_text(where: str, value: Any) -> float | str:
    return value if isinstance(value, str) else number(where, value)


def number_or_pair(where: str, value: Any) -> float | tuple[float, ...]:
    return numbers(where, value) if isinstance(value, list) else number(where, value)


def whole(where: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(
            f"{where} = {shown(value)} is not a whole number: write one, without quotes"
        )
    return value


def columns(where: str, value: Any) -> tuple[int | str, ...]:
    if len(listed(where, value)) != 2:
        raise ValueError(f"{where} = {shown(value)} is not a pair: give the columns of x and of h")
    return tuple(
        v if isinstance(v, str) else whole(f"{where}[{k}]", v) for k, v in enumerate(value)
    )


def table(where: str, value: Any) -> dict[str, Any]:
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


def shortened(text: str) -> str:
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def told(sentence: object) -> str:
    """A sentence without words that nobody reads: a key or a formula may be as long as a file."""
    return re.sub(r"\S{256,}", lambda word: shortened(word[0]), str(sentence))


# -- names that are not known ------------------------------------------------------------------------------------------


def nearest(name: str, known: Iterable[str]) -> str:
    """The known name that `name` was most likely meant to be, "" if none is near.

    >>> nearest("normal_laod", ["normal_load", "tangential_load"])
    'normal_load'
    """
    if len(name) > LONGEST:
        return ""
    by_letters = {k.lower().replace("_", "-"): k for k in known}
    found = difflib.get_close_matches(name.lower().replace("_", "-"), by_letters, n=1)
    return by_letters[found[0]] if found else ""


def suggestion(name: str, known: Iterable[str]) -> str:
    near = nearest(name, known)
    return f'did you mean "{near}"?' if near else f"choose {choices(known)}"


def choices(names: Iterable[str]) -> str:
    quoted = [f'"{name}"' for name in names]
    return f"{', '.join(quoted[:-1])} or {quoted[-1]}" if len(quoted) > 1 else quoted[0]
