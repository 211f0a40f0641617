"""A formula given as text is arithmetic, evaluated or refused with work bounded by its length."""

import numpy as np
import pytest

import sie
from sie.profiles.expression import NAMES, Expression

X = np.array([-2.0, 0.5, 3.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("hypot(sin, x)", "the function sin without arguments: write sin(x)"),
        ("x + cos", "the function cos without arguments"),
        ("x @ x", "contains '@'"),
        ("x in x", "contains 'in'"),
        ("x is x", "contains 'is'"),
        ("x & 1", "did you mean where(...)?"),
        ("~x", "contains '~'"),
        ("x^3", "contains '^': did you mean **?"),
        ("ln(x)", "uses 'ln': did you mean log?"),
        ("2*sinn(x)", "did you mean sin?"),
        ("x(1 + x)", "calls x like a function: write * for a product"),
        ("2(x)", "write * for a product"),
        ("maximum(x)", "calls maximum with 1 arguments: it takes 2"),
        ("sin(x=1)", "it takes 1, without names"),
        ("1j*x", "contains '1j'"),
        ("True", "contains 'True'"),
        ("x.real", "contains 'x.real'"),
        ("", "is not a formula"),
        ("x +* 2", "is not a formula"),
        ("x; x", "contains ';'"),
        ("y + x", "uses 'y'"),
        # nor code
        ("__import__('os')", "contains"),
        ("[x]", "contains '['"),
        ("lambda: x", "contains"),
        ("x if x else 1", "contains 'if'"),
    ],
)
def test_text_that_is_no_formula_is_refused_with_a_suggestion(text, said):
    with pytest.raises(ValueError) as caught:
        Expression(text)
    assert str(caught.value).startswith(f"expression {text!r} ")
    assert said in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "x" + "+x" * 20_000,
        "-" * 9000 + "x",
        "x**" * 3000 + "x",
        "(" * 300 + "x" + ")" * 300,
        "x*" + "7" * 5000,
    ],
)
def test_a_formula_too_long_or_too_deep_is_refused_in_a_short_sentence(text):
    with pytest.raises(ValueError, match="expression") as caught:
        Expression(text)
    assert len(str(caught.value)) < 200
    assert "recursion" not in str(caught.value)


@pytest.mark.parametrize("text", ["9**9**9*x", "1e999*x"])
def test_a_tower_of_powers_is_infinite_at_once(text):
    assert np.isinf(Expression(text)(X)).all()


def test_a_root_of_a_negative_number_is_refused():
    with pytest.raises(ValueError, match="slope is nan at x"):
        sie.FromFunction("(-8)**(1/3)*x")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("x**2 - 3*x/4 + +1", X**2 - 0.75 * X + 1.0),
        ("2**3**2 - -x", 512.0 + X),
        ("x % 0.75 + x // 2", X % 0.75 + X // 2),
        ("(x > 0)*x - (0 < x <= 0.5)", np.where(X > 0.0, X, 0.0) - (X == 0.5)),
        ("where(x != 3, pi, e)", np.where(X != 3.0, np.pi, np.e)),
        ("hypot(x, arctan2(1, x)) + abs(-x)", np.hypot(X, np.arctan2(1.0, X)) + np.abs(X)),
        ("7", np.full(3, 7.0)),
    ],
)
def test_operators_bind_and_compare_as_in_python(text, value):
    assert Expression(text)(X) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize("name", NAMES)
def test_every_name_that_a_refusal_lists_may_be_used(name):
    texts = [f"{name}({', '.join(['x'] * n)})" for n in (1, 2, 3)] + [name]
    accepted = []
    for text in texts:
        try:
            accepted.append(Expression(text)(np.array([0.5, 0.25])))
        except ValueError:
            continue
    assert len(accepted) == 1
    assert accepted[0].shape == (2,)
