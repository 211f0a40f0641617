"""Partial slip of similar bodies against closed forms in 25 digits: first loading, unloading,
reloading, bulk stress, cycles.

Under a constant normal load P the tangential load Q rises, falls and rises again. Hertz: Cattaneo
(1938), Mindlin (1949), with a bulk stress Nowell & Hills (1987); the rounded flat: Ciavarella,
Hills & Monno (1998), § 3. Errors are over the largest value. The effect of one ulp of x and of a
zone's end on the slip in zones a millionth long is not counted. The solver computes zones, shear,
slip and energy; the closed forms, which share no code with it, are evaluated in mpmath for the same
doubles. A closed loop must close, and the area of the loop of Q over the bodies' shift, by
Simpson's rule, must be the energy lost.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

import sie
from analytic import cattaneo, cattaneo_rounded, hertz
from oracles.principal_value import context
from validation.harness.counting import work
from validation.harness.measures import apart, largest, relative
from validation.harness.records import Claim, Curve, Doing, Numbers, Record, Table, checked

TITLE = "Partial slip: zones, shear, slip, energy, cycles"
SECONDS = (3.5, 9.0)
TIMED = False
BAR, BAR_OF_SLIP = 1e-13, 1e-12
SPOILED = 1e-11
mp = context(25)
E, F, P = 2.0, 0.5, 0.375
FP = F * P
FRACTIONS = (1e-2, 0.1, 0.3, 0.6, 0.9, 0.99, 1.0 - 1e-6, 1.0 - 1e-12)
QUICK = (1e-2, 0.3, 1.0 - 1e-6)
TURNS = (0.8, -0.2, 0.5)  # Q/fP: loaded, unloaded, loaded again
PLACES = np.array([-0.97, -0.83, -0.52, -0.21, 0.04, 0.37, 0.66, 0.91])
STEPS = (100, 1000)
SIMPSON = (60, 200)  # intervals
LOOP = (30, 80)
Shear = Callable[[Any], Any]


@dataclass(frozen=True)
class Contact:
    """A profile, and its closed forms as functions of x in mpmath; loads are Q/fP of the turning
    points so far.
    """

    name: str
    profile: sie.Profile
    module: Any
    given: dict[str, float]

    def exact(self, name: str, x: Numbers, *loads: float) -> list[Any]:
        """`name` of the module at points: the last load is the present one, the others are those of
        the turning points.
        """
        turned = ("largest_load", "least_load")[: len(loads) - 1]
        named = {k: mp.mpf(Q) for k, Q in zip((*turned, "tangential_load"), loads, strict=True)}
        function = getattr(self.module, name)
        return [
            function(mp.mpf(v), **self.given, normal_load=P, friction=F, **named, lib=mp)
            for v in map(float, x)
        ]

    def scene(self, **loads: Any) -> sie.Scene:
        return sie.Scene(profile=self.profile, modulus=E, normal_load=P, friction=F, **loads)


HERTZ = Contact(
    "Hertz",
    sie.Parabola(1.0),
    cattaneo,
    {"half_width": hertz.half_width(normal_load=P, radius=1.0, modulus=E, lib=mp)},
)
PUNCH = Contact(
    "rounded flat",
    sie.RoundedFlat(0.7, 1.0),
    cattaneo_rounded,
    {"half_flat": 0.7, "radius": 1.0, "modulus": E},
)
CONTACTS = (HERTZ, PUNCH)


def compute(quick: bool) -> Iterator[Record]:
    rows = []
    for contact in CONTACTS:
        yield Doing(f"{contact.name}: first loading")
        fractions = (FRACTIONS, QUICK)[quick]
        found = [loaded(contact, fraction) for fraction in fractions]
        rows += [
            (contact.name, f"{fraction:.12g}", *row)
            for fraction, row in zip(fractions, found, strict=True)
        ]
        yield from _loading(contact, fractions, found)
        yield Doing(f"{contact.name}: unloading and reloading")
        yield from turned(contact)
        yield from cycled(contact)
    yield Table(
        "First loading: errors over the largest value",
        ("contact", "Q/fP", "shear", "slip", "half-width of the stick zone"),
        rows,
    )
    yield Doing("bulk stress")
    yield from bulk()
    yield Doing("cycles")
    yield from loops(quick)
    yield Doing("many steps")
    yield cost(STEPS[not quick])


# -- first loading --------------------------------------------------------------------------------


def loaded(contact: Contact, fraction: float, factor: float = 1.0) -> tuple[float, float, float]:
    """Errors of the shear, of the slip in the slip zones, and of the half-width of the stick
    zone.
    """
    Q = fraction * FP
    solution = sie.solve(contact.scene(tangential_load=Q))
    b, c = solution.half_width, solution.stick[0][1]
    x = b * PLACES
    shear = apart(solution.shear(x), contact.exact("shear", x, Q), factor)
    outside = np.array([s * (c + (b - c) * u) for s in (-1, 1) for u in (0.35, 0.6, 0.95)])
    slip = apart(factor * solution.slip(outside), slip_of(contact, outside, Q)) - _of_ulps(
        solution, outside
    )
    return shear, largest((slip, 0.0)), relative(c, stick_of(contact, Q), factor)


def _of_ulps(solution: sie.Solution, x: Any) -> float:
    """The effect of one ulp of x and of the zone's end on the slip: large in a short zone."""
    here, ulp = solution.slip(x), 2.0 * float(np.spacing(solution.half_width))
    return float(
        max(np.abs(solution.slip(x + d) - here).max() for d in (-ulp, ulp)) / np.abs(here).max()
    )


