"""A formula in x as text, like "0.1*sinh(x/2)": a value that a scene file can hold.

Python's own parser reads it. Only x and the operators and names below are accepted, so that a file
cannot run code; numbers are doubles, and NumPy's functions carry it out.
"""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from sie.arguments import nearest, shortened

Array = NDArray[np.float64]

_ARGUMENTS = {
    1: "sin cos tan arcsin arccos arctan sinh cosh tanh arcsinh arccosh arctanh "
    "exp expm1 log log1p sqrt cbrt abs sign",
    2: "arctan2 hypot minimum maximum heaviside",
    3: "where",
}
_ARITY = {name: n for n, names in _ARGUMENTS.items() for name in names.split()}
_CONSTANTS = {"pi": np.float64(np.pi), "e": np.float64(np.e)}
NAMES = (*_ARITY, *_CONSTANTS)
_NODES = (
    ast.Expression, ast.BinOp, ast.UnaryOp, ast.Load, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow,
    ast.Mod, ast.FloorDiv, ast.USub, ast.UAdd,
)  # fmt: skip
_COMPARISONS = ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq
_ALLOWED = "+ - * / ** % //, comparisons, brackets, numbers, x"

# Spellings of other languages, and their equivalents here.
_MEANT = {
    "^": "**", "²": "**2", "³": "**3", "·": "*", "×": "*", "−": "-", "π": "pi",
    "|": "abs(...)", "&": "where(...)", "if": "where(...)", "ln": "log", "pow": "**",
    "min": "minimum", "max": "maximum", "fabs": "abs", "sgn": "sign",
}  # fmt: skip
# Signs, and keywords: after a digit Python's parser would warn of these before it raises.
_STRANGE = re.compile(
    r"[^A-Za-z0-9_.,()<>=!+\-*/%\s]"
    r"|(?<![A-Za-z_])(?:and|or|not|in|is|if|else|for|lambda|await|yield|from)(?![A-Za-z_0-9])"
)
LONGEST = 10_000  # characters; a program that writes a longer formula can pass a function


@dataclass(frozen=True)
class Expression:
    """The formula as a function of an array x; a comparison is 1 if it holds and 0 if not.

    >>> Expression("x**2 + 1")(np.array([0.0, 2.0]))
    array([1., 5.])
    """

    text: str

    def __post_init__(self) -> None:
        _ = self._function

    @cached_property
    def _function(self) -> Callable[[Array], Any]:
        text = self.text.strip()
        stray = _STRANGE.search(text)
        if len(text) > LONGEST:
            self._refuse(f"has {len(text)} characters: give a Python function")
        if stray:
            self._refuse(f"contains {stray[0]!r}: {_advice(stray[0])}")
        made = _Arithmetic(self._refuse)
        try:
            tree = ast.fix_missing_locations(made.visit(ast.parse(text, mode="eval")))
            code = compile(tree, "<formula>", "eval")
        except SyntaxError:
            self._refuse("is not a formula: write it like 0.1*sinh(x/2)")
        except (RecursionError, MemoryError):
            self._refuse("is nested too deep: use fewer terms, or give a Python function")
        names = {"__builtins__": {}, **made.numbers, **_CONSTANTS}
        names |= {name: getattr(np, name) for name in _ARITY}
        return lambda x: eval(code, names, {"x": x})

    def _refuse(self, problem: str) -> NoReturn:
        raise ValueError(f"expression {shortened(self.text)!r} {problem}")

    def __call__(self, x: Array) -> Array:
        """The values of the expression at x, of the shape of x."""
        # The caller refuses values that are not finite, and names the place.
        with np.errstate(all="ignore"):
            return np.broadcast_to(np.asarray(self._function(x), dtype=float), np.shape(x))

    def __getstate__(self) -> dict[str, str]:
        return {"text": self.text}


class _Arithmetic(ast.NodeTransformer):
    """A tree of what is accepted alone, its numbers replaced by names of doubles."""

    def __init__(self, refuse: Callable[[str], NoReturn]) -> None:
        self.refuse = refuse
        self.numbers: dict[str, np.float64] = {}

    def generic_visit(self, node: ast.AST) -> ast.AST:
        if not isinstance(node, _NODES):
            self.refuse(f"contains {shortened(ast.unparse(node))!r}: {_advice('')}")
        return super().generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        value = node.value
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return self.generic_visit(node)
        name = f"_{len(self.numbers)}"
        self.numbers[name] = np.float64(value if abs(value) < 1e308 else np.inf)
        return ast.Name(name, ast.Load())

    def visit_Name(self, node: ast.Name) -> ast.AST:
        if node.id in _ARITY:
            written = f"{node.id}({', '.join('x' * _ARITY[node.id])})"
            self.refuse(f"has the function {node.id} without arguments: write {written}")
        if node.id != "x" and node.id not in _CONSTANTS:
            self.refuse(f"uses {node.id!r}: {_advice(node.id)}")
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name in ("", "x", *_CONSTANTS):
            self.refuse(f"calls {name or 'a value'} like a function: write * for a product")
        if name not in _ARITY:
            self.refuse(f"uses {name!r}: {_advice(name)}")
        given = len(node.args) + len(node.keywords)
        if given != _ARITY[name] or node.keywords:
            takes = f"it takes {_ARITY[name]}, without names"
            self.refuse(f"calls {name} with {given} arguments: {takes}")
        return ast.Call(node.func, [self.visit(argument) for argument in node.args], [])

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        """The product of 1 or 0 for each pair of neighbours."""
        if not all(isinstance(op, _COMPARISONS) for op in node.ops):
            return self.generic_visit(node)
        values = [self.visit(value) for value in (node.left, *node.comparators)]
        one, zero = (self.visit(ast.Constant(value)) for value in (1.0, 0.0))
        holds = one
        for op, (left, right) in zip(node.ops, pairwise(values), strict=True):
            pair = ast.Compare(left, [op], [right])
            number = ast.Call(ast.Name("where", ast.Load()), [pair, one, zero], [])
            holds = ast.BinOp(holds, ast.Mult(), number)
        return holds


def _advice(name: str) -> str:
    """The text to write in place of a name or sign that is not known."""
    meant = _MEANT.get(name) or (
        nearest(name, NAMES) if name.isidentifier() and not keyword.iskeyword(name) else ""
    )
    return f"did you mean {meant}?" if meant else f"a formula has {_ALLOWED} and {', '.join(NAMES)}"
