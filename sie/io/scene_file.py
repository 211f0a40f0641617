"""Scene files: a contact problem as TOML text, read into a `Scene` with the labels of its units.

    title = "..."                     optional, as is  want = ["edges", "check"], what `sie solve` answers without --want
    indenter = "rigid"                optional; the other way is a table [indenter]

    [units]      length = "mm"  force = "N/mm"  stress = "MPa"      labels only: nothing is converted, any consistent set works
    [profile]    kind and its parameters; mirrored, tilted, shifted, applied in this order
                 (a trace: kind = "sampled" with path, a file seen from the scene file's folder, or with x and h)
    [[profile.plus]]                  further terms, each like [profile]: the heights add up, modifiers act on their own term
    [body]       young, poisson, plane = "strain" | "stress"; or rigid = true
    [indenter]   the same; without it the indenter is made of the body's material
    [pair]       modulus = E*, dundurs, poisson: in place of [body] and [indenter]; beside them dundurs = 0 alone, which neglects their β
    [load]       normal_load | half_width, tilt | moment, friction, tangential_load | sliding, bulk_stress;  or, in place of the loads,
                 path = [[P, Q, σ], ...]: turning points, σ may be left out; the scene is that of the last one

`sie example` lists commented files to start from. Whatever does not fit is refused in one sentence, a `SceneFileError`, that names the
file, the table, the value and the remedy; a name that is not known is answered with the nearest that is.

>>> found = parse('''
... profile = { kind = "parabola", radius = 100.0 }
... pair = { modulus = 80e3 }
... load = { normal_load = 50.0 }
... ''')
>>> found.scene.profile, found.units.length
(Parabola(radius=100.0), 'mm')
"""

from __future__ import annotations

import codecs
import pathlib
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

from sie.plan import WANTS
from sie.problem.load_path import Path
from sie.problem.material import RIGID, Body, Elastic
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.sampled import Sampled
from sie.profiles.shapes import profile_kinds

from . import files, toml_values


class SceneFileError(ValueError):
    """A scene file that cannot be read, or that does not make a contact problem."""


@dataclass(frozen=True)
class Units:
    """Labels of the units. They must be consistent, force = stress × length; nothing is converted."""

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
HERE = pathlib.Path()
# A trace of 1e4 points has 0.4 MB as x and h; longer ones are better off in a file of their own.
MOST_BYTES = 10**6
# Each is solved and listed, within seconds together.
MOST_POINTS = 2000
# Names in a dotted key. The time and memory of TOML's reader grow with their square, and a scene needs three.
DEEPEST = 20
# What is not closed ends with the line, or with the file: so each character is looked at once.
_STRING_OR_COMMENT = re.compile(
    r'"{3}(?:\\.|[^\\])*?(?:"{3,5}|\Z)' "|" r"'{3}.*?(?:'{3,5}|\Z)" "|"
    r'"(?:\\.|[^"\\\n])*+"?' "|" r"'[^'\n]*+'?" "|" r"#[^\n]*+", re.DOTALL,
)  # fmt: skip
_DEEP_KEY = re.compile(rf"(?<![\w-])[\w-]++(?:[ \t]*+\.[ \t]*+[\w-]++){{{DEEPEST}}}")


@dataclass(frozen=True)
class SceneFile:
    """What a scene file holds; `want` is empty where the file leaves it to the asker, `reads` are the files that it names."""

    scene: Scene
    title: str = ""
    units: Units = UNITS
    want: tuple[str, ...] = ()
    path: tuple[tuple[float, float, float], ...] = ()
    reads: tuple[pathlib.Path, ...] = field(default=(), compare=False)


# -- reading -----------------------------------------------------------------------------------------------------------


def read(path: str | pathlib.Path) -> SceneFile:
    """The scene in a TOML file. Raises SceneFileError if there is none."""
    path = pathlib.Path(path)
    try:
        if path.is_fifo():
            raise ValueError(
                f"{path} is a pipe: give a file, or send the scene to standard input and give -"
            )
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
    """The scene in a TOML text; `name` is what messages call it, `folder` where the files are that it names. Raises SceneFileError."""
    if len(text) > MOST_BYTES:
        raise SceneFileError(
            f"{name} has more than {MOST_BYTES / 1e6:g} MB: put a trace in a file of its own, as path"
        )
    text = text if isinstance(text, str) else _decoded(text, name)
    try:
        if _DEEP_KEY.search(_STRING_OR_COMMENT.sub("s", text)):
            raise RecursionError
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise SceneFileError(
            f"{name} is not TOML: {problem}; `sie example` prints files that are"
        ) from None
    except ValueError:  # Python's own limit
        raise SceneFileError(
            f"{name} has a number of more than 4300 digits: write it as a float, like 1e-3"
        ) from None
    except RecursionError:
        raise SceneFileError(
            f"{name} is nested too deeply for a scene file: `sie example` prints how one looks"
        ) from None
    try:
        return _scene_file(table, folder)
    except ValueError as problem:
        raise SceneFileError(f"{name}: {toml_values.told(problem)}") from None


