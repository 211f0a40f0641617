"""The docstrings of the closed forms, completed by what their signatures and parameters say.

A function states in its docstring what it returns and by which formula, with an example. What each
parameter is stands once, in `parameters.MEANING`. `documented` puts both together as numpydoc's
sections, so that help() says everything and no meaning is written twice.
"""

import inspect
import re
import textwrap
from collections.abc import Callable
from typing import TypeVar

from analytic._core.parameters import MEANING

Function = TypeVar("Function", bound=Callable[..., object])

BARBER = "J. R. Barber, Contact Mechanics (2018)"
CIAVARELLA = (
    "M. Ciavarella, D. A. Hills and G. Monno, The influence of rounded edges on indentation by a "
    "flat punch (1998)"
)
GLADWELL = "G. M. L. Gladwell, Contact Problems in the Classical Theory of Elasticity (1980)"
HILLS = "D. A. Hills, D. Nowell and A. Sackfield, Mechanics of Elastic Contacts (1993)"
JOHNSON = "K. L. Johnson, Contact Mechanics (1985)"
MUSKHELISHVILI = (
    "N. I. Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity (1953)"
)
TADA = "H. Tada, P. C. Paris and G. R. Irwin, The Stress Analysis of Cracks Handbook (2000)"
WESTERGAARD = "H. M. Westergaard, Bearing pressures and cracks (1939)"

WIDTH = 96
NUMBER = "float, array or mpmath number"
# Parameters that are no numbers of the problem: type and meaning.
OTHERS = {
    "side": ("{1, -1}", "on a cut, the limit from the body y > 0 (1) or from its image y < 0 (-1)"),
    "lib": (
        "module or mpmath context",
        "NumPy, with arrays that broadcast, or a context such as `mpmath.mp`, with single numbers",
    ),
    "count": ("int", "the number of coefficients, >= 0"),
    "coefficients": ("sequence of numbers", "the b_n, stresses"),
    "stress": ("Stresses", "the components of the stress"),
}
REFUSED = "For a parameter that is not a finite real number, or out of the range given above."
REFUSAL = re.compile(r"\s*ValueError ([^.]*)\.")


def documented(returns: str, *sources: str) -> Callable[[Function], Function]:
    """A decorator that completes a docstring by Parameters, Returns, Raises, Notes and References.

    The first paragraph of the docstring stays the summary, the others become the notes; sentences
    that begin with ValueError go to Raises, and what follows the first >>> to Examples.
    """

    def complete(function: Function) -> Function:
        if function.__doc__ is not None:  # python -OO removes docstrings
            function.__doc__ = _numpydoc(
                function, inspect.cleandoc(function.__doc__), returns, sources
            )
        return function

    return complete


def _numpydoc(
    function: Callable[..., object], text: str, returns: str, sources: tuple[str, ...]
) -> str:
    text, mark, example = text.partition(">>>")
    refusals = [_sentence(words) for words in REFUSAL.findall(text)]
    summary, _, notes = REFUSAL.sub("", text).strip().partition("\n\n")
    signature = inspect.signature(function)
    sections = {
        "Parameters": "\n".join(map(_parameter, signature.parameters.values())),
        "Returns": f"{_kind(signature.return_annotation)}\n    {_sentence(returns)}",
        "Raises": "\n    ".join(["ValueError", REFUSED, *refusals]),
        "Notes": notes.strip(),
        "References": "\n\n".join(textwrap.fill(f"{source}.", WIDTH) for source in sources),
        "Examples": mark + example,
    }
    return "\n\n".join(
        [summary]
        + [f"{name}\n{'-' * len(name)}\n{body}" for name, body in sections.items() if body.strip()]
    )


def _parameter(parameter: inspect.Parameter) -> str:
    kind, meaning = OTHERS.get(parameter.name, (NUMBER, MEANING.get(parameter.name, "")))
    optional = "" if parameter.default is inspect.Parameter.empty else ", optional"
    return f"{parameter.name} : {kind}{optional}\n    {_sentence(meaning)}"


def _kind(annotation: object) -> str:
    """The type that is returned: a number, several, or a record of them."""
    if getattr(annotation, "__origin__", None) is tuple:
        return f"tuple of {NUMBER}"
    return annotation.__name__ if isinstance(annotation, type) else NUMBER


def _sentence(words: str) -> str:
    """A sentence, indented below the first of its lines."""
    return textwrap.fill(f"{words[:1].upper()}{words[1:]}.", WIDTH, subsequent_indent="    ")
