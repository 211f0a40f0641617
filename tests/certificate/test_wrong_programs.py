"""The certificate is itself checked: programs that are wrong in the ways that programs are, large
or small, and right ones.

The pressure of a solution is replaced by a wrong one. Its true error is the largest difference from
the right one within 0.95 r of the centre, relative to the peak; the certificate must not be ok, and
must own up to at least a third of it.
"""

from dataclasses import replace
from functools import cache

import laws
import numpy as np
import pytest
import strategies
from hypothesis import given

import sie
from sie.certificate import coupled_check
from validation.cases import CASES, Case, solved
from validation.wrong_programs.pressures import PUNCH, SKEW, Wrong, WrongState, closed_form, root


def certificate(scene, values=None, **claims):
    """(certificate of the wrong pressure, its true error)."""
    solution = sie.solve(scene)
    right = solution.pressure
    values = values or right
    solution.__dict__["pressure"] = Wrong(right, values, **claims)
    r, m = solution.half_width, solution.centre
    x = m + r * np.linspace(-0.95, 0.95, 2011)
    x = x[np.abs(x[:, None] - np.array([*scene.profile.breaks, 9e9])).min(axis=1) > 1e-4 * r]
    with np.errstate(all="ignore"):
        error = float(
            np.abs(values(x) - right(x)).max()
            / laws.peak(right, solution.edges, scene.profile.breaks)
        )
        return solution.check(), error


def assert_caught(scene, values=None, share=1 / 3, **claims):
    found, error = certificate(scene, values, **claims)
    assert not found.ok
    assert not found.error < share * error


SIZES = (1e-3, 1e-6, 1e-9, 1e-12)


def right(scene):
    return sie.solve(scene).pressure


@pytest.mark.parametrize("case", CASES, ids=str)
def test_a_right_program_is_certified(case: Case):
    assert solved(case).check().ok
    assert solved(case).check().error <= 1e-13


@given(strategies.scenes())
def test_a_right_program_is_certified_on_random_scenes(scene):
    found = sie.solve(scene).check()
    assert found.ok, str(found)


def test_another_right_program_is_certified():
    """The closed form, written here, in place of the solver's values."""
    found, error = certificate(PUNCH, closed_form)
    assert error < 1e-14
    assert found.ok


def neighbour(e):
    pieces = ((0.25, 0.5), (0.0,), (-2.0 - 20 * e, 2.0 + 20 * e))
    return sie.Scene(profile=sie.Piecewise((-0.5, 1.0), pieces), modulus=1.0, half_width=1.125)


# By a size e: of C/w the residual shows nothing, but equilibrium does; a wider contact carries the
# load of the right one.
WRONG = {
    "a logarithm off": (PUNCH, lambda p, x, e: closed_form(x, second=1.0 + 10.0 * e)),
    "a load that was not scaled": (PUNCH, lambda p, x, e: p(x) * (1.0 + e)),
    "edges off": (PUNCH, lambda p, x, e: closed_form(x, b=1.0 + e)),
    "a centre off": (SKEW, lambda p, x, e: p(x - e)),
    "C/w": (PUNCH, lambda p, x, e: p(x) + 0.15 * e / root(x)),
    "(1 - s²)^(1/2 + e)": (PUNCH, lambda p, x, e: p(x) * root(x) ** (2.0 * e)),
    "a constant": (PUNCH, lambda p, x, e: p(x) + 0.15 * e),
    "even": (PUNCH, lambda p, x, e: p(x) + 0.15 * e * root(x)),
    "odd": (PUNCH, lambda p, x, e: p(x) + 0.15 * e * x * root(x)),
    "a wave": (PUNCH, lambda p, x, e: p(x) + 0.15 * e * np.cos(20 * x)),
    "a short wave": (PUNCH, lambda p, x, e: p(x) + 0.15 * e * np.cos(300 * x)),
    # One corner's curvature: the answer of a neighbouring question
    "another panel": (SKEW, lambda p, x, e: right(neighbour(e))(x)),
    "a bump": (PUNCH, lambda p, x, e: p(x) + 0.15 * e * np.exp(-(((x - 0.31) / 0.05) ** 2))),
}


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize(("scene", "wrong"), WRONG.values(), ids=WRONG)
def test_a_program_that_is_off_by_a_little_is_caught(scene, wrong, size):
    p = right(scene)
    assert_caught(scene, lambda x: wrong(p, x, size))


