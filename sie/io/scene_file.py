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
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

from sie import files
from sie.arguments import suggestion, with_short_words
from sie.problem.load_path import Path
from sie.problem.scene import Scene
from sie.profiles.kinds import KINDS

from .beside_scene import UNITS, Crack, Fatigue, Units
from .path_table import path_of
from .profile_tables import Files
from .scene_keys import LOADS, naming, values_of
from .scene_tables import beside_problem, indenter_and_bodies, refuse_no_question


class SceneFileError(ValueError):
    """A scene file that cannot be read, or that does not make a contact problem."""


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
    refuse_no_question(top)
    said = beside_problem(top)
    beside = Files(folder, said["units"].length)
    path, loads = _loads(top, beside)
    scene = Scene(**indenter_and_bodies(top, beside), **loads)
    return SceneFile(scene, load_path=path, reads=tuple(beside.read), **said)


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
