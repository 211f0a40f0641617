"""What the page shows of one setting: numbers and curves, or the sentence of a refusal."""

from __future__ import annotations

import base64
from collections.abc import Callable
from dataclasses import asdict, replace
from itertools import product
from typing import Any

import numpy as np

from sie import Solution
from sie.arguments import with_short_words
from sie.errors import ContactError
from sie.io.beside_scene import Units

from . import teaching
from .frame import Array, frame_of, inside, mises, surface, tops, words
from .setting import NODES, ROUNDED, SAVED, SHAPES, Setting, sliders, solution_of

ALL_DIGITS = 1e-12  # of the textbook's error: what is left is rounding
GROUND = 81  # points of the surface
LEVELS = 1000  # of heights, over that of the frame

Answer = dict[str, Any]


def answer(setting: Setting, part: str, units: Units | None = None) -> Answer:
    """The page's data for a setting, ready for JSON; {"refusal": sentence} where there is none.

    Parameters
    ----------
    setting : Setting
        Where the sliders stand.
    part : {"contact", "stress", "strength"}
        The tractions and their certificate; the picture of the stress below; where the body yields
        first and cracks, which takes longest.
    units : Units, optional
        Labels of the file's units.
    """
    try:
        return PARTS[part](setting, solution_of(setting), words(setting.shape, units))
    except (ContactError, ValueError) as refusal:
        if part == "contact" and not setting.untouched:
            return {"refusal": _in_the_sliders_words(setting)}
        return {"refusal": with_short_words(str(refusal))}


def _in_the_sliders_words(setting: Setting) -> str:
    """Which slider gives an answer if it alone is set to 0; that of least work is tried first."""
    labels = {control.name: control.label for control in sliders(setting.file)}
    remedy = "Move the sliders nearer to their start."
    for name in ("beta", "bulk", "tilt", "share"):
        zero: dict[str, Any] = {name: 0.0}
        if getattr(setting, name) and _answered(replace(setting, **zero)):
            remedy = f"Set “{labels[name]}” to 0."
            break
    return f"These settings together have no answer. {remedy}"


def _answered(setting: Setting) -> bool:
    try:
        solution_of(setting).shear  # noqa: B018 -- solved when it is read
    except (ContactError, ValueError):
        return False
    return True


def _contact(setting: Setting, solution: Solution, word: dict[str, str]) -> Answer:
    frame = frame_of(setting.shape, setting.file)
    x, pressure, shear = inside(solution)
    ground = np.union1d(np.linspace(frame.lo, frame.hi, GROUND), solution.edges)
    punch, body = (height / frame.height * LEVELS for height in surface(solution, ground))
    P, Q, friction = solution.normal_load, solution.tangential_load, solution.scene.friction
    stick = _intervals(solution.stick, 6) or "none: all slips"
    certificate, flat = solution.check(), setting.shape == ROUNDED
    return {
        "frame": {name: _number(value) for name, value in asdict(frame).items()},
        "axes": {
            "x": word["length"].format("x"), "height": word["length"].format("height"),
            "p": word["stress"].format("p"), "q": word["stress"].format("q"),
            "mises": word["stress"].format("Mises stress"),
        },
        "x": _rounded(x), "p": _rounded(pressure), "q": _rounded(shear), "f": _number(friction),
        "tops": _rounded(tops(solution, pressure, shear)),
        "ground": _rounded(ground), "punch": _levels(punch), "body": _levels(body),
        "zones": _zones(solution),
        "loads": {
            "P": _number(setting.load), "at": _number(solution.moment / P),
            "Q": _number(Q / (friction * P) if friction else 0.0),
            "bulk": _number(solution.scene.bulk_stress / setting.rest.mean_pressure),
        },
        "textbook": _textbook(solution), "certificate": _number(certificate.error),
        "numbers": [
            [word["length"].format("contact"), _intervals(solution.patches, 10)],
            *[["flat part a/b", f"{setting.flat / solution.half_width:.6g}"]] * flat,
            [word["force"].format("load P, shear Q"), f"{P:.6g}, {Q:.6g}"],
            ["tilt; P acts at x =", f"{solution.tilt:.6g}; {solution.moment / P:.6g}"],
            [word["length"].format("stick"), stick if friction else "no friction"],
            ["error of p over its peak", f"{certificate.error:.1e}"],
            ["certificate", "met" if certificate.ok else "NOT met"],
        ],
    }  # fmt: skip


def _intervals(zones: Any, digits: int) -> str:
    return ", ".join(f"[{lo:.{digits}g}, {hi:.{digits}g}]" for lo, hi in zones)


def _zones(solution: Solution) -> list[tuple[float, float, str]]:
    """The ends of the zones of the contact: stick, slip or, without friction, smooth."""
    rest = "slip" if solution.scene.friction else "smooth"
    zones = [(lo, hi, "stick") for lo, hi in solution.stick]
    for lo, hi in solution.patches:
        marks = [lo, *(end for zone in solution.stick if lo <= zone[0] <= hi for end in zone), hi]
        zones += [(a, b, rest) for a, b in zip(marks[::2], marks[1::2], strict=True) if b > a]
    return [(_number(lo), _number(hi), kind) for lo, hi, kind in zones]


