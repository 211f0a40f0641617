"""Scene files: a contact problem as TOML text, read into a `Scene` with the labels of its units.

    title = "..."       optional
    want = ["edges"]    optional: what `sie solve` answers without --want
    indenter = "rigid"  optional; the other way is a table [indenter]

    [units]             length = "mm"  force = "N/mm"  stress = "MPa": labels of the consistent
                        units of all numbers
    [profile]           kind and its parameters; mirrored, tilted, shifted, raised, applied in this
                        order; period repeats it; of kind "sampled" x and h, or path, a file beside
                        the scene file, with units (those in its head are used without it) and
                        heights = "gap" | "surface"; without_outliers = true,
                        levelled = true | [lo, hi]
    [[profile.of]]      of kind "row": each indenter on the common holder, like [profile]
    [[profile.plus]]    further terms, each like [profile]: the heights add up, and modifiers act
                        on their own term
    [body]              young, poisson, plane = "strain" | "stress"; or rigid = true
    [indenter]          the same; without it the indenter is made of the body's material
    [pair]              modulus = E*, dundurs, poisson, in place of [body] and [indenter]; beside
                        them dundurs = 0, which neglects their β; coupling = "goodman", which
                        leaves β q out of the normal equation
    [load]              normal_load | half_width, tilt | moment, friction,
                        tangential_load | sliding, bulk_stress; or, in place of the loads,
                        path = [[P, Q, σ], ...], turning points, σ may be left out, or a file,
                        "cycle.csv"; columns = ["P", "Q", "sigma", "tilt"] says what the numbers of
                        each row are (`path_table`); the scene is that of the last point
    [fatigue]           findley_k, shear_limit, fatemi_socie_k, yield_stress, depth, parts: for the
                        fatigue parameters of a path that closes (`Fatigue`)
    [crack]             at = "trailing edge" | "leading edge" | x, depths, threshold, fatigue_limit:
                        cracks normal to the surface (`Crack`)

`sie example` lists commented files to start from. A mistake is refused in one sentence, a
`SceneFileError`, that names the file, the table, the value and the remedy; a name that is not known
is answered with the nearest that is.

>>> file = parse('''
... profile = { kind = "parabola", radius = 100.0 }
... pair = { modulus = 80e3 }
... load = { normal_load = 50.0 }
... ''')
>>> file.scene.profile, file.units.length
(Parabola(radius=100.0), 'mm')
"""

from __future__ import annotations

import codecs
import pathlib
import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

from sie import files
from sie.arguments import suggestion, with_short_words
from sie.problem.load_path import Path
from sie.problem.material import RIGID, Body, Elastic
from sie.problem.request import WANTS
from sie.problem.scene import Scene
from sie.profiles.kinds import KINDS

from .path_table import path_of
from .profile_tables import Files, profile_of
from .scene_keys import LOADS, TOP, naming, remedy, require, values_of
from .toml_values import TEXT, TEXTS


class SceneFileError(ValueError):
    """A scene file that cannot be read, or that does not make a contact problem."""


@dataclass(frozen=True)
class Units:
    """Labels of consistent units, force = stress × length."""

    length: str = "mm"
    force: str = "N/mm"
    stress: str = "MPa"

    @property
    def moment(self) -> str:
        """The unit of ∫p x dx: N/mm times mm is N.

        >>> Units().moment, Units(force="kN").moment
        ('N', 'kN mm')
        """
        per_length = "/" + self.length
        return (
            self.force.removesuffix(per_length)
            if self.force.endswith(per_length)
            else f"{self.force} {self.length}"
        )


UNITS = Units()
PARTS, MOST_PARTS = 4, 100


@dataclass(frozen=True)
class Fatigue:
    """The content of [fatigue]; 0 stands for a constant that is not given.

    Parameters
    ----------
    findley_k : float
        Weight of the normal stress in Findley's parameter.
    shear_limit : float
        What Findley's parameter may reach, in units of stress.
    fatemi_socie_k : float
        Weight of the normal stress in the parameter of Fatemi and Socie.
    yield_stress : float
        σ_y in the parameter of Fatemi and Socie.
    depth : float or list of float
        Where parameters are given beside the surface; without it 1 % and 10 % of the largest
        half-width.
    parts : int
        At how many states each step of the cycle is examined, 4 if it is not given.
    """

    findley_k: float = 0.0
    shear_limit: float = 0.0
    fatemi_socie_k: float = 0.0
    yield_stress: float = 0.0
    depth: float | tuple[float, ...] = ()
    parts: int = PARTS

    def __post_init__(self) -> None:
        if not 1 <= self.parts <= MOST_PARTS:
            raise ValueError(
                f"[fatigue] parts = {self.parts} is not a number from 1 to {MOST_PARTS}"
            )


