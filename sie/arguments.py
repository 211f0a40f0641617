"""Checks of arguments, and the words of refusals and reports.

A refusal is one sentence with the value and the remedy.
"""

from __future__ import annotations

import difflib
import math
import re
import textwrap
from collections.abc import Callable, Collection, Hashable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

# A load, a place x, the value there and the other side of the equation that checks it are rounded
# by eps/2 each.
FINEST = 2.0 * float(np.finfo(float).eps)
# Lengths, stresses and numbers: of larger ones the product of two is not a double. Those that are
# such products, loads and moments, may be larger, and so may coefficients of powers of a length.
LARGEST, LARGEST_LOAD, LARGEST_COEFFICIENT = 1e150, 1e250, 1e300
REMEDY = "choose other units"
WIDE = 80  # columns of a report
NAMES = 16  # columns of the names in it
LONGEST = 60  # characters of a value that a message shows
LONGEST_WORD = 255
LONGEST_LIST = 600  # characters of a list that is printed whole


def real(name: str, value: Any) -> float:
    """`value` as a float; ValueError unless it is one number (nan is not a number)."""
    if isinstance(value, (bool, str, bytes)):
        raise ValueError(f"{name} = {value!r} is not a number: give a float")
    if value is np.ma.masked:
        raise ValueError(f"{name} is masked: give a number")
    try:
        number = float(value)
    except OverflowError:
        raise ValueError(
            f"{name} is a whole number beyond the range of doubles: {REMEDY}"
        ) from None
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {value!r} is not a number: give a float") from None
    if math.isnan(number):
        raise ValueError(f"{name} is nan: give a number")
    return number


def finite(name: str, value: Any) -> float:
    """`value` as a float; ValueError unless it is one finite number."""
    number = real(name, value)
    if math.isinf(number):
        raise ValueError(f"{name} = {number} is infinite: give a finite number")
    return number


def measure(name: str, value: Any, largest: float = LARGEST) -> float:
    """A finite number that may be multiplied with others."""
    number = finite(name, value)
    if abs(number) > largest:
        raise ValueError(
            f"{name} = {number:g} is more than {largest:g} in size, "
            f"where products leave the range of doubles: {REMEDY}"
        )
    return number


def positive(name: str, value: Any, largest: float = LARGEST) -> float:
    """A number > 0 that may be multiplied with others and divided by."""
    number = measure(name, value, largest)
    if number <= 0.0:
        raise ValueError(f"{name} = {number:g} is not positive: give {name} > 0")
    if number < 1.0 / largest:
        raise ValueError(
            f"{name} = {number:g} is less than {1.0 / largest:g}, "
            f"where products leave the range of doubles: {REMEDY}"
        )
    return number


def positives(name: str, value: Any, largest: float = LARGEST) -> Any:
    """The same of a number, or of an array of numbers that will not be written to."""
    if not isinstance(value, np.ndarray) or not value.ndim:
        return positive(name, value, largest)
    array = reals(name, value).copy()
    for extreme in (array.min(initial=1.0), array.max(initial=1.0)):
        positive(name, extreme, largest)
    array.flags.writeable = False
    return array


def not_negative(name: str, value: Any) -> float:
    """A finite number >= 0."""
    number = finite(name, value)
    if number < 0.0:
        raise ValueError(f"{name} = {number:g} is negative: give {name} >= 0")
    return number


def tolerance(value: Any) -> float:
    """A relative accuracy that doubles can hold: below 1, and not below FINEST."""
    tol = positive("tol", value)
    if tol < FINEST:
        raise ValueError(
            f"tol = {tol:g} is below {FINEST:.2g}, the rounding of doubles: give at least that"
        )
    if tol >= 1.0:
        raise ValueError(f"tol = {tol:g} lets any answer pass: give a relative accuracy below 1")
    return tol


def listed(name: str, values: Any, what: str) -> tuple[Any, ...]:
    """The items of a list or another collection; otherwise ValueError, with what to give."""
    single = isinstance(values, (str, bytes)) or getattr(values, "shape", None) == ()
    if isinstance(values, Iterable) and not single:
        refuse_masked(name, values)
        return tuple(values)
    raise ValueError(f"{name} = {values!r} is not a list: give {what}")


