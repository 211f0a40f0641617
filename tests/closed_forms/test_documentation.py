"""The docstrings of the closed forms say what goes in, what comes out, what is refused, and by
whom.
"""

import inspect
import re
from itertools import pairwise

import pytest

import analytic

PUBLIC = {
    f"{module}.{name}": function
    for module in analytic.__all__
    for name, function in vars(getattr(analytic, module)).items()
    if inspect.isfunction(function)
    and function.__module__ == f"analytic.{module}"
    and not name.startswith("_")
}


@pytest.mark.parametrize("name", PUBLIC)
def test_a_docstring_names_every_parameter_with_its_meaning(name):
    text = inspect.getdoc(PUBLIC[name])
    described = re.findall(r"^(\w+) : .+\n    [A-Z]", text, flags=re.MULTILINE)
    assert described == list(inspect.signature(PUBLIC[name]).parameters)


@pytest.mark.parametrize("name", PUBLIC)
def test_a_docstring_has_the_sections_of_numpydoc_in_their_order(name):
    lines = inspect.getdoc(PUBLIC[name]).splitlines()
    sections = [word for word, rule in pairwise(lines) if rule and not rule.strip("-")]
    assert [word for word in sections if word != "Notes"] == [
        "Parameters",
        "Returns",
        "Raises",
        "References",
        "Examples",
    ]
