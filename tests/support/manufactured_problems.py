"""Cauchy equations drawn at random whose solution is known (`oracles.manufactured`)."""

from typing import Any

import numpy as np
from hypothesis import strategies as st
from strategies import between

import sie
from oracles.manufactured import Manufactured, exponents, right_hand_side

PROMISE = 1e-13  # of the peak
KINDS = [(False, False), (True, False), (False, True), (True, True)]


def words(pair: tuple[bool, bool]) -> tuple[str, ...]:
    return tuple("bounded" if bounded else "singular" for bounded in pair)


def number(value: Any) -> complex | float:
    z = complex(value)
    return z if z.imag else z.real


def equation_of(densities: Any, a: Any, b: Any, ends: Any, kernels: Any = ()) -> sie.CauchyEquation:
    """The equation that `densities` solve, the total of each interval of index 1 given."""
    intervals = tuple((d.x1, d.x2) for d in densities)
    is_complex = any(isinstance(v, complex) for v in (a, b))

    def k(x: Any, t: Any) -> Any:
        values = sum(c / (t - x - shift) for c, shift in kernels)
        return values if is_complex else values.real

    wanted, totals = sum(d.kappa for d in densities), []
    for d in densities:
        totals.append(number(d.total) if d.kappa == 1 and wanted > 0 else None)
        wanted -= totals[-1] is not None
    return sie.CauchyEquation(
        intervals, right_hand_side(densities, a, b, kernels), a=a, b=b, k=k if kernels else None,
        ends=[words(e) for e in ends],
        total=tuple(totals) if any(t is not None for t in totals) else None,
    )  # fmt: skip


def inside(d: Manufactured) -> Any:
    return d.x1 + (d.x2 - d.x1) * np.array([0.01, 0.1, 0.33, 0.5, 0.77, 0.93, 0.99])


reals = st.tuples(between(-3.0, 3.0), st.sampled_from([1.0, -1.0, 0.3]))
nearly_real = st.builds(complex, between(0.8, 1.2), between(-0.1, 0.1))
complexes = st.tuples(
    st.builds(complex, between(-0.8, 0.8), between(0.05, 0.6)),
    st.sampled_from([1.0, -1.0]) | nearly_real,
)
constants = reals | complexes


@st.composite
def densities(
    draw: st.DrawFn, a: Any, b: Any, ends: Any, interval: tuple[float, float]
) -> Manufactured:
    """A polynomial of degree up to 5, and a pole half a half-width from the interval."""
    polynomial = (*draw(st.lists(between(-1.0, 1.0), max_size=5)), 1.0)
    poles: tuple[Any, ...] = ()
    if draw(st.booleans()):
        p, r = (
            complex(draw(between(-1.2, 1.2)), draw(between(0.5, 2.0))),
            complex(draw(between(0.1, 1.0)), draw(between(-1.0, 1.0))),
        )
        poles = ((p, r), (p.conjugate(), r.conjugate()))
    alpha, beta = exponents(a, b, ends)
    return Manufactured(*interval, alpha, beta, polynomial, poles)


@st.composite
def problems(draw: st.DrawFn, intervals: int = 1) -> Any:
    """(densities, a, b, ends, kernels), kernels as smooth as those of a thick layer."""
    a, b = draw(constants)
    start, out, ends = draw(between(-2.0, 2.0)), [], []
    for _ in range(intervals):
        end = start + draw(between(0.3, 3.0))
        ends.append(draw(st.sampled_from(KINDS)))
        out.append(draw(densities(a, b, ends[-1], (start, end))))
        start = end + draw(between(0.05, 2.0))
    kernels: tuple[Any, ...] = ()
    height = 2.0 * max(float(d.r) for d in out)
    if draw(st.booleans()):
        c, shift = (
            draw(between(-0.15, 0.15)),
            complex(draw(between(-1.0, 1.0)), height * draw(between(1.0, 2.0))),
        )
        is_complex = isinstance(a, complex) or isinstance(b, complex)
        kernels = ((c, shift),) if is_complex else ((c, shift), (c, shift.conjugate()))
    return out, a, b, ends, kernels


def agrees(found: Any, expected: Any, tolerance: float, label: str) -> None:
    assert np.abs(np.subtract(found, expected)).max() <= tolerance * np.abs(expected).max(), label
