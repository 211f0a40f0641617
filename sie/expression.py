"""A formula in x as text, like "0.1*sinh(x/2)": a value (equal, hashable, picklable) that a scene file can hold.

Python's own parser reads it; only arithmetic, comparisons, the names below and x are let through, so a file cannot run code.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from functools import cached_property
from types import CodeType
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_FUNCTIONS = (
    *("sin", "cos", "tan", "arcsin", "arccos", "arctan", "arctan2", "sinh", "cosh", "tanh", "arcsinh", "arccosh", "arctanh"),
    *("exp", "expm1", "log", "log1p", "sqrt", "cbrt", "hypot", "abs", "sign", "minimum", "maximum", "where", "heaviside"),
)
NAMES: dict[str, Any] = {name: getattr(np, name) for name in _FUNCTIONS} | {"pi": np.pi, "e": np.e}
_ALLOWED = (
    ast.Expression, ast.BinOp, ast.UnaryOp, ast.Compare, ast.Call, ast.Name, ast.Load, ast.Constant, ast.operator, ast.unaryop, ast.cmpop,
)  # fmt: skip


@dataclass(frozen=True)
class Expression:
    """x -> the formula's value, elementwise.

    >>> Expression("x**2 + 1")(np.array([0.0, 2.0]))
    array([1., 5.])
    """

    text: str

    def __post_init__(self) -> None:
        _ = self._code

    @cached_property
    def _code(self) -> CodeType:
        try:
            tree = ast.parse(self.text.strip(), mode="eval")
        except (SyntaxError, ValueError) as problem:
            raise ValueError(f"expression {self.text!r} is not a formula ({problem}): write it like 0.1*sinh(x/2)") from None
        for node in ast.walk(tree):
            if not isinstance(node, _ALLOWED) or (isinstance(node, ast.Constant) and not isinstance(node.value, (int, float))):
                raise ValueError(
                    f"expression {self.text!r} contains {ast.unparse(node)!r}: only arithmetic, x and {', '.join(NAMES)} are allowed"
                )
            if isinstance(node, ast.Name) and node.id != "x" and node.id not in NAMES:
                raise ValueError(f"expression {self.text!r} uses {node.id!r}: only x and {', '.join(NAMES)} are known")
        return compile(tree, "<expression>", "eval")

    def __call__(self, x: Array) -> Array:
        with np.errstate(all="ignore"):  # what is not finite is refused by who asked, with the place
            value: Any = eval(self._code, {"__builtins__": {}}, {**NAMES, "x": x})  # the syntax tree was checked node by node
        return np.broadcast_to(np.asarray(value, dtype=float), np.shape(x))

    def __getstate__(self) -> dict[str, str]:
        return {"text": self.text}
