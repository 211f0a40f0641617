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

_ARGUMENTS = {
    1: (
        *("sin", "cos", "tan", "arcsin", "arccos", "arctan", "sinh", "cosh", "tanh", "arcsinh", "arccosh", "arctanh"),
        *("exp", "expm1", "log", "log1p", "sqrt", "cbrt", "abs", "sign"),
    ),
    2: ("arctan2", "hypot", "minimum", "maximum", "heaviside"),
    3: ("where",),
}
_ARITY = {name: n for n, names in _ARGUMENTS.items() for name in names}
NAMES: dict[str, Any] = {name: getattr(np, name) for name in _ARITY} | {"pi": np.pi, "e": np.e}
_ALLOWED = (
    ast.Expression, ast.BinOp, ast.UnaryOp, ast.Compare, ast.Call, ast.Name, ast.Load, ast.Constant, ast.operator, ast.unaryop, ast.cmpop,
)  # fmt: skip


class _Floats(ast.NodeTransformer):
    """Integers become floats: 9**9**9 is then infinite at once, not an endless computation."""

    def visit_Constant(self, node: ast.Constant) -> ast.Constant:
        return ast.copy_location(ast.Constant(float(node.value)), node)  # type: ignore[arg-type]


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
            for node in ast.walk(tree):
                self._refuse(node)
            return compile(_Floats().visit(tree), "<expression>", "eval")
        except (SyntaxError, RecursionError, MemoryError, OverflowError) as problem:
            raise ValueError(f"expression {_shortened(self.text)} is not a formula ({problem}): write it like 0.1*sinh(x/2)") from None

    def _refuse(self, node: ast.AST) -> None:
        text = _shortened(self.text)
        if not isinstance(node, _ALLOWED) or (isinstance(node, ast.Constant) and type(node.value) not in (int, float)):
            raise ValueError(f"expression {text} contains {ast.unparse(node)!r}: only arithmetic, x and {', '.join(NAMES)} are allowed")
        if isinstance(node, ast.Name) and node.id != "x" and node.id not in NAMES:
            raise ValueError(f"expression {text} uses {node.id!r}: only x and {', '.join(NAMES)} are known")
        if isinstance(node, ast.Call):
            name = node.func.id if isinstance(node.func, ast.Name) else ast.unparse(node.func)
            if _ARITY.get(name) != len(node.args) or node.keywords:
                raise ValueError(f"expression {text} calls {name} with {len(node.args)} arguments: it takes {_ARITY.get(name, 'none')}")

    def __call__(self, x: Array) -> Array:
        try:
            with np.errstate(all="ignore"):  # what is not finite is refused by who asked, with the place
                value: Any = eval(self._code, {"__builtins__": {}}, {**NAMES, "x": x})  # the syntax tree was checked node by node
        except (ArithmeticError, TypeError, RecursionError) as problem:
            raise ValueError(f"expression {_shortened(self.text)} cannot be evaluated: {problem}") from None
        return np.broadcast_to(np.asarray(value, dtype=float), np.shape(x))

    def __getstate__(self) -> dict[str, str]:
        return {"text": self.text}


def _shortened(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "...")