def among(value: Any, choices: Collection[Any]) -> bool:
    """Whether a value of any type is one of the choices; an array, which is unhashable, is not."""
    return isinstance(value, Hashable) and value in choices


def reals(name: str, values: Any) -> NDArray[np.float64]:
    """`values` as an array of floats; ValueError unless they are real numbers, inf or nan."""
    return _numbers(name, values, float, "an array of real numbers: give positions as floats")


def complexes(name: str, values: Any) -> NDArray[np.complex128]:
    """`values` as an array of complex numbers; ValueError unless they are numbers, inf or nan."""
    said = "an array of numbers: give points x + iy as complex numbers"
    return _numbers(name, values, complex, said)


def _numbers(name: str, values: Any, kind: type, said: str) -> NDArray[Any]:
    refuse_masked(name, values)
    array = _array(values)
    try:
        if array.dtype.kind in "fiu" or (kind is complex and array.dtype.kind == "c"):
            return array.astype(kind, copy=False)
        if array.dtype.kind == "O":  # numbers of other libraries; None would become nan
            return np.array([kind(value) for value in array.flat]).reshape(array.shape)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ValueError(f"{name} is not {said}")


def of_one_shape(
    x: NDArray[np.float64], y: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions and depths broadcast against each other. ValueError if their shapes do not fit."""
    try:
        x, y = np.broadcast_arrays(x, y)
    except ValueError:
        raise ValueError(
            f"x of shape {x.shape} and y of shape {y.shape} do not fit: give a depth for each "
            "position, or one for all"
        ) from None
    return x, y


def refuse_masked(name: str, values: Any) -> None:
    """Raises ValueError for an array with masked entries: NumPy's conversion drops the mask."""
    if np.ma.is_masked(values):
        raise ValueError(
            f"{name} has masked entries: fill them, with nan where a value is missing, "
            "or leave them out"
        )


def _array(values: Any) -> NDArray[Any]:
    try:
        return np.asarray(values)
    except ValueError:  # rows of unequal length
        return np.asarray(None)


def of_arrays(name: str, function: Callable[..., Any], *arrays: Any) -> Any:
    """The result of a user's function. ValueError, with the remedy, if it fails on arrays."""
    try:
        return function(*arrays)
    except Exception as problem:  # whatever a user's function may raise
        count = "an array" if len(arrays) == 1 else f"{len(arrays)} arrays"
        remedy = f"make it a function of {count} by NumPy's functions, or by np.vectorize"
        raise ValueError(
            f"{name} fails when called with {count} ({problem}): {remedy}"
        ) from problem


def real_values(
    name: str, function: Callable[..., Any], x: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The result of a user's function of an array, as floats of x's shape.

    ValueError unless it returns real numbers of that shape, or one.
    """
    returned = of_arrays(name, function, x)
    if type(returned) is np.ndarray and returned.dtype == x.dtype and returned.shape == x.shape:
        return returned
    values = _array(returned)
    if values.dtype.kind == "c":
        one = complex(values.flat[np.argmax(np.abs(values.imag))]) if values.size else 0j
        raise ValueError(
            f"{name} returned complex numbers, like {one:.6g}: it must be real; "
            "return the real part if that is what is meant"
        )
    if values.dtype.kind not in "fiu" or values.shape not in (x.shape, ()):
        kind = "one value" if values.shape == () else f"an array of shape {values.shape}"
        raise ValueError(
            f"{name} returned {kind} of type {values.dtype} for floats of shape {x.shape}: "
            "make it a function of an array of any shape, by NumPy's functions or by np.vectorize"
        )
    return np.broadcast_to(values.astype(float, copy=False), x.shape)


# -- words -----------------------------------------------------------------------------------------


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


def abridged(items: Collection[Any]) -> str:
    """The items as in a list, the first and the last alone where the whole is long.

    >>> abridged([1.0, 2.0]), abridged(range(1000))
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
