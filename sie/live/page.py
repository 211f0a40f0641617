"""The page as one HTML text: served with Bokeh's script beside it, or saved with all inside."""

from __future__ import annotations

import base64
import gzip
import json
from importlib import resources
from pathlib import Path
from typing import Any

from bokeh.settings import settings

from sie.problem.scene import Scene

from .figures import items
from .setting import ACROSS, DEPTH, DOWN, LIVE, SAVED, Control, shapes

SERVED = "Each answer is solved anew on this machine. "
KEPT = (
    "The answers for the sliders' steps are kept in this page; <code>sie live</code> solves "
    "everything between. "
)
UNITS = 'lengths are in radii R, stresses in E*: see <a href="#letters">the symbols</a>.'
IN_RADII = f"Here {UNITS}"
OF_A_FILE = f"The first punch is that of the scene file, in its units; for the others, {UNITS}"
HOME = '<nav><a href="index.html">Home: what this package computes</a></nav>'
LOADS = "10⁻⁴ E* R"


def served(file: Scene | None, sliders: tuple[Control, ...] = LIVE) -> str:
    """The page that asks a server for its answers and for bokeh.js."""
    about = SERVED + (IN_RADII if file is None else OF_A_FILE)
    load = LOADS if file is None else f"{LOADS}, or the load of the scene file"
    return _filled(
        _about(sliders, file),
        {"about": about, "load": load, "home": "", "bokeh": '<script src="bokeh.js"></script>'},
    )


def saved(answers: dict[str, Any]) -> str:
    """The page with its answers and Bokeh's script inside, which needs no server."""
    about = {**_about(SAVED), "packed": True}
    packed = {"bokeh-script": bokeh_script(), "answers": _json(answers).encode()}
    scripts = "\n".join(
        f'<script type="text/plain" id="{name}">{_packed(content)}</script>'
        for name, content in packed.items()
    )
    return _filled(about, {"about": KEPT + IN_RADII, "load": LOADS, "home": HOME, "bokeh": scripts})


def bokeh_script() -> bytes:
    """BokehJS, as the installed Bokeh brings it."""
    return Path(settings.bokehjs_path(), "js", "bokeh.min.js").read_bytes()


def _about(controls: tuple[Control, ...], file: Scene | None = None) -> dict[str, Any]:
    """What the page's script has to know."""
    return {
        "controls": [vars(control) for control in controls],
        "shapes": shapes(file),
        "items": items(),
        "across": ACROSS,
        "down": DOWN,
        "depth": DEPTH,
    }


def _filled(about: dict[str, Any], texts: dict[str, str]) -> str:
    page = _part("page.html")
    texts = {
        "css": _part("page.css"),
        "script": _part("page.js"),
        # The script's own "</script>" would end it.
        "page": _json(about).replace("</", "<\\/"),
        **texts,
    }
    for name, text in texts.items():
        page = page.replace("{{" + name + "}}", text)
    return page


def _part(name: str) -> str:
    return resources.files("sie.live").joinpath(name).read_text(encoding="utf-8")


def _packed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"))
