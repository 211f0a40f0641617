"""What the page shows of one setting: numbers and curves, or the sentence of a refusal.

All is relative to a base: one of four indenters on a half-plane with E* = R = 1, or the scene of a
file. The load is a multiple of the base's. Tilt and bulk stress are multiples of what its mean
pressure would need: slope p̄/E*, stress p̄. The sliders start from the values of the file.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import sqrt
from typing import Any

import numpy as np

from sie.arguments import with_short_words
from sie.errors import ContactError
from sie.problem.scene import Scene
from sie.profiles.shapes import RoundedFlat
from sie.solution import Solution, solve

from . import teaching
from .controls import ACROSS, BANDS, DOWN, LIVE, OF_FILE, ROUNDED, SAVED, SHAPES, Control, shapes

LOAD = 0.4  # of the four indenters, over E* R
POINTS = 161
MARGIN, DEPTH = 1.8, 1.8  # half of the picture's width, and its depth, over the half-width
NODES = (4, 8, 16, 32, 64, 128)
SHOWN = 0.9  # of the points lie below the top of the picture of an infinite traction

Answer = dict[str, Any]


@dataclass(frozen=True)
class Setting:
    """Where the sliders stand.

    Raises
    ------
    ValueError
        From `of_words`, for a name or a number that the page does not send.
    """

    shape: str = ROUNDED
    ratio: float = 0.5
    load: float = 1.0
    tilt: float = 0.0
    friction: float = 0.5
    share: float = 0.6
    bulk: float = 0.0
    beta: float = 0.0
    file: Scene | None = None

    @classmethod
    def of_words(cls, words: Mapping[str, str], file: Scene | None = None) -> Setting:
        """The setting that a query of the page names; what it leaves out keeps its start."""
        numbers = {control.name: control for control in sliders(file)}
        given: dict[str, Any] = {name: control.start for name, control in numbers.items()}
        for name, word in words.items():
            if name == "shape":
                if word not in shapes(file):
                    raise ValueError(f'there is no shape "{word}"')
                given[name] = word
            elif name in numbers:
                given[name] = numbers[name].nearest(float(word))
            else:
                raise ValueError(f'there is no slider "{name}"')
        return cls(**{"shape": shapes(file)[0], **given, "file": file})

    @cached_property
    def base(self) -> Scene:
        """The scene that the sliders change: a load, no friction and no tilt."""
        if self.shape == OF_FILE and self.file is not None:
            return self.file
        P = LOAD * self.load
        if self.shape == ROUNDED:
            # b² E*/R is a multiple of P for a given a/b.
            unit = Scene(
                profile=RoundedFlat(self.ratio, 1.0), modulus=1.0, poisson=0.3, half_width=1.0
            )
            b = sqrt(P / solve(unit).normal_load)
            return Scene(
                profile=RoundedFlat(self.ratio * b, 1.0), modulus=1.0, poisson=0.3, normal_load=P
            )
        return Scene(profile=SHAPES[self.shape], modulus=1.0, poisson=0.3, normal_load=P)

    @cached_property
    def scene(self) -> Scene:
        """The scene under the sliders; that of the file where none was moved."""
        base, times = self.base, self.load if self.shape == OF_FILE else 1.0
        if self.shape == OF_FILE and self == Setting.of_words({}, self.file):
            return base
        rest, mean = _at_rest(base)
        P = rest * times
        changes: dict[str, Any] = {
            "normal_load": P,
            "half_width": None,
            "friction": self.friction,
            "tangential_load": self.friction * self.share * P,
            "bulk_stress": self.bulk * mean,
            "sliding": 0,
        }
        if base.moment is not None:
            changes["moment"] = base.moment * times  # the load keeps its place
        if self.tilt:
            changes |= {"moment": None, "tilt": base.tilt + self.tilt * mean / base.Estar}
        if self.beta != base.beta:
            changes["dundurs"] = self.beta
        return replace(base, **changes)


def sliders(file: Scene | None) -> tuple[Control, ...]:
    """The sliders of the served page, which start from the values of the file.

    Raises
    ------
    ValueError
        For a bonded punch, which has no coefficient of friction.
    ContactError
        If the file's normal problem has no answer.
    """
    if file is None:
        return LIVE
    if file.bonded:
        raise ValueError(
            "friction = inf has no place on a slider: give a finite friction, or use sie solve"
        )
    P, mean = _at_rest(file)
    limit = file.friction * P
    start = {
        "friction": file.friction,
        "share": float(file.sliding or (file.tangential_load / limit if limit else 0.0)),
        "bulk": file.bulk_stress / mean,
        "beta": file.beta,
    }
    known = {"beta": (0.0,)} if file.body is not None else {}  # two bodies have a β of their own
    return tuple(
        replace(c, values=known.get(c.name, c.values)).starting(start.get(c.name, c.start))
        for c in LIVE
    )


def _at_rest(base: Scene) -> tuple[float, float]:
    """The load and the mean pressure without friction."""
    solution = solve(replace(base, friction=0.0, tangential_load=0.0, bulk_stress=0.0, sliding=0))
    return solution.normal_load, solution.normal_load / (2.0 * solution.half_width)


def answer(setting: Setting, part: str) -> Answer:
    """The page's data for a setting, ready for JSON; {"refusal": sentence} where there is none.

    Parameters
    ----------
    setting : Setting
        Where the sliders stand.
    part : {"contact", "stress"}
        The tractions and their certificate, or what lies below them, which takes longer.
    """
    try:
        return PARTS[part](solve(setting.scene))
    except (ContactError, ValueError) as refusal:
        return {"refusal": with_short_words(str(refusal))}


def _contact(solution: Solution) -> Answer:
    lo, hi = solution.edges
    # Closer together at the edges
    x = (lo + hi) / 2 + (hi - lo) / 2 * np.sin(np.linspace(-np.pi / 2, np.pi / 2, POINTS))
    pressure, shear = solution.pressure(x), solution.shear(x)
    finite = np.isfinite(pressure) & np.isfinite(shear)
    x, pressure, shear = x[finite], pressure[finite], shear[finite]
    top = 1.05 * float(pressure.max() if finite.all() else np.quantile(pressure, SHOWN))
    friction = solution.scene.friction
    certificate = solution.check()
    nodes, errors = _textbook(solution)
    zones = ", ".join(f"[{lo:.6g}, {hi:.6g}]" for lo, hi in solution.stick)
    return {
        "x": _rounded(x), "p": _rounded(pressure), "q": _rounded(shear),
        "fp": _rounded(friction * pressure), "tops": _rounded((top, (friction or 1.0) * top)),
        "stick": [_rounded(zone) for zone in solution.stick],
        "n": nodes, "errors": errors, "certificate": _number(certificate.error),
        "numbers": [
            ["contact", ", ".join(f"[{lo:.10g}, {hi:.10g}]" for lo, hi in solution.patches)],
            ["load P, shear Q", f"{solution.normal_load:.6g}, {solution.tangential_load:.6g}"],
            ["tilt, moment", f"{solution.tilt:.6g}, {solution.moment:.6g}"],
            ["stick", zones or "none: full sliding"],
            ["error of p / peak", f"{certificate.error:.1e}"],
            ["certificate", "met" if certificate.ok else "NOT met"],
        ],
    }  # fmt: skip


def _stress(solution: Solution) -> Answer:
    lo, hi = solution.edges
    middle, r = (lo + hi) / 2, (hi - lo) / 2
    columns = np.linspace(middle - MARGIN * r, middle + MARGIN * r, ACROSS)
    rows = np.linspace(0.0, DEPTH * r, DOWN)
    mises = solution.stress(columns[None, :], rows[:, None]).mises
    # A peak at one point would leave one band for all others.
    top = float(np.quantile(mises[np.isfinite(mises)], 0.995))
    bands = np.clip(np.nan_to_num(mises) / top * BANDS, 0, BANDS - 1).astype(int)
    weakest, tension = solution.elastic_limit(), solution.peak_tension()
    place = f"({weakest.x:.4g}, {weakest.y:.4g})"
    tensile = f"{tension.value:.6g} at x = {tension.x:.6g}" if tension.value > 0.0 else "none"
    return {
        "bands": bands.ravel().tolist(), "top": _number(top),
        "frame": _rounded((columns[0], columns[-1], rows[-1])),
        "weakest": [_rounded(where) for where in weakest.places],
        "numbers": [
            ["first yield P/(b k)", f"{weakest.ratio:.6g} at {place}"],
            ["largest tension", tensile],
        ],
    }  # fmt: skip


PARTS = {"contact": _contact, "stress": _stress}


def _textbook(solution: Solution) -> tuple[list[int], list[float]]:
    """The counts of nodes n and the textbook's largest error at its nodes, over the peak.

    Empty where its equation is another: several patches, sharp edges, dissimilar bodies.
    """
    if len(solution.patches) > 1 or any(solution.sharp) or solution.scene.beta != 0.0:
        return [], []
    lo, hi = solution.edges
    middle, r = (lo + hi) / 2, (hi - lo) / 2
    slope, half_modulus = solution.scene.profile.slope, solution.scene.Estar / 2
    errors = []
    for n in NODES:
        t, p, _ = teaching.solve(
            lambda s: half_modulus * (slope(middle + r * s) + solution.tilt), n, index=-1
        )
        exact = solution.pressure(middle + r * t)
        known = np.isfinite(exact)
        errors.append(float(np.abs(p - exact)[known].max() / exact[known].max()))
    return list(NODES), [_number(max(error, 1e-17)) for error in errors]


def _number(value: float) -> float:
    return float(f"{value:.5g}")


def _rounded(values: Any) -> list[float]:
    return [_number(v) for v in np.asarray(values, dtype=float).tolist()]


def saved_answers() -> dict[str, Answer]:
    """The answers of all settings of a saved page, by the name that its script gives a setting."""
    found = {}
    for shape in (ROUNDED, *SHAPES):
        controls = [c for c in SAVED if c.name != "ratio" or shape == ROUNDED]
        for values in product(*(control.values for control in controls)):
            names = (control.name for control in controls)
            given: dict[str, Any] = dict(zip(names, values, strict=True))
            setting = Setting(shape=shape, **given)
            found[_name(shape, given)] = {part: answer(setting, part) for part in PARTS}
    return found


def _name(shape: str, given: dict[str, float]) -> str:
    """The name of a setting: its shape and its values, in the order of the controls."""
    return "|".join([shape, *(f"{value:g}" for value in given.values())])