def _decoded(data: bytes, name: str) -> str:
    # Windows PowerShell's `>` writes UTF-16, editors there may write a byte-order mark before UTF-8.
    encoding = (
        "utf-16" if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else "utf-8-sig"
    )
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as problem:
        raise SceneFileError(
            f"{name} is not UTF-8 text (byte {problem.start}): save it as UTF-8"
        ) from None


# -- examples ----------------------------------------------------------------------------------------------------------


def example(kind: str) -> str:
    """The commented example of a profile kind, or of a kind of loading, as TOML text.

    Raises ValueError, with the nearest name, for one that is not known.
    """
    if kind not in _examples():
        raise ValueError(
            f'there is no example "{kind}": {toml_values.suggestion(kind, _examples())}'
        )
    return (resources.files("sie.examples") / f"{kind}.toml").read_text(encoding="utf-8")


def examples() -> dict[str, str]:
    """The name of each example and its title."""
    return {kind: parse(example(kind), f"{kind}.toml").title for kind in _examples()}


def _examples() -> tuple[str, ...]:
    return (*profile_kinds(), "partial-slip", "fretting-cycle", "sliding", "dissimilar")


# -- what each table may hold ------------------------------------------------------------------------------------------

_BODY: dict[str, toml_values.Reader] = {
    "young": toml_values.number,
    "poisson": toml_values.number,
    "plane": toml_values.text,
    "rigid": toml_values.flag,
}
_LOAD_KEYS = (
    "normal_load",
    "half_width",
    "tilt",
    "moment",
    "friction",
    "tangential_load",
    "sliding",
    "bulk_stress",
)
_PATH_REPLACES = ("normal_load", "half_width", "tangential_load", "sliding", "bulk_stress")
_TABLES: dict[str, dict[str, toml_values.Reader]] = {
    "units": {"length": toml_values.text, "force": toml_values.text, "stress": toml_values.text},
    "body": _BODY,
    "indenter": _BODY,
    "pair": {
        "modulus": toml_values.number,
        "dundurs": toml_values.number,
        "poisson": toml_values.number,
    },
    "load": dict.fromkeys(_LOAD_KEYS, toml_values.number) | {"path": toml_values.rows},
}
_TOP: tuple[str, ...] = ("title", "want", "profile", *_TABLES)
_MODIFIERS: dict[str, toml_values.Reader] = {
    "mirrored": toml_values.flag,
    "tilted": toml_values.number,
    "shifted": toml_values.number,
}
# Parameters of each profile kind; the optional ones are those of "function" but for its slope.
_PARAMETERS: dict[str, dict[str, toml_values.Reader]] = {
    "parabola": {"radius": toml_values.number},
    "rounded-flat": {"half_flat": toml_values.number, "radius": toml_values.number},
    "flat": {"half_width": toml_values.number},
    "wedge": {"slope": toml_values.number},
    "power": {"exponent": toml_values.number, "coefficient": toml_values.number},
    "polynomial": {"coefficients": toml_values.numbers},
    "piecewise": {"breaks": toml_values.numbers, "pieces": toml_values.rows},
    "function": {
        "slope": toml_values.text,
        "breaks": toml_values.numbers,
        "domain": toml_values.numbers,
        "parity": toml_values.text,
    },
    "sampled": {
        "x": toml_values.numbers,
        "h": toml_values.numbers,
        "smoothing": toml_values.number_or_text,
        "mend": toml_values.flag,
    },
}
_OPTIONAL = {"function": {"breaks", "domain", "parity"}, "sampled": {"smoothing", "mend"}}
# Of kind "sampled" in place of x and h.
_FILE: dict[str, toml_values.Reader] = {
    "path": toml_values.text, "columns": toml_values.columns, "scale": toml_values.number_or_pair, "skip": toml_values.whole,
    "smoothing": toml_values.number_or_text, "mend": toml_values.flag,
}  # fmt: skip