def _stress(setting: Setting, solution: Solution, word: dict[str, str]) -> Answer:
    values, top = mises(solution, frame_of(setting.shape, setting.file))
    levels = np.clip(np.rint(values / top * 255), 0, 255).astype(np.uint8)
    # Differences along both axes pack into less than the levels themselves.
    steps = np.diff(np.diff(levels, axis=1, prepend=np.uint8(0)), axis=0, prepend=np.uint8(0))
    return {"steps": base64.b64encode(steps.tobytes()).decode(), "top": _number(top)}


def _strength(setting: Setting, solution: Solution, word: dict[str, str]) -> Answer:
    weakest, tension = solution.elastic_limit(), solution.peak_tension()
    at = f"at ({weakest.x:.4g}, {weakest.y:.4g})"
    first = f"{weakest.ratio:.6g} {at}" if weakest.ratio > 0.0 else f"0 {at}: infinite stress"
    tensile = f"{tension.value:.6g} at x = {tension.x:.6g}" if tension.value > 0.0 else "none"
    return {
        "weakest": [_rounded(where) for where in weakest.places],
        "numbers": [
            ["first yield P/(b k) at (x, y)", first],
            [word["stress"].format("largest tension"), tensile],
        ],
    }


PARTS: dict[str, Callable[[Setting, Solution, dict[str, str]], Answer]] = {
    "contact": _contact,
    "stress": _stress,
    "strength": _strength,
}


def _textbook(solution: Solution) -> Answer:
    """The textbook's largest error at its n nodes, over the peak, and what it teaches.

    Only the sentence where its equation is another: several patches, sharp edges, β.
    """
    other = ""
    if len(solution.patches) > 1:
        other = f"has one interval; here are {len(solution.patches)}"
    elif any(solution.sharp):
        other = "has p = 0 at the edges; at a sharp corner p is infinite"
    elif solution.scene.beta != 0.0:
        other = "has no term with β"
    if other:
        return {"lesson": f"No curve for this contact: the textbook's equation {other}."}
    errors = [max(_error(solution, n), 1e-17) for n in NODES]
    return {"n": NODES, "errors": _rounded(errors), "lesson": _lesson(errors)}


def _error(solution: Solution, n: int) -> float:
    lo, hi = solution.edges
    middle, r = (lo + hi) / 2, (hi - lo) / 2
    slope, half_modulus = solution.scene.profile.slope, solution.scene.Estar / 2
    t, p, _ = teaching.solve(
        lambda s: half_modulus * (slope(middle + r * s) + solution.tilt), n, index=-1
    )
    exact = solution.pressure(middle + r * t)
    known = np.isfinite(exact)
    return float(np.abs(p - exact)[known].max() / exact[known].max())


def _lesson(errors: list[float]) -> str:
    for n, error in zip(NODES, errors, strict=True):
        if error < ALL_DIGITS:
            return (
                f"The profile is smooth: {n} nodes give all digits. What is left is rounding, "
                "which grows with n."
            )
    power = -np.polyfit(np.log(NODES), np.log(errors), 1)[0]
    if power < 0.5:
        return "p is infinite under a kink like a tip: more nodes hardly lower the error."
    return (
        f"The profile has a kink: the error falls about like 1/n^{power:.1f}. One more digit takes "
        f"{10 ** (1 / power):.0f} times as many nodes."
    )


def _number(value: float) -> float:
    return float(f"{value:.5g}")


def _rounded(values: Any) -> list[float]:
    return [_number(v) for v in np.asarray(values, dtype=float).tolist()]


def _levels(values: Array) -> list[int | None]:
    return [round(v) if np.isfinite(v) else None for v in values.tolist()]


def saved_answers() -> dict[str, Answer]:
    """The answers of a saved page by the name that its script gives a setting.

    Settings without an answer are left out, and the script leaves them out of its sliders; so are
    those of dissimilar bodies that would make the page large or take long.
    """
    found = {}
    for shape in (ROUNDED, *SHAPES):
        controls = [c for c in SAVED if c.name != "flat" or shape == ROUNDED]
        for values in product(*(control.values for control in controls)):
            names = (control.name for control in controls)
            given: dict[str, Any] = dict(zip(names, values, strict=True))
            setting = Setting(shape=shape, **given)
            slow = bool(setting.bulk or (setting.tilt and shape != "parabola"))
            if not (setting.beta and slow) and _answered(setting):
                found[_name(shape, given)] = {part: answer(setting, part) for part in PARTS}
    return found


def _name(shape: str, given: dict[str, float]) -> str:
    """The name of a setting: its shape and its values, in the order of the controls."""
    return "|".join([shape, *(f"{value:g}" for value in given.values())])
