"""The docstrings of the closed forms say what goes in, what comes out, what is refused, and by
whom.
"""

import inspect
import re
from itertools import pairwise

import analytic

PUBLIC = {
    f"{module}.{name}": function
    for module in analytic.__all__
    for name, function in vars(getattr(analytic, module)).items()
    if inspect.isfunction(function)
    and function.__module__ == f"analytic.{module}"
    and not name.startswith("_")
}


def test_a_docstring_names_every_parameter_with_its_meaning():
    for name, function in PUBLIC.items():
        described = re.findall(r"^(\w+) : .+\n    [A-Z]", inspect.getdoc(function), re.MULTILINE)
        assert described == list(inspect.signature(function).parameters), name


def test_a_docstring_has_the_sections_of_numpydoc_in_their_order():
    for name, function in PUBLIC.items():
        lines = inspect.getdoc(function).splitlines()
        sections = [word for word, rule in pairwise(lines) if rule and not rule.strip("-")]
        expected = ["Parameters", "Returns", "Raises", "References", "Examples"]
        assert [word for word in sections if word != "Notes"] == expected, name