# -- from tables to a scene --------------------------------------------------------------------------------------------


def _scene_file(top: dict[str, Any], folder: pathlib.Path) -> SceneFile:
    for key in top:
        if key not in _TOP:
            raise ValueError(f'there is no key or table "{key}": {_remedy(key, _TOP, "")}')
    for name, content in (
        ("profile", 'kind = "parabola" or another'),
        ("load", "normal_load or half_width"),
    ):
        if name not in top:
            raise ValueError(f"there is no [{name}]: give [{name}] with {content}")
    loads = _taken("load", top["load"])
    path = _path(loads)
    return SceneFile(
        scene=Scene(profile=_profile(top["profile"], folder), **_bodies(top), **loads),
        title=toml_values.text("title", top.get("title", "")),
        units=Units(**_taken("units", top.get("units", {}))),
        want=wants("want", toml_values.texts("want", top.get("want", []))),
        path=path,
        reads=tuple(
            folder / term["path"]
            for term in (top["profile"], *top["profile"].get("plus", ()))
            if "path" in term
        ),
    )


def _path(loads: dict[str, Any]) -> tuple[tuple[float, float, float], ...]:
    """The turning points of [load] path; in `loads` the last of them takes its place."""
    if "path" not in loads:
        return ()
    both = [name for name in _PATH_REPLACES if name in loads]
    if both:
        raise ValueError(
            f"[load] has both path and {both[0]}: path is the loads, as [P, Q] or [P, Q, σ]; leave {both[0]} out"
        )
    if len(loads["path"]) > MOST_POINTS:
        raise ValueError(
            f"[load] path has {len(loads['path'])} points, more than {MOST_POINTS}: follow it in Python, by sie.follow"
        )
    with _Naming("[load]"):
        points = Path(loads.pop("path")).points
    loads |= dict(zip(("normal_load", "tangential_load", "bulk_stress"), points[-1], strict=True))
    return points


def _taken(name: str, value: Any) -> dict[str, Any]:
    """The values of the table [name], none unknown, each of its type."""
    return _values(f"[{name}]", toml_values.table(name, value), _TABLES[name])


def _values(
    where: str, table: Mapping[str, Any], readers: Mapping[str, toml_values.Reader], kind: str = ""
) -> dict[str, Any]:
    for key in table:
        if key not in readers:
            raise ValueError(f'{where}{kind} has no key "{key}": {_remedy(key, readers, where)}')
    return {key: readers[key](f"{where} {key}", value) for key, value in table.items()}


def _required(where: str, values: Mapping[str, Any], names: Iterable[str]) -> None:
    missing = [name for name in names if name not in values]
    if missing:
        raise ValueError(
            f"{where} lacks {' and '.join(missing)}: give {' and '.join(f'{name} = ...' for name in missing)}"
        )


def _profile(value: Any, folder: pathlib.Path) -> Profile:
    first = dict(toml_values.table("profile", value))
    plus = first.pop("plus", [])
    if not isinstance(plus, list) or not all(isinstance(term, dict) for term in plus):
        raise ValueError(
            "profile.plus is not a list of tables: write the header [[profile.plus]], in double brackets, before each term"
        )
    total = _term("[profile]", first, folder)
    for k, term in enumerate(plus, start=1):
        total = total + _term(
            "[[profile.plus]]" if len(plus) == 1 else f"[[profile.plus]] number {k}", term, folder
        )
    return total


def _term(where: str, table: dict[str, Any], folder: pathlib.Path) -> Profile:
    """One term of the profile: its kind, then mirrored, tilted, shifted."""
    kinds = profile_kinds()
    if "kind" not in table:
        meant = next((key for key in table if toml_values.nearest(key, ["kind"])), "")
        raise ValueError(
            f'{where} has no key "{meant}": did you mean "kind"?'
            if meant
            else f"{where} lacks kind: give kind = {toml_values.choices(kinds)}"
        )
    kind = toml_values.text(f"{where} kind", table["kind"])
    if kind not in kinds:
        raise ValueError(
            f'{where} kind = "{kind}" is not known: {toml_values.suggestion(kind, kinds)}'
        )
    measured = kind == "sampled" and not table.keys().isdisjoint(
        _FILE.keys() - _PARAMETERS[kind].keys()
    )
    readers = _FILE if measured else _PARAMETERS[kind]
    values = _values(
        where, table, {"kind": toml_values.text, **readers, **_MODIFIERS}, kind=f' of kind "{kind}"'
    )
    _required(
        f'{where} of kind "{kind}"',
        values,
        ["path"] if measured else (name for name in readers if name not in _OPTIONAL.get(kind, ())),
    )
    given = {name: v for name, v in values.items() if name in readers}
    with _Naming(where):
        profile: Profile = _measured(folder, **given) if measured else kinds[kind](**given)
        profile = profile.mirrored() if values.get("mirrored") else profile
        return profile.tilted(values.get("tilted", 0.0)).shifted(values.get("shifted", 0.0))


