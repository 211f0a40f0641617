"""The modules above that a method hands its work to, imported when the method is called.

`Scene.to_dict`, `Solution.plot` and their like are written where users look for them, and done by
`sie.io` and `sie.plots`, which import scenes and solutions. `Profile.tilted` and its like make
profiles of `sie.profiles.derived`, which imports `Profile`. No other import points upward.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


def module(name: str) -> Any:
    """The module of this package, such as "io.scene_writing"."""
    return import_module(f"sie.{name}")
