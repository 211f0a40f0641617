"""Every input from 1e-300 to 1e300 is refused in a sentence, or answered as in other units."""

import math

import numpy as np
import pytest

import sie

MAGNITUDES = [
    1e-300, 1e-200, 1e-150, 1e-110, 1e-17, 1e-6, 1e6, 1e12, 1e17, 1e60, 1e110, 1e150, 1e200, 1e300,
]  # fmt: skip
EXTREME = [5e-324, 1e-320, 1e-17, 1e17, 9e307]
POINTS = np.array([-0.9, -0.2, 0.4, 0.99])
PARABOLA = sie.Parabola(1.0)


def scene(profile=PARABOLA, **given):
    loads = {} if "half_width" in given else {"normal_load": 1.0}
    bodies = {} if "body" in given else {"modulus": 1.0}
    return sie.Scene(profile=profile, **(bodies | loads | given))


def steel(young, **given):
    return scene(body=sie.Elastic(young, 0.3), **given)


FLAT, PUNCH, WEDGE, POWER = (
    sie.Flat(1.0),
    sie.RoundedFlat(1.0, 1.0),
    sie.Wedge(1.0),
    sie.Power(2.5, 1.0),
)
BAD_WORDS = (
    "NaN", "nan", "domain error", "zero-size", "division", "overflow", "broadcast", "cannot",
)  # fmt: skip
INPUTS = {
    "modulus": lambda v: scene(modulus=v),
    "young": steel,
    "young of the indenter": lambda v: steel(1.0, indenter=sie.Elastic(v, 0.3)),
    "poisson": lambda v: scene(poisson=v),
    "poisson of a body": lambda v: scene(body=sie.Elastic(1.0, v)),
    "dundurs": lambda v: scene(friction=0.3, sliding=1, dundurs=v),
    "dundurs of a bonded punch": lambda v: scene(FLAT, friction=math.inf, dundurs=v),
    "normal_load": lambda v: scene(normal_load=v),
    "normal_load of a bonded punch": lambda v: scene(
        FLAT, friction=math.inf, dundurs=0.2, normal_load=v
    ),
    "half_width": lambda v: scene(half_width=v),
    "half_width of a rounded punch": lambda v: scene(PUNCH, half_width=v),
    "tilt": lambda v: scene(tilt=v),
    "tilt of a rounded punch": lambda v: scene(PUNCH, tilt=v),
    "tilt of a flat punch": lambda v: scene(FLAT, tilt=v),
    "moment of a flat punch": lambda v: scene(FLAT, moment=v),
    "friction": lambda v: scene(friction=v, tangential_load=0.1),
    "friction in sliding": lambda v: scene(friction=v, sliding=1),
    "tangential_load": lambda v: scene(friction=0.3, tangential_load=v),
    "bulk_stress": lambda v: scene(friction=0.3, bulk_stress=v),
    "bulk_stress beside Q": lambda v: scene(friction=0.3, tangential_load=0.1, bulk_stress=v),
    "radius": lambda v: scene(sie.Parabola(v)),
    "radius of a rim": lambda v: scene(sie.RoundedFlat(1.0, v)),
    "half_flat": lambda v: scene(sie.RoundedFlat(v, 1.0)),
    "half_width of a punch": lambda v: scene(sie.Flat(v)),
    "slope of a wedge": lambda v: scene(sie.Wedge(v)),
    "coefficient": lambda v: scene(sie.Power(2.5, v)),
    "coefficient of x^4": lambda v: scene(sie.Power(4, v)),
    "exponent": lambda v: scene(sie.Power(v, 1.0)),
    "polynomial, 0": lambda v: scene(sie.Polynomial((v, 0.0, 1.0))),
    "polynomial, 1": lambda v: scene(sie.Polynomial((0.0, v, 1.0))),
    "polynomial, 2": lambda v: scene(sie.Polynomial((0.0, 0.0, v))),
    "polynomial, 3": lambda v: scene(sie.Polynomial((0.0, 0.0, 1.0, v))),
    "polynomial, 4": lambda v: scene(sie.Polynomial((0.0, 0.0, 1.0, 0.0, v))),
    "breaks": lambda v: scene(sie.Piecewise((-v, v), ((v, 1.0), (0.0,), (-v, 1.0)))),
    "pieces, 0": lambda v: scene(sie.Piecewise((0.0,), ((-v, 1.0), (v, 1.0)))),
    "pieces, 2": lambda v: scene(sie.Piecewise((0.0,), ((0.0, 1.0), (0.0, 1.0, v)))),
    "shifted": lambda v: scene(sie.Parabola(1.0).shifted(v)),
    "shifted rounded punch": lambda v: scene(PUNCH.shifted(v)),
    "shifted wedge": lambda v: scene(WEDGE.shifted(v)),
    "shifted flat punch": lambda v: scene(FLAT.shifted(v)),
    "shifted power": lambda v: scene(POWER.shifted(v)),
    "tilted": lambda v: scene(sie.Parabola(1.0).tilted(v)),
    "tilted wedge": lambda v: scene(WEDGE.tilted(v)),
    "term of a sum": lambda v: scene(sie.Parabola(1.0) + sie.Wedge(v)),
    "domain": lambda v: scene(sie.FromFunction("x", domain=(-v, v))),
    "declared break": lambda v: scene(sie.FromFunction("x", breaks=(v,))),
}