def _measured(folder: pathlib.Path, path: str, **options: Any) -> Sampled:
    """A trace in a file, which is named from the scene file's folder."""
    try:
        return Sampled.read(folder / path, **options)
    except OSError as problem:
        why = (
            "there is no such file"
            if isinstance(problem, FileNotFoundError)
            else f"{problem.strerror}"
        )
        raise ValueError(
            f'path = "{toml_values.shortened(path)}" is not read, {why}: give the trace\'s file, from where the scene file is'
        ) from None


def _bodies(top: dict[str, Any]) -> dict[str, Any]:
    """The scene's body and indenter, or modulus, dundurs and poisson."""
    pair = _taken("pair", top.get("pair", {}))
    if "pair" in top and pair.keys() != {"dundurs"}:
        for name in ("body", "indenter"):
            if name in top:
                raise ValueError(
                    f"both [pair] and [{name}] are given: [pair] stands for both bodies, leave one out; or give dundurs = 0 alone in it"
                )
    if "body" not in top:
        if "pair" not in top:
            raise ValueError(
                "there is neither [body] nor [pair]: give [body] with young and poisson, or [pair] with modulus"
            )
        _required("[pair]", pair, ["modulus"])
    return {name: _body(name, top[name]) for name in ("body", "indenter") if name in top} | pair


def _body(name: str, value: Any) -> Body:
    if isinstance(value, str):
        if value != "rigid":
            raise ValueError(
                f'{name} = "{value}" is not known: write {name} = "rigid", or a table [{name}] with young and poisson'
            )
        return RIGID
    values = _taken(name, value)
    if values.pop("rigid", False):
        if values:
            raise ValueError(f"[{name}] is rigid and has {', '.join(values)}: leave one out")
        return RIGID
    _required(f"[{name}]", values, ("young", "poisson"))
    with _Naming(f"[{name}]"):
        return Elastic(**values)


class _Naming:
    """Puts the table in front of what a value's own check says."""

    def __init__(self, where: str) -> None:
        self.where = where

    def __enter__(self) -> None: ...

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: object
    ) -> None:
        if isinstance(problem, ValueError):
            raise ValueError(f"{self.where} {problem}") from None


# -- names that are not known ------------------------------------------------------------------------------------------


def wants(where: str, names: Iterable[str]) -> tuple[str, ...]:
    """The names, if all of them can be asked for; ValueError, with the nearest that can, if not."""
    for name in names:
        if name not in WANTS:
            raise ValueError(
                f'{where} "{name}" is not known: {toml_values.suggestion(name, WANTS)}'
            )
    return tuple(names)


def _remedy(key: str, known: Iterable[str], here: str) -> str:
    """Where a stray key belongs: near a known one, in another table (a header was forgotten), or to another kind of profile."""
    known, of_profile = tuple(known), here.startswith(("[profile]", "[[profile"))
    if here == f"[{key}]" or (of_profile and key == "profile"):
        return toml_values.suggestion(
            {"load": "normal_load", "profile": "kind"}.get(key, key), known
        )
    if here:
        elsewhere = dict.fromkeys(
            ("title", "want"), "it stands at the top of the file, before the first [table]"
        )
        elsewhere |= {
            name: f"it is a table of its own, write the header [{name}] and its keys below it"
            for name in ("profile", *_TABLES)
        }
        elsewhere["plus"] = "terms are not nested, write one [[profile.plus]] after the other"
        if key in elsewhere:
            return elsewhere[key]
    if not toml_values.nearest(key, known):
        homes = [f"[{table}]" for table, readers in _TABLES.items() if key in readers]
        kinds = [
            kind
            for kind, readers in _PARAMETERS.items()
            if key in readers or (kind == "sampled" and key in _FILE)
        ]
        if of_profile and kinds:
            return f"it belongs to kind {toml_values.choices(kinds)}"
        homes += ["[profile]"] if key == "kind" or kinds or key in _MODIFIERS else []
        if homes:
            return f"it belongs in {' or '.join(homes)}"
    return toml_values.suggestion(key, known)