def slip_of(contact: Contact, x: Any, Q: float) -> list[Any]:
    more = {} if contact is PUNCH else {"modulus": E}
    given = (
        contact.given
        | more
        | {"normal_load": P, "friction": F, "tangential_load": mp.mpf(Q), "lib": mp}
    )
    return [contact.module.slip(mp.mpf(float(v)), **given) for v in x]


def stick_of(contact: Contact, Q: float) -> Any:
    """c: P(c) = P - Q/f."""
    given = contact.given | {
        "normal_load": P,
        "friction": F,
        "tangential_load": mp.mpf(Q),
        "lib": mp,
    }
    return (
        cattaneo.stick_half_width(**given)
        if contact is HERTZ
        else mp.mpf(0.7) + cattaneo_rounded.stick_rim(**given)
    )


def _loading(
    contact: Contact, fractions: Sequence[float], found: Sequence[tuple[float, float, float]]
) -> Iterator[Record]:
    spoiled = loaded(contact, 0.3, 1.0 + SPOILED)
    words = ("shear", "slip", "half-width of the stick zone")
    for k, (name, bar) in enumerate(zip(words, (BAR, BAR_OF_SLIP, BAR_OF_SLIP), strict=True)):
        errors = [row[k] for row in found]
        yield Claim(
            f"{contact.name}, Q/fP from {fractions[0]:g} to 1 - {1 - fractions[-1]:.0e}: largest "
            f"error of the {name}",
            "README: partial slip to 1e-12",
            largest(errors),
            spoiled[k],
            f"answers off by {SPOILED:.0e}",
            high=bar,
        )
        decades = [float(np.log10(v / (1.0 - v))) for v in fractions]
        yield Curve("loading", f"{contact.name}: {name}", decades, errors, "both")


# -- unloading, reloading, energy -----------------------------------------------------------------


def turned(contact: Contact) -> Iterator[Record]:
    """Q to 0.8 fP, down to -0.2 fP, up to 0.5 fP."""
    loads = [t * FP for t in TURNS]
    history = sie.follow(contact.scene(), sie.Path([(P, Q) for Q in loads]))
    x = history[0].half_width * PLACES
    lines = history[0].half_width * np.linspace(-1.0, 1.0, 201)
    for k, name in enumerate(("shear", "unloading_shear", "reloading_shear")):
        exact = contact.exact(name, x, *loads[: k + 1])
        yield Curve(
            f"turns: {contact.name}", f"Q = {TURNS[k]:g} fP", lines, history[k].shear(lines) / FP
        )
        yield Curve(
            f"turns: {contact.name} points", "", x, [float(q) / FP for q in exact], "points"
        )
        if k:
            first = history[0].shear(x)
            yield checked(
                partial(apart, true=exact),
                history[k].shear(x),
                first,
                what=f"{contact.name}: error of the {name[:-6]} shear",
                by="Mindlin & Deresiewicz 1953",
                named="the shear at the first turning point",
                high=BAR,
            )


def cycled(contact: Contact) -> Iterator[Claim]:
    """A cycle of Q between ± 0.8 fP: the energy lost, and the closure of the loop."""
    Q = TURNS[0] * FP
    cycle = sie.follow(contact.scene(), sie.Path([(P, Q), (P, -Q), (P, Q)]))
    given = contact.given | {
        "normal_load": P,
        "friction": F,
        "tangential_load": mp.mpf(Q),
        "lib": mp,
    }
    exact_energy = contact.module.dissipation(
        **(given | {"modulus": E} if contact is PUNCH else _without_width(given))
    )
    lost = cycle[2].energy_lost - cycle[0].energy_lost
    yield checked(
        lambda W: relative(W, exact_energy),
        lost,
        cycle[2].energy_lost,
        what=f"{contact.name}: relative error of the energy lost in a cycle",
        by="README: energy to 1e-12",
        named="with that of the first loading",
        high=BAR_OF_SLIP,
    )
    x = cycle[0].half_width * PLACES
    peak = float(np.abs(cycle[0].shear(x)).max())
    yield checked(
        lambda k: float(np.abs(cycle[k].shear(x) - cycle[0].shear(x)).max()) / peak,
        2,
        1,
        what=f"{contact.name}: a closed loop leaves the shear as it was; difference over its peak",
        by="this project",
        named="half of the loop",
        high=BAR,
    )


def _without_width(given: dict[str, Any]) -> dict[str, Any]:
    return {k: v for k, v in given.items() if k != "half_width"} | {"modulus": E}


# -- bulk stress ----------------------------------------------------------------------------------


