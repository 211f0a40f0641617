"""Formulas that hold on a part of the line only, confined to that part."""

from collections.abc import Callable

import numpy as np

from analytic._core.numbers import Library, Number


def pick(
    lib: Library,
    where: Number,
    yes: Callable[..., Number],
    no: Callable[..., Number],
    *args: Number,
) -> Number:
    """`yes(lib, *args)` where the condition holds, `no(lib, *args)` elsewhere.

    Each formula is evaluated only at the points of its own domain, so that no nan or overflow
    arises. The condition and the arguments, numbers or named tuples of numbers, broadcast.
    """
    if lib is not np:
        return yes(lib, *args) if where else no(lib, *args)
    where = _broadcast(where, args)
    count = np.count_nonzero(where)
    if count == np.size(where):
        return yes(lib, *args)
    if count == 0:
        return no(lib, *args)
    here, there = np.flatnonzero(where), np.flatnonzero(~where)
    first = yes(lib, *(_at(here, where.shape, arg) for arg in args))
    second = no(lib, *(_at(there, where.shape, arg) for arg in args))
    result = np.empty(where.size, np.result_type(first, second))
    result[here], result[there] = first, second
    return result.reshape(where.shape)


def together(
    lib: Library, function: Callable[..., Number], *calls: tuple[Number, ...]
) -> tuple[Number, ...]:
    """`function(lib, *call)` for each call, arrays in one pass, which costs less than several."""
    if lib is not np:
        return tuple(function(lib, *call) for call in calls)
    return tuple(function(lib, *(np.array(args) for args in zip(*calls, strict=True))))


def nothing(lib: Library, x: Number, *_: Number) -> Number:
    """0, of the type and shape of the first argument."""
    return 0 * x


def infinite(lib: Library, *_: Number) -> Number:
    """+inf."""
    return lib.inf


def _broadcast(where: Number, args: tuple[Number, ...]) -> Number:
    shape, others = np.shape(where), _shapes(args)
    return (
        where
        if others <= {(), shape}
        else np.broadcast_to(where, np.broadcast_shapes(shape, *others))
    )


def _shapes(args: tuple[Number, ...]) -> set[tuple[int, ...]]:
    shapes: set[tuple[int, ...]] = set()
    for arg in args:
        shapes |= _shapes(arg) if isinstance(arg, tuple) else {np.shape(arg)}
    return shapes


def _at(indices: Number, shape: tuple[int, ...], arg: Number) -> Number:
    if isinstance(arg, tuple):
        return type(arg)(*(_at(indices, shape, leaf) for leaf in arg))
    if np.ndim(arg) == 0:
        return arg
    return (arg if arg.shape == shape else np.broadcast_to(arg, shape)).reshape(-1).take(indices)
