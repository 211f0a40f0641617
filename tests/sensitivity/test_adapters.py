"""Functions for JAX and PyTorch have the values and the derivatives of the solution."""

import numpy as np
import pytest

import sie
from sie.sensitivity.adapters import _answers

NAMES = ("normal_load", "profile.radius")
X = np.linspace(-1.6, 1.6, 21)


def punch(P, R):
    return sie.Scene(profile=sie.RoundedFlat(1.0, R), modulus=1.0, normal_load=P, poisson=0.3)


def trace(heights):
    return sie.Scene(profile=sie.Sampled(X, heights), modulus=1.0, normal_load=0.4)


@pytest.mark.parametrize(
    "quantity", ["half_width", "right_edge", "peak_pressure", "peak_tension", "elastic_limit"]
)
def test_the_rule_has_the_derivatives_of_the_value_that_it_reads(quantity):
    found, *slopes = _answers(punch, NAMES, quantity, (1.0, 1.2))
    ends = [_answers(punch, NAMES, quantity, (1.0 + h, 1.2))[0] for h in (-1e-5, 1e-5)]
    assert slopes[0] == pytest.approx((ends[1] - ends[0]) / 2e-5, rel=1e-7)
    assert found == pytest.approx(0.5 * sum(ends), rel=1e-8)
    assert slopes[1] == sie.solve(punch(1.0, 1.2)).gradient(quantity)["profile.radius"]


def test_jax_differentiates_maps_and_compiles():
    jax = pytest.importorskip("jax", reason='needs the extra "jax"')
    jax.config.update("jax_enable_x64", True)
    width = sie.adapters.jax_function(punch, NAMES, "half_width")
    exact = sie.solve(punch(1.0, 1.0)).gradient("half_width")
    assert width(1.0, 1.0) == sie.solve(punch(1.0, 1.0)).half_width
    assert jax.grad(width, (0, 1))(1.0, 1.0) == pytest.approx([exact[name] for name in NAMES])
    squared = jax.jit(jax.vmap(jax.grad(lambda P: width(P, 1.0) ** 2)))(jax.numpy.array([1.0, 2.0]))
    assert squared[0] == pytest.approx(2.0 * width(1.0, 1.0) * exact["normal_load"])
    peak = sie.adapters.jax_function(trace, ("profile.heights",), "peak_pressure")
    by_heights = sie.solve(trace(X**2)).gradient("peak_pressure")["profile.heights"]
    assert jax.grad(peak)(X**2) == pytest.approx(by_heights)


def test_pytorch_goes_backward():
    torch = pytest.importorskip("torch", reason='needs the extra "torch"')
    width = sie.adapters.torch_function(punch, NAMES, "half_width")
    numbers = [torch.tensor(1.0, dtype=torch.float64, requires_grad=True) for _ in NAMES]
    (width(*numbers) ** 2).backward()
    exact = sie.solve(punch(1.0, 1.0)).derivative("profile.radius").half_width
    found = float(width(*numbers).detach())
    assert float(numbers[1].grad) == pytest.approx(2.0 * found * exact)


def test_numbers_without_a_name_and_unknown_quantities_are_refused():
    with pytest.raises(ValueError, match="one for each"):
        _answers(punch, NAMES, "half_width", (1.0,))
    for adapter in ("jax", "torch"):
        pytest.importorskip(adapter)
        with pytest.raises(ValueError, match="has no gradient"):
            getattr(sie.adapters, f"{adapter}_function")(punch, NAMES, "width")
