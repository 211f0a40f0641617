"""Quantities of a contact as functions that JAX and PyTorch differentiate, once.

A solution is not written in their operations: a contact is solved as always, and the rule for its
derivative is the exact one of `Solution.derivative`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import attrgetter
from typing import Any

import numpy as np

from sie.problem.scene import Scene
from sie.solution import solve

from .derivative import peaks
from .gradient import by_name, known_quantity

Make = Callable[..., Scene]
READ: dict[str, Callable[[Any], float]] = {
    "left_edge": lambda solution: solution.edges[0],
    "right_edge": lambda solution: solution.edges[1],
    "peak_pressure": lambda solution: float(solution.pressure(peaks(solution)[0])),
    "peak_tension": lambda solution: float(solution.peak_tension().value),
    "elastic_limit": lambda solution: float(solution.elastic_limit().load),
}


def _answers(make: Make, names: Sequence[str], quantity: str, numbers: Any) -> tuple[Any, ...]:
    """A quantity of make(*numbers), and its derivatives by the numbers, which have these names."""
    if len(names) != len(numbers):
        raise ValueError(f"{len(numbers)} numbers for names = {names!r}: give one for each name")
    plain = (np.asarray(v, dtype=float) for v in numbers)
    solution = solve(make(*(v if v.ndim else float(v) for v in plain)))
    read = READ.get(quantity, attrgetter(quantity))
    return read(solution), *(by_name(solution, quantity, name) for name in names)


def jax_function(make: Make, names: Sequence[str], quantity: str) -> Callable[..., Any]:
    """A quantity of a contact as a function of numbers, for `jax.grad`, `jax.jvp`, `jit`, `vmap`.

    Parameters
    ----------
    make : callable
        The `Scene` of the numbers, floats or arrays.
    names : sequence of str
        What each number is, by the names of `Solution.derivative`; "profile.heights" for the array
        of the heights of a trace.
    quantity : str
        As of `Solution.gradient`.

    Returns
    -------
    callable
        A function of as many numbers as there are names. Give JAX 64 bits (`jax_enable_x64`).

    Raises
    ------
    ValueError
        For another quantity. The function raises what `solve` and `derivative` raise.
    """
    import jax  # noqa: PLC0415 -- an extra

    known_quantity(quantity)

    def both(*numbers: Any) -> Any:
        one = jax.numpy.result_type(float)
        shapes = [jax.ShapeDtypeStruct(v.shape, one) for v in (np.empty(()), *numbers)]

        def host(*values: Any) -> Any:
            return tuple(np.asarray(v, one) for v in _answers(make, names, quantity, values))

        return jax.pure_callback(host, tuple(shapes), *numbers, vmap_method="sequential")

    def value(*numbers: Any) -> Any:
        return both(*map(jax.numpy.asarray, numbers))[0]

    def rule(numbers: Any, changes: Any) -> Any:
        found, *slopes = both(*map(jax.numpy.asarray, numbers))
        return found, sum((g * d).sum() for g, d in zip(slopes, changes, strict=True))

    function = jax.custom_jvp(value)
    function.defjvp(rule)
    return function


def torch_function(make: Make, names: Sequence[str], quantity: str) -> Callable[..., Any]:
    """The same as a function of PyTorch's tensors, for `backward()`; parameters as there."""
    import torch  # noqa: PLC0415 -- an extra

    known_quantity(quantity)

    class Quantity(torch.autograd.Function):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, *numbers: Any) -> Any:
            values = [v.detach().cpu().numpy() for v in numbers]
            found, *slopes = _answers(make, names, quantity, values)
            ctx.save_for_backward(*(v.new_tensor(g) for v, g in zip(numbers, slopes)))
            return numbers[0].new_tensor(found)

        @staticmethod
        def backward(ctx: Any, change: Any) -> Any:
            return tuple(change * g for g in ctx.saved_tensors)

    return Quantity.apply
