"""Where the sliders stand, as a scene.

All is relative to a base under the load P₀: one of four indenters on a half-plane with E* = R = 1,
or the scene of a file. Its mean pressure without friction is p̄. The sliders set the load as a
multiple of P₀, the bulk stress as one of p̄, and the tilt as one of the slope p̄/E*. They start from
the values of the file.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

from sie import Scene, Solution, solve
from sie.profiles.shapes import RoundedFlat

from .controls import LIVE, LOAD, OF_FILE, ROUNDED, SHAPES, Control, shapes

KEPT = 16  # solutions at hand: the parts of one answer share one


@dataclass(frozen=True)
class Setting:
    """Where the sliders stand."""

    shape: str = ROUNDED
    flat: float = 0.005
    load: float = 1.0
    tilt: float = 0.0
    friction: float = 0.5
    share: float = 0.6
    bulk: float = 0.0
    beta: float = 0.0
    file: Scene | None = None

    @classmethod
    def of_words(cls, words: Mapping[str, str], file: Scene | None = None) -> Setting:
        """The setting that a query of the page names; what it leaves out keeps its start.

        ValueError for a name or a number that the page does not send.
        """
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
        """The scene that the sliders change: under P₀, no friction and no tilt."""
        if self.shape == OF_FILE and self.file is not None:
            return self.file
        profile = RoundedFlat(self.flat, 1.0) if self.shape == ROUNDED else SHAPES[self.shape]
        return Scene(profile=profile, modulus=1.0, poisson=0.3, normal_load=LOAD)

    @cached_property
    def rest(self) -> Rest:
        """The base without friction, Q and σ."""
        return at_rest(self.base)

    @cached_property
    def untouched(self) -> bool:
        """Whether the scene is that of the file, no slider moved."""
        return self.shape == OF_FILE and self == Setting.of_words({}, self.file)

    @cached_property
    def scene(self) -> Scene:
        """The scene under the sliders."""
        base = self.base
        if self.untouched:
            return base
        rest = self.rest
        P = rest.load * self.load
        changes: dict[str, Any] = {
            "normal_load": P,
            "half_width": None,
            "friction": self.friction,
            "tangential_load": self.friction * self.share * P,
            "bulk_stress": self.bulk * rest.mean_pressure,
            "sliding": 0,
        }
        if self.tilt != rest.tilt:
            changes |= {"moment": None, "tilt": self.tilt * rest.mean_pressure / base.Estar}
        elif base.moment is not None:
            changes["moment"] = base.moment * self.load  # the load keeps its place
        if self.beta != base.beta:
            changes["dundurs"] = self.beta
        return replace(base, **changes)


@lru_cache(maxsize=KEPT)
def solution_of(setting: Setting) -> Solution:
    """The solution of a setting.

    Raises
    ------
    ValueError, ContactError
        As of `sie.solve`.
    """
    scene = setting.scene
    if not (scene.coupled and (scene.tangential_load or scene.bulk_stress)):
        return solve(scene)
    # Dissimilar bodies are pressed once for all Q and σ under the same P.
    pressed = solution_of(replace(setting, share=0.0, bulk=0.0))
    _ = pressed.edges
    return pressed.with_(tangential_load=scene.tangential_load, bulk_stress=scene.bulk_stress)


class Rest(NamedTuple):
    """A contact without shear: its load, its mean pressure p̄, and its tilt over p̄/E*."""

    load: float
    mean_pressure: float
    tilt: float


@lru_cache(maxsize=KEPT)
def at_rest(base: Scene) -> Rest:
    """The contact of a scene without friction, Q and σ."""
    rest = solve(replace(base, friction=0.0, tangential_load=0.0, bulk_stress=0.0, sliding=0))
    mean = rest.normal_load / (2.0 * rest.half_width)
    return Rest(rest.normal_load, mean, rest.tilt * base.Estar / mean)


@lru_cache(maxsize=1)
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
    rest = at_rest(file)
    limit = file.friction * rest.load
    start = {
        "tilt": rest.tilt,
        "friction": file.friction,
        "share": float(file.sliding or (file.tangential_load / limit if limit else 0.0)),
        "bulk": file.bulk_stress / rest.mean_pressure,
        "beta": file.beta,
    }
    known = {"beta": (0.0,)} if file.body is not None else {}  # two bodies have a β of their own
    return tuple(
        replace(c, values=known.get(c.name, c.values)).starting(start.get(c.name, c.start))
        for c in LIVE
    )
