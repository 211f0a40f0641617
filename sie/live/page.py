"""The page as one HTML text: served with Bokeh's script beside it, or saved with all inside."""

from __future__ import annotations

import base64
import gzip
import json
from importlib import resources
from pathlib import Path
from typing import Any

from sie.problem.scene import Scene

from .controls import LIVE, SAVED, Control, shapes
from .figures import items

SERVED = (
    "Move a slider: each picture is solved anew on this machine. "
    "Lengths are in radii R and stresses in E*, or in the units of the scene file."
)
KEPT = (
    "Move a slider: the answers for its steps are kept in this page. "
    "Lengths are in radii R, stresses in E*. `sie live` solves everything between."
)


def served(file: Scene | None, sliders: tuple[Control, ...] = LIVE) -> str:
    """The page that asks a server for its answers and for bokeh.js."""
    return _filled(_about(sliders, file), SERVED, '<script src="bokeh.js"></script>')


def saved(answers: dict[str, Any]) -> str:
    """The page with its answers and Bokeh's script inside, which needs no server."""
    about = {**_about(SAVED), "packed": True}
    packed = {"bokeh-script": bokeh_script(), "answers": _json(answers).encode()}
    return _filled(
        about,
        KEPT,
        "\n".join(
            f'<script type="text/plain" id="{name}">{_packed(content)}</script>'
            for name, content in packed.items()
        ),
    )


def bokeh_script() -> bytes:
    """BokehJS, as the installed Bokeh brings it."""
    # Imported here, for only this page needs it.
    from bokeh.settings import settings  # noqa: PLC0415

    return Path(settings.bokehjs_path(), "js", "bokeh.min.js").read_bytes()


def _about(controls: tuple[Control, ...], file: Scene | None = None) -> dict[str, Any]:
    """What the page's script has to know."""
    return {
        "controls": [vars(control) for control in controls],
        "shapes": shapes(file),
        "items": items(),
    }


def _filled(about: dict[str, Any], sentence: str, bokeh: str) -> str:
    page = _part("page.html")
    # The script's own "</script>" would end it.
    for name, text in (
        ("css", _part("page.css")),
        ("about", sentence.replace("`sie live`", "<code>sie live</code>")),
        ("script", _part("page.js")),
        ("page", _json(about).replace("</", "<\\/")),
        ("bokeh", bokeh),
    ):
        page = page.replace("{{" + name + "}}", text)
    return page


def _part(name: str) -> str:
    return resources.files("sie.live").joinpath(name).read_text(encoding="utf-8")


def _packed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"))