def bulk() -> Iterator[Record]:
    """Hertz, Q = 0.6 fP, σ up to where it reverses the slip at an edge: e = πσb²/(8fP) = b - c."""
    Q, b = 0.6 * FP, float(HERTZ.given["half_width"])
    room = 1.0 - float(np.sqrt(0.4))
    lines, x = np.linspace(-1.0, 1.0, 201), b * PLACES
    shears, zones, wrong_sign = [], [], []
    for share in (0.0, 0.45, -0.9):
        sigma = share * room * 8.0 * FP / (np.pi * b)
        solution = sie.solve(HERTZ.scene(tangential_load=Q, bulk_stress=sigma))
        other = sie.solve(HERTZ.scene(tangential_load=Q, bulk_stress=-sigma))
        given = _loads(Q, sigma)
        exact = [cattaneo.bulk_shear(mp.mpf(v), **given) for v in x.tolist()]
        shears.append(apart(solution.shear(x), exact))
        zones.append(apart(solution.stick[0], cattaneo.bulk_stick(**given)))
        wrong_sign.append(apart(other.shear(x), exact))
        label = f"σ b/(fP) = {sigma * b / FP:.3g}"
        yield Curve("bulk", label, lines, solution.shear(b * lines) / FP)
        yield Curve("bulk points", "", PLACES, [float(q) / FP for q in exact], "points")
    by, plain = "Nowell & Hills 1987", sie.solve(HERTZ.scene(tangential_load=Q))
    yield Claim(
        "Hertz with bulk stress: largest error of the shear", by, largest(shears),
        max(wrong_sign), "the bulk stress with the other sign", high=BAR,
    )  # fmt: skip
    yield Claim(
        "Hertz with bulk stress: error of the ends of the stick zone / half-width", by,
        largest(zones), apart(plain.stick[0], cattaneo.bulk_stick(**given)),
        "without bulk stress", high=BAR_OF_SLIP,
    )  # fmt: skip


def _loads(Q: float, sigma: float) -> dict[str, Any]:
    """The arguments of the closed forms of Hertz under Q and a bulk stress."""
    loads = {"tangential_load": mp.mpf(Q), "bulk_stress": mp.mpf(sigma)}
    return HERTZ.given | {"normal_load": P, "friction": F, "lib": mp} | loads


# -- cycles ---------------------------------------------------------------------------------------


def loops(quick: bool) -> Iterator[Record]:
    """Loops of Q over the shift between the bodies, which enclose the energy lost."""
    for amplitude in (0.4, 0.7, 0.95):
        angles = np.linspace(0.0, 2.0 * np.pi, LOOP[not quick] + 1)
        history = sie.follow(
            PUNCH.scene(), sie.Path([(P, amplitude * FP * np.cos(t)) for t in angles])
        )
        yield Curve(
            "loops",
            f"Q = ±{amplitude:g} fP",
            [s.shift for s in history],
            amplitude * np.cos(angles),
        )
    lost, area = enclosed(0.8, SIMPSON[not quick])
    yield checked(
        lambda a: abs(a / lost - 1.0),
        area,
        enclosed(0.81, SIMPSON[not quick])[1],
        what="rounded flat: ∮Q dδ against the energy lost in the cycle",
        by="this project",
        named="the loop of Q = ±0.81 fP",
        high=1e-6,
    )


def enclosed(amplitude: float, n: int) -> tuple[float, float]:
    """(energy lost in a cycle, ∮Q dδ by Simpson's rule over the angle of Q = cos on one branch,
    which the other mirrors).
    """
    angles = np.linspace(0.0, np.pi, n + 1)
    history = sie.follow(PUNCH.scene(), sie.Path([(P, amplitude * FP * np.cos(t)) for t in angles]))
    shift = np.array([s.shift for s in history])
    weight = np.full(n + 1, 2.0)
    weight[1::2], weight[[0, -1]] = 4.0, 1.0
    area = 2.0 * float((weight * shift * amplitude * FP * np.sin(angles)).sum()) * np.pi / n / 3.0
    return 2.0 * (history[-1].energy_lost - history[0].energy_lost), area


def cost(steps: int) -> Claim:
    """The cost of a step of a long cycle, its stick zone, relative to solving its scene alone."""
    angles = np.linspace(0.0, 2.0 * np.pi, steps + 1)[1:]
    path = sie.Path([(P, 0.8 * FP * np.sin(t)) for t in angles])

    def followed() -> None:
        _ = [solution.stick for solution in sie.follow(PUNCH.scene(), path)]

    def a_tenth() -> None:
        for t in angles[: steps // 10]:
            _ = sie.solve(PUNCH.scene(tangential_load=0.8 * FP * np.sin(t))).stick

    together, tenth = work(followed).steps, work(a_tenth).steps
    return checked(
        lambda times: times[0] / times[1],
        (together, 10.0 * tenth),
        (10.0 * tenth, together),
        what=f"a cycle of {steps} steps: work over that of as many single scenes",
        by="this project: cheaper than one by one",
        named="the two exchanged",
        high=0.7,
    )


# -- drawing --------------------------------------------------------------------------------------
