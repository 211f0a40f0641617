"""The statements in the text of the paper, as claims, and its errata."""

from __future__ import annotations

from collections.abc import Iterator

from scipy.optimize import brentq, minimize_scalar

from sie import charts
from validation.harness.measures import largest
from validation.harness.records import Claim, Table
from validation.rounded_punch import closed_tension, limit

PRINTED_CROSSING = 0.55
CROSSING = 0.540206764905  # where the strength is Hertz's again, by this project


def statements() -> Iterator[Claim]:
    yield from _of_strength()
    yield from _of_tension_and_sliding()


def _of_strength() -> Iterator[Claim]:
    hertz = limit(0.0)
    crossing = float(brentq(lambda r: limit(r) - hertz, 0.5, 0.6, xtol=1e-12, rtol=1e-12))
    yield Claim("§ 5.1: the strength is above Hertz's for a/b up to 0.55; distance of the crossing "
                "from that", "paper, § 5.1",
                abs(crossing - PRINTED_CROSSING), abs(crossing - 0.5402), "0.5402", high=0.005,
                erratum=f"it is {crossing:.6f}")  # fmt: skip
    yield Claim("the strength is Hertz's again at a/b", "this project", crossing, PRINTED_CROSSING,
                "the paper's 0.55", low=CROSSING - 1e-9,
                high=CROSSING + 1e-9)  # fmt: skip
    strongest = minimize_scalar(
        lambda r: -limit(r), bounds=(0.1, 0.4), method="bounded", options={"xatol": 1e-6}
    )
    yield Claim(f"§ 5.1: the strength first increases: its largest gain over Hertz, at a/b = "
                f"{strongest.x:.4f}", "paper, § 5.1",
                -strongest.fun / hertz - 1, limit(0.6) / hertz - 1, "a/b = 0.6",
                low=0.05)  # fmt: skip
    yield Claim("§ 5.1: almost halved at a/b = 0.9: strength over Hertz's", "paper, § 5.1",
                limit(0.9) / hertz, limit(0.8) / hertz,
                "a/b = 0.8", low=0.5, high=0.55)  # fmt: skip
    halved = float(brentq(lambda r: limit(r) / hertz - 0.5, 0.8, 0.97, xtol=1e-9))
    yield Claim(
        "strength halved at a/b",
        "this project: 0.91",
        halved,
        crossing,
        "where it is Hertz's",
        low=0.905,
        high=0.915,
    )


def _of_tension_and_sliding() -> Iterator[Claim]:
    tension = closed_tension(0.0, 0.0)[0]
    yield Claim("§ 5.2: the tension at a/b = 0.8 is only double Hertz's: ratio", "paper, § 5.2",
                float(charts.surface_tension(0.8, [0.0])[0] / tension),
                float(charts.surface_tension(0.9, [0.0])[0] / tension), "a/b = 0.9",
                low=1.8, high=2.2)  # fmt: skip
    yield _jump()
    low = [limit(r, 0.3) / limit(0.0, 0.3) for r in (0.05, 0.1, 0.15, 0.2)]
    yield Claim("§ 5.1: well below Hertz (by a twentieth at least) at f = 0.3 for a/b = 0.05 to "
                "0.2: largest strength over Hertz's",
                "paper, § 5.1", largest(low), limit(0.5, 0.3) / limit(0.0, 0.3), "a/b = 0.5",
                high=0.95,
                erratum="at 0.05 and 0.1 it is slightly above, at 0.2 it is 1.8 % below",
                )  # fmt: skip


def _jump() -> Claim:
    """The friction at which the weakest point of Hertz's contact moves to the surface."""

    def surfaces(ratio: float) -> float:
        low, high = 0.1, 0.6
        while high - low > 1e-4:
            middle = 0.5 * (low + high)
            low, high = (
                (low, middle)
                if charts.punch(ratio, middle).elastic_limit().on_surface
                else (middle, high)
            )
        return high

    return Claim("§ 5.1, Fig. 7: Hertz's weakest point jumps to the surface at about f = 0.3",
                 "paper, § 5.1", surfaces(0.0), surfaces(0.8),
                 "a/b = 0.8", low=0.25, high=0.35)  # fmt: skip


ERRATA = Table(
    "Errata of the paper, as our copy prints it", ("where", "printed", "should read"),
    (
        ("§ 3.2", "flat part b, c < b, c > b", "a, c < a, c > a"),
        ("(12)", "β p(ξ) under the integral", "β p(x) beside it"),
        ("(17)", "∂q/∂t", "the rate of slip"),
        ("after (19)", "Q/f replaces P", "Q*/f replaces P"),
        ("after (25)", "∫_b^a", "∫_a^b"),
        ("(26), (27), (29), (31)", "the root over (b² - t²)(t - x)", "over b² - t² only"),
        ("(24) to (31)", "∫", "principal values"),
        ("(34)", "no factor b²", "b² times the integrals, as in (33) and (35)"),
        ("§ 5.1", "stronger than Hertz for a/b < 0.55", "for a/b < 0.5402"),
        ("§ 5.1", "well below Hertz for f ≥ 0.3 at small a/b",
         "not so: within 2 % of it for a/b ≤ 0.2 at f = 0.3"),
    ),
    "Those of the appendix are evaluated in the next section, the last two above.",
)  # fmt: skip
