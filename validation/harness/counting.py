"""The work of a program, counted: the same number on any machine, busy or idle.

Claims of cost are decided by these counts. Seconds are reported beside them.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

CALL = 50  # elements: a call takes about as long as so many logarithms


class Work(NamedTuple):
    """Calls of Python functions, and elements that went through NumPy's named functions.

    `np.log(x)` counts as many elements as it takes or returns, whichever is more; `x * y`, sums,
    matrix products and transforms count none.
    """

    calls: int
    elements: int

    @property
    def steps(self) -> int:
        """Both in one number, in elements."""
        return CALL * self.calls + self.elements


class _Counted:
    """A function of NumPy that adds up its elements; its methods, such as `reduce`, count none."""

    def __init__(self, function: Any, total: list[int]) -> None:
        self._function, self._total = function, total

    def __call__(self, *given: Any, **named: Any) -> Any:
        result = self._function(*given, **named)
        arrays = (*given[: self._function.nin], result)
        self._total[0] += max(getattr(array, "size", 1) for array in arrays)
        return result

    def __getattr__(self, name: str) -> Any:
        return getattr(self._function, name)


def work(run: Callable[[], Any]) -> Work:
    """The work of a call; what an earlier one has cached is not in it."""
    calls, elements = [0], [0]

    def event(frame: Any, kind: str, argument: Any) -> None:
        # the wrappers above are no work of the program
        calls[0] += kind == "call" and frame.f_code.co_filename != __file__

    functions = {k: _Counted(f, elements) for k, f in vars(np).items() if isinstance(f, np.ufunc)}
    before = sys.getprofile()
    with patch.dict(vars(np), functions):
        sys.setprofile(event)
        try:
            run()
        finally:
            sys.setprofile(before)
    return Work(calls[0], elements[0])