@dataclass(frozen=True)
class Crack:
    """The content of [crack].

    Parameters
    ----------
    at : str or float
        Where the cracks begin: "trailing edge" or "leading edge" of the contact under the largest
        tangential load, or x.
    depths : list of float
        Depths of their tips, ascending.
    threshold : float
        ΔK0 of long cracks, stress times root of length.
    fatigue_limit : float
        Δσ0 of the smooth material, a range of stress.
    friction : float
        Friction between the faces of a crack: only 0.
    """

    at: str | float
    depths: tuple[float, ...]
    threshold: float = 0.0
    fatigue_limit: float = 0.0
    friction: float = 0.0


EXAMPLES = resources.files("sie.examples")
HERE = pathlib.Path()
# A trace of 1e4 points has 0.4 MB as x and h; longer ones belong in a file of their own.
MOST_BYTES = 10**6
# The time and memory of TOML's reader grow with the square of the names in a dotted key; a scene
# needs three.
_DEEP_KEY = re.compile(r"(?<![\w-])(?:[\w-]++[ \t]*+\.[ \t]*+){20}")


@dataclass(frozen=True)
class SceneFile:
    """The content of a scene file.

    scene        the contact problem; of a path that of its last point, without what the path adds
                 to its tilt or moment
    title        one line of text
    units        labels
    want         the quantities to be answered, empty if the file names none
    load_path    the load path, None without one
    fatigue      constants of the material for fatigue parameters
    crack        cracks normal to the surface, None without any
    reads        the files that it names
    """

    scene: Scene
    title: str = ""
    units: Units = UNITS
    want: tuple[str, ...] = ()
    load_path: Path | None = None
    fatigue: Fatigue = field(default_factory=Fatigue)
    crack: Crack | None = None
    reads: tuple[pathlib.Path, ...] = field(default=(), compare=False)


# -- reading -------------------------------------------------------------------------------------


def read(path: str | pathlib.Path) -> SceneFile:
    """The scene in a TOML file. Raises SceneFileError if there is none."""
    name = path
    path = pathlib.Path(name)
    try:
        files.named(name)
        data = files.content(path, MOST_BYTES)
    except ValueError as problem:
        raise SceneFileError(str(problem)) from None
    except FileNotFoundError:
        raise SceneFileError(
            f"{path} does not exist: write one with  sie example rounded-flat > {path.name}"
        ) from None
    except OSError as problem:
        raise SceneFileError(
            f"{path} cannot be read ({problem.strerror}): give a readable scene file"
        ) from None
    return parse(data, path.name, path.parent)


def parse(text: str | bytes, name: str = "scene", folder: pathlib.Path = HERE) -> SceneFile:
    """The scene in a TOML text. Raises SceneFileError.

    `name` stands for the text in messages; files that it names are read from `folder`.
    """
    if len(text) > MOST_BYTES:
        raise SceneFileError(
            f"{name} has more than {MOST_BYTES / 1e6:g} MB: "
            "put a trace in a file of its own, as path"
        )
    text = text if isinstance(text, str) else _decoded(text, name)
    try:
        if _DEEP_KEY.search(text):
            raise RecursionError
        table = tomllib.loads(text)
    except ValueError as problem:  # also of Python, for a number of more than 4300 digits
        raise SceneFileError(
            f"{name} is not TOML: {problem}; `sie example` prints files that are"
        ) from None
    except RecursionError:
        raise SceneFileError(
            f"{name} is nested too deeply for a scene file: `sie example` prints how one looks"
        ) from None
    try:
        return from_tables(table, folder)
    except ValueError as problem:
        raise SceneFileError(f"{name}: {with_short_words(problem)}") from None


def _decoded(data: bytes, name: str) -> str:
    # Windows PowerShell's `>` writes UTF-16, editors there may write a byte-order mark before
    # UTF-8.
    encoding = (
        "utf-16" if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else "utf-8-sig"
    )
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as problem:
        raise SceneFileError(
            f"{name} is not UTF-8 text (byte {problem.start}): save it as UTF-8"
        ) from None


# -- examples ------------------------------------------------------------------------------------


