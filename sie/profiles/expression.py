"""A formula in x as text, like "0.1*sinh(x/2)": a value that a scene file can hold.

Python's own parser reads it. Only x and the operators and names below are accepted. Each becomes
one step of a program in postfix order, which NumPy's functions carry out. So a file cannot run
code, and nesting cannot exhaust the stack.
"""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import Any, NamedTuple

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
_CONSTANTS = {"pi": np.pi, "e": np.e}
NAMES = (*_ARITY, *_CONSTANTS)
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide,
    ast.Pow: np.power,
    ast.Mod: np.mod, ast.FloorDiv: np.floor_divide, ast.USub: np.negative, ast.UAdd: np.positive,
    ast.Lt: np.less, ast.LtE: np.less_equal, ast.Gt: np.greater, ast.GtE: np.greater_equal,
    ast.Eq: np.equal, ast.NotEq: np.not_equal,
}  # fmt: skip
_ALLOWED = "+ - * / ** % //, comparisons, brackets, numbers, x"

# Spellings of other languages, and their equivalents here.
_MEANT = {
    "^": "**", "²": "**2", "³": "**3", "·": "*", "×": "*", "−": "-", "π": "pi",
    "|": "abs(...)", "&": "where(...)",
    "ln": "log", "asin": "arcsin", "acos": "arccos", "atan": "arctan", "asinh": "arcsinh",
    "acosh": "arccosh", "atanh": "arctanh", "atan2": "arctan2", "sgn": "sign", "min": "minimum",
    "max": "maximum", "pow": "**", "fabs": "abs", "if": "where(...)",
}  # fmt: skip
_STRANGE = re.compile(r"[^A-Za-z0-9_.,()<>=!+\-*/%\s]")
# Also right after a digit, where Python's parser would warn before it raises
_KEYWORD = re.compile(
    r"(?<![A-Za-z_])(?:and|or|not|in|is|if|else|for|lambda|await|yield|from)(?![A-Za-z_0-9])"
)
LONGEST = 10_000  # characters; a program that writes a longer formula can pass a function
DEEPEST = 500  # levels of the syntax tree: Python's own limit depends on where it is called from
# No double needs more digits, and Python's own message would not name the formula.
LONGEST_NUMBER = re.compile(r"\d{401}")

_SIMPLER = "use fewer terms and brackets, or give a Python function"


class _Step(NamedTuple):
    """Replaces the last `operands` values by function(*values); without a function it adds x."""

    operands: int
    function: Callable[..., Any] | None