@pytest.mark.parametrize("size", SIZES)
def test_digits_lost_to_cancellation_are_caught(size):
    """Noise from one double to the next is not the rounding of x: a smooth pressure has none."""
    p = right(PUNCH)

    def noisy(x):
        grain = np.modf(np.abs(x) * 2.0**53 * 0.6180339887498949)[0]
        return p(x) + 0.15 * size * (2 * grain - 1)

    assert_caught(PUNCH, noisy, share=0.1)


SHARP = {
    "both edges": sie.Scene(profile=sie.Flat(1.0), modulus=1.0, normal_load=1.0, moment=0.2),
    "one edge": sie.Scene(profile=sie.Flat(1.0), modulus=1.0, normal_load=1.0, tilt=1.0),
}


@pytest.mark.parametrize("scene", SHARP.values(), ids=SHARP)
@pytest.mark.parametrize(("width", "size"), [(0.05, 1e-10), (0.003, 1e-7)])
def test_a_bump_beside_a_sharp_edge_is_caught(scene, width, size):
    """An infinite pressure is no measure: 1e-10 of that at the centre counts."""
    p, m = right(scene), sie.solve(scene).centre
    bump = size * float(p(m))
    found, _ = certificate(scene, lambda x: p(x) + bump * np.exp(-(((x - m - 0.31) / width) ** 2)))
    assert not found.ok


@pytest.mark.parametrize("scene", SHARP.values(), ids=SHARP)
def test_a_right_sharp_edge_is_certified_to_rounding(scene):
    found = sie.solve(scene).check()
    assert found.ok
    assert found.error < 2e-14
    assert found.abscissae < 1e-13


@pytest.mark.parametrize("size", SIZES)
def test_a_wrong_resultant_or_moment_is_caught(size):
    solution = sie.solve(SKEW)
    P, M = solution.normal_load, solution.moment
    assert_caught(SKEW, resultant=P * (1 + size))
    assert_caught(SKEW, moment=M + size * P)


def test_tension_is_caught():
    p = right(PUNCH)
    found, _ = certificate(PUNCH, lambda x: p(x) - 0.05)
    assert not found.ok and "NOT certified" in str(found)
    assert found.lowest_pressure < -0.1


PAIR = {"modulus": 2.0, "dundurs": 0.3, "friction": 0.3, "normal_load": 1.0}
DISSIMILAR = {
    "pressed": {"profile": sie.RoundedFlat(0.5, 1.0)},
    "sheared": {"profile": sie.Parabola(1.0), "tangential_load": 0.15},
    "not symmetric": {"profile": sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.05))},
    "Goodman's": {"profile": sie.Parabola(1.0), "tangential_load": 0.15, "coupling": "goodman"},
}


class OffBy(WrongState):
    """A state whose q, in stick, or p has an error of this size in the middle."""

    def __init__(self, state, row, size):
        super().__init__(state, None)
        self.row, self.size = row, size

    @property
    def values(self):
        right, middle = self.right.values, self.right.values.contact.m

        def rows(x, rest):
            found = right.rows(x, rest)
            p = found[0].max()
            found[self.row] += self.size * p * np.exp(-(((x - middle) / 0.05) ** 2))
            return found

        return right._replace(rows=rows)


@cache
def answered(kind):
    return sie.solve(sie.Scene(**PAIR | DISSIMILAR[kind]))


@pytest.mark.parametrize(("row", "size"), [(0, 0.0), (0, 1e-3), (0, 1e-8), (1, 1e-3), (1, 1e-8)])
@pytest.mark.parametrize("kind", DISSIMILAR)
def test_a_traction_of_dissimilar_bodies_that_is_off_in_stick_is_caught(kind, row, size):
    solution = answered(kind)
    off = OffBy(solution.coupled[1], row, size)
    found = coupled_check.coupled_certificate(off, solution.scene, 1e-13)
    assert found.ok == (not size)


@pytest.mark.parametrize("kind", DISSIMILAR)
def test_another_mismatch_of_dissimilar_bodies_is_caught(kind):
    solution = answered(kind)
    other = replace(solution.scene, dundurs=0.3001)
    assert not coupled_check.coupled_certificate(solution.coupled[1], other, 1e-13).ok
