"""Words of messages and reports: the nearest known name, a list of choices, readable lines."""

from __future__ import annotations

import difflib
import re
import textwrap
from collections.abc import Collection, Iterable
from typing import Any

WIDE = 80  # columns of a report
NAMES = 16  # columns of the names in it
LONGEST = 60  # characters of a value that a message shows
LONGEST_WORD = 255
LONGEST_LIST = 600  # characters of a list that is printed whole


def nearest(name: str, known: Iterable[str]) -> str:
    """The known name that `name` was most likely meant to be, "" if none is near.

    >>> nearest("normal_laod", ["normal_load", "tangential_load"])
    'normal_load'
    """
    if len(name) > LONGEST:
        return ""
    by_letters = {k.lower().replace("_", "-"): k for k in known}
    matches = difflib.get_close_matches(name.lower().replace("_", "-"), by_letters, n=1)
    return by_letters[matches[0]] if matches else ""


def suggestion(name: str, known: Iterable[str]) -> str:
    """The remedy for a name that is not known: the nearest known one, or the list of all."""
    near = nearest(name, known)
    return f'did you mean "{near}"?' if near else f"choose {choices(known)}"


def choices(names: Iterable[str]) -> str:
    """The names in quotes, with "or" before the last."""
    quoted = [f'"{name}"' for name in names]
    return f"{', '.join(quoted[:-1])} or {quoted[-1]}" if len(quoted) > 1 else quoted[0]


def shortened(text: str) -> str:
    """The text, cut where it is longer than `LONGEST` characters."""
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def with_short_words(sentence: object) -> str:
    """The sentence with its longest words cut: a key or a formula may be as long as a file."""
    return re.sub(rf"\S{{{LONGEST_WORD + 1},}}", lambda word: shortened(word[0]), str(sentence))


def listed(items: Collection[Any]) -> str:
    """The items as in a list, the first and the last alone where the whole is long.

    >>> listed([1.0, 2.0]), listed(range(1000))
    ('1.0, 2.0', '0, <998 more>, 999')
    """
    if len(items) <= LONGEST_LIST:
        whole = ", ".join(map(repr, items))
        if len(whole) <= LONGEST_LIST:
            return whole
    first, *between, last = items
    ends = (with_middle_cut(repr(item), LONGEST_LIST // 3) for item in (first, last))
    return f", <{len(between)} more>, ".join(ends)


def with_middle_cut(text: str, most: int = LONGEST_LIST) -> str:
    """The text, without its middle where it is longer than that.

    >>> with_middle_cut("a" * 9 + "b" * 9, 10)
    'aaaaa ... bbbbb'
    """
    return text if len(text) <= most else f"{text[: most // 2]} ... {text[-(most // 2) :]}"


def named_rows(*rows: tuple[str, str]) -> str:
    """Texts beside their names, broken into lines of at most WIDE columns.

    >>> print(named_rows(("tilt", "0"), ("", "not given")))
    tilt            0
                    not given
    """
    indent = " " * NAMES
    paragraphs = (
        textwrap.fill(
            text, WIDE, initial_indent=f"{name:<{NAMES}}", subsequent_indent=indent,
            break_long_words=False, break_on_hyphens=False,
        )
        for name, text in rows
    )  # fmt: skip
    return "\n".join(paragraphs)