@dataclass(frozen=True)
class Expression:
    """The formula as a function of an array x; a comparison is 1 if it holds and 0 if not.

    >>> Expression("x**2 + 1")(np.array([0.0, 2.0]))
    array([1., 5.])
    """

    text: str

    def __post_init__(self) -> None:
        _ = self._program

    @cached_property
    def _program(self) -> tuple[_Step, ...]:
        text = self.text.strip()
        if len(text) > LONGEST or LONGEST_NUMBER.search(text):
            size = (
                f"{len(text)} characters, more than {LONGEST}"
                if len(text) > LONGEST
                else "a number of more than 400 digits"
            )
            raise self._refusal(f"has {size}: shorten it, or give a Python function")
        for pattern in (_STRANGE, _KEYWORD):
            stray = pattern.search(text)
            if stray:
                raise self._refusal(f"contains {stray[0]!r}: {_advice(stray[0])}")
        try:
            tree = ast.parse(text, mode="eval")
        except (RecursionError, MemoryError):
            raise self._refusal(f"is nested more than {DEEPEST} levels deep: {_SIMPLER}") from None
        except (SyntaxError, ValueError) as problem:
            why = problem.msg if isinstance(problem, SyntaxError) else problem
            raise self._refusal(f"is not a formula ({why}): write it like 0.1*sinh(x/2)") from None
        program: list[_Step] = []
        todo: list[tuple[ast.AST, int]] = [(tree.body, 1)]
        while todo:  # the reverse of postfix order: a node, then its operands from the last one
            node, depth = todo.pop()
            if depth > DEEPEST:
                raise self._refusal(f"is nested more than {DEEPEST} levels deep: {_SIMPLER}")
            step, operands = self._step(node)
            program.append(step)
            todo += [(operand, depth + 1) for operand in operands]
        return tuple(reversed(program))

    def _step(self, node: ast.AST) -> tuple[_Step, list[Any]]:
        """The step that a node stands for, and the nodes of its operands."""
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, (int, float))
            and not isinstance(node.value, bool)
        ):
            return _Step(0, partial(np.float64, _float(node.value))), []
        if isinstance(node, ast.Name):
            return self._named(node.id), []
        if isinstance(node, ast.Call):
            return self._called(node), node.args
        if isinstance(node, ast.Compare):
            operators = [_OPERATORS[type(op)] for op in node.ops if type(op) in _OPERATORS]
            if len(operators) == len(node.ops):
                return _Step(len(operators) + 1, partial(_compared, operators)), [
                    node.left,
                    *node.comparators,
                ]
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            return _Step(2, _OPERATORS[type(node.op)]), [node.left, node.right]
        if isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            return _Step(1, _OPERATORS[type(node.op)]), [node.operand]
        raise self._refusal(f"contains {_written(node)}: {_advice('')}")

    def _named(self, name: str) -> _Step:
        if name == "x":
            return _Step(0, None)
        if name in _ARITY:
            raise self._refusal(
                f"has the function {name} without arguments: "
                f"write {name}({', '.join('x' * _ARITY[name])})"
            )
        if name not in _CONSTANTS:
            raise self._refusal(f"uses {name!r}: {_advice(name)}")
        return _Step(0, partial(np.float64, _CONSTANTS[name]))

    def _called(self, node: ast.Call) -> _Step:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name == "x" or name in _CONSTANTS or not name:
            raise self._refusal(
                f"calls {name or 'what is not a name'} like a function: write * for a product"
            )
        if name not in _ARITY:
            raise self._refusal(f"uses {name!r}: {_advice(name)}")
        if len(node.args) != _ARITY[name] or node.keywords:
            given = len(node.args) + len(node.keywords)
            raise self._refusal(
                f"calls {name} with {given} arguments: it takes {_ARITY[name]}, without names"
            )
        return _Step(_ARITY[name], getattr(np, name))

    def _refusal(self, problem: str) -> ValueError:
        return ValueError(f"expression {shortened(self.text)!r} {problem}")

    def __call__(self, x: Array) -> Array:
        """The values of the expression at x, of the shape of x."""
        stack: list[Any] = []
        # The caller refuses values that are not finite, and names the place.
        with np.errstate(all="ignore"):
            for operands, function in self._program:
                first = len(stack) - operands
                stack[first:] = [x if function is None else function(*stack[first:])]
        return np.broadcast_to(np.asarray(stack.pop(), dtype=float), np.shape(x))

    def __getstate__(self) -> dict[str, str]:
        return {"text": self.text}


def _compared(operators: list[Callable[..., Any]], *values: Any) -> Any:
    """1 where every neighbouring pair of values compares so, 0 elsewhere."""
    holds: Any = np.float64(1.0)
    for operator, (left, right) in zip(operators, pairwise(values), strict=True):
        holds = holds * operator(left, right)
    return holds


def _float(number: float) -> float:
    try:
        return float(number)
    except OverflowError:
        return np.inf


def _written(node: ast.AST) -> str:
    try:
        text = ast.unparse(node)
    except RecursionError:
        text = type(node).__name__
    return repr(shortened(text))


def _advice(name: str) -> str:
    """The text to write in place of a name or sign that is not known."""
    meant = _MEANT.get(name) or (
        nearest(name, NAMES) if name.isidentifier() and not keyword.iskeyword(name) else ""
    )
    return f"did you mean {meant}?" if meant else f"a formula has {_ALLOWED} and {', '.join(NAMES)}"