def answered(build):
    """The solution with what was asked of it, or the sentence that refuses it."""
    try:
        solution = sie.solve(build())
        asked = [*solution.edges, solution.normal_load, solution.moment, solution.tilt]
        x = solution.centre + solution.half_width * POINTS
        asked += [*solution.pressure(x), *solution.shear(x), *np.ravel(solution.stick)]
        assert str(solution.check())
    except (ValueError, sie.ContactError) as refusal:
        return str(refusal)
    assert np.isfinite(asked).all()
    return solution


@pytest.mark.slow(but=46)
@pytest.mark.parametrize("name", INPUTS)
@pytest.mark.parametrize("values", [EXTREME, MAGNITUDES], ids=["extreme", "all"])
def test_every_magnitude_of_every_input_is_answered_or_refused_with_a_sentence(name, values):
    for value in values:
        found = answered(lambda value=value: INPUTS[name](value))
        if isinstance(found, str):
            assert ": " in found or ";" in found, value  # what and how much; what to do
            assert not any(word in found for word in BAD_WORDS), value
        else:
            assert found.check().error >= 0.0, value


SCALED = {
    "parabola": sie.Parabola,
    "rounded": lambda L: sie.RoundedFlat(0.3 * L, L),
    "flat": sie.Flat,
    "wedge": lambda L: sie.Wedge(0.5),
    "power": lambda L: sie.Power(2.5, 1.0 / L / math.sqrt(L)),
    "polynomial": lambda L: sie.Polynomial((0.0, 0.1, 0.5 / L, 0.0, 0.1 / L / L / L)).tilted(0.1),
    "sum": lambda L: sie.Parabola(L).shifted(0.2 * L) + sie.Wedge(0.1),
    "corners": lambda L: sie.Piecewise((-0.5 * L, L), ((0.25, 0.5 / L), (0.0,), (-2.0, 2.0 / L))),
    "cut": lambda L: sie.Piecewise((-L, 0.0, 0.5 * L), ((0.0, 0.5 / L), (0.0, 2.0 / L))),
    "function": lambda L: sie.FromFunction(lambda x: np.sinh(x / L), domain=(-4.0 * L, 3.0 * L)),
}


UNITS = [(1e-6, 1.0), (1.0, 1e12)]
UNITS += [(10.0**e, s) for s in (1e-200, 1e-100, 1.0, 1e100, 1e200) for e in range(-300, 301, 100)]


@pytest.mark.slow(but=20)
@pytest.mark.parametrize("name", SCALED)
@pytest.mark.parametrize(("length", "stress"), UNITS)
def test_a_contact_in_any_units_is_refused_or_the_same(name, length, stress):
    def of(L, E):
        loads = {"normal_load": 0.3 * L * E, "tangential_load": 0.05 * L * E}
        return sie.Scene(profile=SCALED[name](L), modulus=E, friction=0.4, **loads)

    one, other = answered(lambda: of(1.0, 1.0)), answered(lambda: of(length, stress))
    inside = 1e-101 < length < 1e101 and 1e-101 < stress < 1e101
    assert not (inside and isinstance(other, str)), other
    if isinstance(other, str):
        return
    assert np.array(other.edges) / length == pytest.approx(np.array(one.edges), rel=1e-13)
    assert np.array(other.stick) / length == pytest.approx(np.array(one.stick), rel=1e-11)
    x = one.centre + one.half_width * POINTS
    p = other.pressure(length * x) / stress
    assert p == pytest.approx(one.pressure(x), rel=1e-12, abs=1e-13)
    moment = other.moment / length / length / stress
    assert moment == pytest.approx(one.moment, abs=1e-13)
    z = one.half_width * (0.4 + 1.1j)
    potential = complex(other.pressure.cauchy(length * z)) / stress
    assert potential == pytest.approx(complex(one.pressure.cauchy(z)), rel=1e-12)
    beside = one.edges[1] + one.half_width
    if np.isfinite(one.gap(beside)):
        gap = float(other.gap(length * beside)) / length
        assert gap == pytest.approx(float(one.gap(beside)), rel=1e-11)
    assert not inside or other.check().ok


FAR = np.array([-1e300, -1e150, -1e-300, 0.0, 1e120, 1e300])
SIZED = {
    "two signs of slip": lambda L, E: {
        "friction": 0.3,
        "tangential_load": 0.01 * L * E,
        "bulk_stress": 0.1 * E,
    },
    "sliding of dissimilar bodies": lambda L, E: {"friction": 0.3, "sliding": 1, "dundurs": 0.2},
}


@pytest.mark.slow(but=4)
@pytest.mark.parametrize("name", SIZED)
@pytest.mark.parametrize("length", [1e-100, 1e-60, 1.0, 1e60, 1e100])
@pytest.mark.parametrize("modulus", [1e-100, 1.0, 1e100])
def test_no_query_overflows_however_small_or_far_away(name, length, modulus):
    given = {"modulus": modulus, "poisson": 0.3, "normal_load": length * modulus} | SIZED[name](
        length, modulus
    )
    solution = sie.solve(sie.Scene(profile=sie.RoundedFlat(length, length), **given))
    x = np.concatenate((length * np.linspace(-3.0, 3.0, 7), FAR))
    for query in (solution.pressure, solution.shear, solution.gap):
        assert not np.isnan(query(x)).any()
    for y in (0.0, 1e-12 * length, length, 1e6 * length, 1e200):
        stress = solution.stress(x, y)
        assert np.isfinite([stress.xx, stress.yy, stress.xy]).all()
