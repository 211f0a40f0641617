"""Scripts by which shells complete the commands, options, names and files of `sie`."""

from __future__ import annotations

import argparse
from typing import Any

from sie.arguments import suggestion
from sie.io.scene_file import example_names
from sie.problem.request import WANTS

from .parser import parser

FILES = ("scene", "mesh", "nodes", "plot", "csv", "json", "field")


def script(shell: str) -> str:
    """The script of shtab for a shell. ValueError without shtab, or for a shell it lacks."""
    try:
        import shtab  # an extra
    except ImportError:
        raise ValueError('completion needs shtab: pip install "plane-contact[cli]"') from None
    if shell not in shtab.SUPPORTED_SHELLS:
        known = suggestion(shell, shtab.SUPPORTED_SHELLS)
        raise ValueError(f'there is no completion for "{shell}": {known}')
    whole = parser()
    for action in _actions(whole):
        if action.dest in FILES:
            vars(action)["complete"] = shtab.FILE
        elif action.dest == "folder":
            vars(action)["complete"] = shtab.DIRECTORY
        elif action.dest == "want":
            action.choices = WANTS
        elif action.dest == "name":
            action.choices = example_names()
        elif action.dest == "shell":
            action.choices = shtab.SUPPORTED_SHELLS
    return str(shtab.complete(whole, shell))


def _actions(whole: argparse.ArgumentParser) -> list[Any]:
    """The options and arguments of all commands."""
    found: list[Any] = []
    for action in whole._actions:  # argparse has no public name for them
        found.append(action)
        if isinstance(action, argparse._SubParsersAction):
            found += [inner for command in action.choices.values() for inner in _actions(command)]
    return found
