"""An input deck of CalculiX for a contact of two like blocks that stand for half-planes, and its
run.

    python punch_deck.py scene.toml 20 punch.inp            # 20 elements in the half-width
    python punch_deck.py scene.toml 20 punch.inp exact      # blocks of 4 half-widths, exact ends

Without `exact` the blocks reach 60 half-widths away, and the upper one hangs on a rigid plate that
is pushed at the middle of the contact and may turn. The first step presses without friction: bodies
of one material have no shear there. The second step adds friction and the tangential load.
"""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from pathlib import Path

import sie
from sie.io import calculix_deck, scene_file
from sie.io.calculix_deck import NO_FRICTION, STIFFNESS, Blocks

FAR, GROWTH = 60.0, 1.3  # half-widths to the ends of a block, and the growth of its elements


def deck(scene: sie.Scene, per_half_width: int, *, exact: bool = False) -> str:
    """The input deck for a scene of two bodies of one material, centred at x = 0."""
    if exact:
        pressed = dataclasses.replace(scene, friction=0.0, tangential_load=0.0)
        scenes = (pressed, scene) if scene.friction else (pressed,)
        return calculix_deck.deck([sie.solve(s) for s in scenes], per_half_width)
    blocks = Blocks.around(sie.solve(scene), per_half_width, reach=FAR, growth=GROWTH)
    low, high = blocks.labels
    plate = int(high[-1, -1]) + 1
    lines = blocks.lines(scene.profile)
    lines.insert(1, f"{plate}, 0, 0, 0")
    young, poisson = scene.body.young, scene.body.poisson
    lines += ["*MATERIAL,NAME=BODY", "*ELASTIC", f"{young!r}, {poisson!r}"]
    lines += [f"*SOLID SECTION,ELSET={name},MATERIAL=BODY\n1." for name in ("LOW", "HIGH")]
    stiffness = STIFFNESS * young / blocks.dx
    lines += calculix_deck.contact(stiffness, NO_FRICTION if scene.friction else 0.0)
    lines += rigid(high[-1], blocks.x, float(blocks.depth[-1]), plate)
    lines += ["*BOUNDARY", *(f"{n}, 1, 2" for n in low[-1])]
    lines += [] if scene.friction else [f"{plate}, 1, 1"]
    push = ["*CLOAD", f"{plate}, 2, {-scene.normal_load!r}"]
    loads = [push, [*push, f"{plate}, 1, {scene.tangential_load!r}"]]
    friction = [0.0, scene.friction]
    count = 2 if scene.friction else 1
    return "\n".join([*lines, *calculix_deck.steps(loads[:count], friction[:count], stiffness)])


def rigid(labels, x, height: float, plate: int) -> list[str]:
    """The nodes move as one plate, by the freedoms 1, 2 and 3 (a turn) of its node."""
    lines = []
    for n, a in zip(labels, x, strict=True):
        lines += ["*EQUATION", "3", f"{n}, 1, 1., {plate}, 1, -1., {plate}, 3, {height:.12g}"]
        lines += ["*EQUATION", "3", f"{n}, 2, 1., {plate}, 2, -1., {plate}, 3, {-a:.12g}"]
    return lines


def run(deck_file: Path) -> Path:
    """CalculiX' results, the .frd file; its messages go into a .log beside it."""
    with deck_file.with_suffix(".log").open("w") as log:
        command = ["ccx", deck_file.stem]
        subprocess.run(command, cwd=deck_file.parent, stdout=log, stderr=log, check=True)
    return deck_file.with_suffix(".frd")


if __name__ == "__main__":
    scene_name, count, name, *exact = sys.argv[1:]
    text = deck(scene_file.read(scene_name).scene, int(count), exact=exact == ["exact"])
    Path(name).write_text(text + "\n", encoding="utf-8")
