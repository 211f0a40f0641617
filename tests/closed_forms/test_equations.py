"""Closed forms fulfil their integral equations and carry their loads, in many digits."""

from collections.abc import Callable
from typing import Any, NamedTuple

import pytest
from closed_forms import mp, principal_value, resultant

from analytic import (
    bonded_flat,
    flat_row,
    parabola_row,
    sliding_flat,
    sliding_hertz,
    two_flats,
    two_parabolas,
    wavy,
)

FLAT = {"half_width": 1.0, "normal_load": 2.0}
HERTZ = {"half_width": 1.0, "radius": 2.0, "modulus": 3.0}
BONDED = {**FLAT, "shear_load": 0.7, "moment": -0.2}
FLATS = {"inner": 1.0, "outer": 2.0, "normal_load": 3.0}
WAVE = {"half_width": 0.6, "wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0}
CRESTS = {"half_width": 0.6, "radius": 3.0, "period": 2.0, "modulus": 5.0}
ROW = {"half_width": 0.6, "period": 2.0, "mean_pressure": 5.0}
HALF = mp.mpf(0.6)


class Contact(NamedTuple):
    """1/π PV∫ φ(t)/(x - t) dt + own φ(x) + others = E*/2 h' on a patch.

    density    φ, the pressure or p + i q
    ends       of the patch
    slope      E*/2 h' at x
    load       ∫φ over all patches, of a row over one
    digits     that the quadrature has: fewer where φ is infinite at an end
    own        what equations (1) and (12) of dissimilar bodies add
    others     the rest of the kernel, of (x, t); on two patches that of the mirror image, (x, -t)
    moment     ∫φ x, where it is a result
    potential  F(z) = 1/π ∫ φ(t)/(z - t) dt, where it has a closed form
    """

    density: Callable[[Any], Any]
    ends: tuple[Any, Any]
    slope: Callable[[Any], Any]
    load: Any
    digits: int
    own: Any = 0
    others: Callable[[Any, Any], Any] | None = None
    two: bool = False
    moment: Any = None
    potential: Callable[[Any], Any] | None = None


def parabola_in_sliding(k: float) -> Contact:
    given = {**HERTZ, "coupling": k, "lib": mp}
    return Contact(
        lambda t: sliding_hertz.pressure(t, **given),
        sliding_hertz.edges(half_width=1.0, coupling=k, lib=mp),
        lambda x: mp.mpf(3) / 2 * x / 2,
        sliding_hertz.load(**given), 25, own=-k, moment=sliding_hertz.moment(**given),
        potential=lambda z: sliding_hertz.potential(z, **HERTZ, coupling=k),
    )  # fmt: skip


def flat_in_sliding(k: float, moment: float | None) -> Contact:
    given = {**FLAT, "coupling": k, "lib": mp}
    tilt = 0 if moment is None else sliding_flat.tilt(**given, moment=moment, modulus=3)
    wanted = sliding_flat.upright_moment(**given) if moment is None else mp.mpf(moment)
    # A corner's power of up to -0.65: 1e-30 from it, where the rule ends, sums to 1e-16.
    return Contact(
        lambda t: sliding_flat.pressure(t, **given, moment=moment), (-1, 1),
        lambda x: mp.mpf(3) / 2 * tilt, 2, 16, own=-k, moment=wanted,
        potential=lambda z: sliding_flat.potential(z, **FLAT, coupling=k, moment=float(wanted)),
    )  # fmt: skip


def bonded(beta: float) -> Contact:
    given = {**BONDED, "dundurs": beta, "lib": mp}
    turned = {"half_width": 1, "dundurs": beta, "shear_load": 0.7, "moment": -0.2}
    tilt = bonded_flat.tilt(**turned, modulus=3, lib=mp)
    return Contact(
        lambda t: mp.mpc(bonded_flat.pressure(t, **given), bonded_flat.shear(t, **given)), (-1, 1),
        lambda x: mp.mpf(3) / 2 * tilt, mp.mpc(2, 0.7), 22, own=mp.mpc(0, beta), moment=-0.2,
        potential=lambda z: bonded_flat.potential(z, **BONDED, dundurs=beta),
    )  # fmt: skip


def two(module: Any, given: dict[str, float], slope: Any, load: Any, digits: int, **more: Any):
    ends = mp.mpf(given["inner"]), mp.mpf(given["outer"])
    return Contact(
        lambda t: module.pressure(t, **given, lib=mp), ends, slope, load, digits,
        others=lambda x, t: 1 / (x + t), two=True, **more,
    )  # fmt: skip


def pair_of_flats(moment: float) -> Contact:
    given = {**FLATS, "moment": moment}
    tilt = two_flats.tilt(**given, modulus=3, lib=mp)
    return two(
        two_flats, given, lambda x: mp.mpf(3) / 2 * tilt, 3, 22, moment=mp.mpf(moment),
        potential=lambda z: two_flats.potential(z, **given),
    )  # fmt: skip


def pair_of_parabolas(inner: float, outer: float) -> Contact:
    given = {"inner": inner, "outer": outer, "radius": 2, "modulus": 3}
    apart = two_parabolas.distance(inner=inner, outer=outer, lib=mp)
    slope = lambda x: mp.mpf(3) / 2 * two_parabolas.slope(x, distance=apart, radius=2, lib=mp)  # noqa: E731
    return two(two_parabolas, given, slope, two_parabolas.load(**given, lib=mp), 22)


def row(module: Any, given: dict[str, float], slope: Any, mean: Any) -> Contact:
    """Per period: 1/(x - t) and the smooth rest of (π/L) cot(π (x - t)/L)."""

    def rest(x: Any, t: Any) -> Any:
        return mp.pi / 2 * mp.cot(mp.pi * (x - t) / 2) - 1 / (x - t) if t != x else mp.zero

    density = lambda t: module.pressure(t, **given, lib=mp)  # noqa: E731
    potential = (lambda z: module.potential(z, **given)) if hasattr(module, "potential") else None
    return Contact(density, (-HALF, HALF), slope, 2 * mean, 22, others=rest, potential=potential)


CONTACTS = {
    **{f"sliding parabola, {k}": lambda k=k: parabola_in_sliding(k) for k in (0.49, -0.3, 9.9)},
    **{
        f"sliding flat, {k}, {M}": lambda k=k, M=M: flat_in_sliding(k, M)
        for k in (0.49, -0.3) for M in (None, -0.1)
    },
    "bonded flat": lambda: bonded(0.5),
    "bonded flat, other sign": lambda: bonded(-0.3),
    "two flats": lambda: pair_of_flats(0.0),
    "two tilted flats": lambda: pair_of_flats(-2.0),
    "two parabolas": lambda: pair_of_parabolas(1.0, 2.0),
    "two that nearly meet": lambda: pair_of_parabolas(0.01, 2.0),
    "two narrow ones": lambda: pair_of_parabolas(1.0, 1.001),
    "wave": lambda: row(
        wavy, WAVE, lambda x: 5 * wavy.slope(x, wavelength=2, amplitude=0.3, lib=mp) / 2,
        wavy.mean_pressure(**WAVE, lib=mp),
    ),
    "row of flats": lambda: row(flat_row, ROW, lambda x: 0, 5),
    "row of parabolas": lambda: row(
        parabola_row, CRESTS, lambda x: 5 * parabola_row.slope(x, radius=3, period=2, lib=mp) / 2,
        parabola_row.mean_pressure(**CRESTS, lib=mp),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CONTACTS)
def test_the_equation_holds(name: str) -> None:
    contact = CONTACTS[name]()
    lo, hi = contact.ends
    integral, x = principal_value(contact.density, float(lo + mp.mpf("0.7") * (hi - lo)), (lo, hi))
    image = (lambda t: contact.density(-t)) if contact.two else contact.density
    if contact.others is not None:
        middle = () if contact.two else (x,)
        others = resultant(image, (lo, *middle, hi), lambda t: contact.others(x, t))
        integral += others / mp.pi
    error = integral + contact.own * contact.density(x) - contact.slope(x)
    assert abs(error) < mp.mpf(10) ** -contact.digits


@pytest.mark.parametrize("z", [0.7 + 0.2j, -2.2 - 0.4j, -40 + 3j])
@pytest.mark.parametrize("name", CONTACTS)
def test_the_potential_is_the_cauchy_integral(name: str, z: complex) -> None:
    contact, at = CONTACTS[name](), mp.mpc(z)
    if contact.potential is None:
        return
    rest = contact.others if contact.others and not contact.two else lambda x, t: 0
    total = resultant(contact.density, contact.ends, lambda t: 1 / (at - t) + rest(at, t))
    if contact.two:
        total += resultant(lambda t: contact.density(-t), contact.ends, lambda t: 1 / (at + t))
    value = contact.potential(z)
    assert abs(complex(total / mp.pi) - value) <= 1e-13 * abs(value)


@pytest.mark.parametrize("name", CONTACTS)
def test_the_loads_are_carried(name: str) -> None:
    contact = CONTACTS[name]()
    image = lambda t: contact.density(-t)  # noqa: E731
    load = resultant(contact.density, contact.ends)
    load += resultant(image, contact.ends) if contact.two else 0
    assert abs(load - contact.load) < mp.mpf(10) ** -contact.digits * abs(contact.load)
    if contact.moment is not None:
        moment = resultant(contact.density, contact.ends, lambda t: t)
        moment -= resultant(image, contact.ends, lambda t: t) if contact.two else 0
        assert abs(mp.re(moment) - contact.moment) < mp.mpf(10) ** -contact.digits