def example(name: str) -> str:
    """The commented example of a kind of profile or of loading, as TOML text.

    Raises ValueError, with the nearest name, for one that is not known.
    """
    known = example_names()
    if name not in known:
        raise ValueError(f'there is no example "{name}": {suggestion(name, known)}')
    return (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8")


def examples() -> dict[str, str]:
    """The name of each example and its title."""
    return {name: parse(example(name), f"{name}.toml").title for name in example_names()}


def example_names() -> tuple[str, ...]:
    """The kinds of profile, then the kinds of loading."""
    stems = {file.name.removesuffix(".toml") for file in EXAMPLES.iterdir()}
    return (*KINDS, *sorted(stems - KINDS.keys()))


# -- from tables to a scene ----------------------------------------------------------------------


def from_tables(top: dict[str, Any], folder: pathlib.Path = HERE) -> SceneFile:
    """The scene in tables that TOML or JSON was read into. Raises ValueError.

    Files that they name are read from `folder`.
    """
    for key in top:
        if key not in TOP:
            raise ValueError(f'there is no key or table "{key}": {remedy(key, TOP, "")}')
    for name, content in (
        ("profile", 'kind = "parabola" or another'),
        ("load", "normal_load or half_width"),
    ):
        if name not in top:
            raise ValueError(f"there is no [{name}]: give [{name}] with {content}")
    units = Units(**values_of("units", top))
    beside = Files(folder, units.length)
    path, loads = _loads(top, beside)
    profile, bodies = profile_of(top["profile"], beside), _bodies(top)
    fatigue, crack = Fatigue(**values_of("fatigue", top)), values_of("crack", top)
    return SceneFile(
        scene=Scene(profile=profile, **bodies, **loads),
        title=TEXT.read("title", top.get("title", "")),
        units=units,
        want=wants("want", TEXTS.read("want", top.get("want", []))),
        load_path=path,
        fatigue=fatigue,
        crack=Crack(**crack) if crack else None,
        reads=tuple(beside.read),
    )


def _loads(top: dict[str, Any], beside: Files) -> tuple[Path | None, dict[str, Any]]:
    """The path of [load], and the loads, which are those of its last point."""
    loads = values_of("load", top)
    columns = loads.pop("columns", None)
    if "path" not in loads:
        return None, loads
    both = next((name for name in LOADS if name in loads), "")
    if both:
        raise ValueError(
            f"[load] has both path and {both}: path is the loads, as [P, Q] or [P, Q, σ]; "
            f"leave {both} out"
        )
    with naming("[load]"):
        path = path_of(loads.pop("path"), columns, beside)
    last = zip(("normal_load", "tangential_load", "bulk_stress"), path.points[-1], strict=True)
    return path, loads | dict(last)


def _bodies(top: dict[str, Any]) -> dict[str, Any]:
    """The scene's body and indenter, or modulus, dundurs and poisson."""
    pair = values_of("pair", top)
    named = [name for name in ("body", "indenter") if name in top]
    if "pair" in top and named and not pair.keys() <= {"dundurs", "coupling"}:
        raise ValueError(
            f"both [pair] and [{named[0]}] are given: [pair] stands for both bodies, leave one "
            "out; or give dundurs = 0 or coupling alone in it"
        )
    if "body" not in top:
        if "pair" not in top:
            raise ValueError(
                "there is neither [body] nor [pair]: "
                "give [body] with young and poisson, or [pair] with modulus"
            )
        require("[pair]", pair, ["modulus"])
    return {name: _body(name, top) for name in named} | pair


def _body(name: str, top: dict[str, Any]) -> Body:
    if isinstance(top[name], str):
        if top[name] != "rigid":
            raise ValueError(
                f'{name} = "{top[name]}" is not known: '
                f'write {name} = "rigid", or a table [{name}] with young and poisson'
            )
        return RIGID
    values = values_of(name, top)
    if values.pop("rigid", False):
        if values:
            raise ValueError(f"[{name}] is rigid and has {', '.join(values)}: leave one out")
        return RIGID
    require(f"[{name}]", values, ("young", "poisson"))
    with naming(f"[{name}]"):
        return Elastic(**values)


# -- names that are not known --------------------------------------------------------------------


def wants(where: str, names: Iterable[str]) -> tuple[str, ...]:
    """The names, if all of them can be asked for. ValueError, with the nearest name, if not."""
    for name in names:
        if name not in WANTS:
            raise ValueError(f'{where} "{name}" is not known: {suggestion(name, WANTS)}')
    return tuple(names)
