"""An input deck of CalculiX for a contact of two like blocks, and its run.

    python punch_deck.py scene.toml 20 punch.inp    # 20 elements in the half-width of contact

The blocks stand for half-planes. Around the contact all elements are dx wide, half-width / N;
beyond it, and downwards, each is 1.3 times as large as the one before, up to 60 half-widths away.
The upper block has the profile of the scene, and hangs on a rigid plate that is pushed at the
middle of the contact and may turn. The first step presses without friction: bodies of one material
have no shear there. The second step adds friction and the tangential load.
"""

from __future__ import annotations

import itertools
import subprocess
import sys
from pathlib import Path

import numpy as np

import sie
from sie.io import scene_file

FINE, FAR, GROWTH = 1.25, 60.0, 1.3  # half-widths with small elements, and to the ends of a block
STIFFNESS, STICK = 50.0, 0.03  # of the contact, in E / dx, and of its sticking, in that
PAIRED = 1.4  # half-widths that can touch
NO_FRICTION = 1e-3
INCREMENT = 0.1  # of the tangential load


def deck(scene: sie.Scene, per_half_width: int) -> str:
    """The input deck for a scene of two bodies of one material, centred at x = 0."""
    r = sie.solve(scene).half_width
    dx = r / per_half_width
    side = distances(dx, FINE * r, FAR * r)
    x = np.concatenate((-side[:0:-1], side))
    depth = distances(dx, 0.0, FAR * r)
    paired = [k for k in range(len(x) - 1) if abs(x[k] + x[k + 1]) < 2.0 * PAIRED * r]
    # Beyond what can touch the profile is cut off, so that the block has no slope there.
    height = scene.profile.height(np.clip(x, -PAIRED * r, PAIRED * r))
    low, high = np.arange(2 * len(x) * len(depth)).reshape(2, len(depth), len(x)) + 1
    plate = int(high[-1, -1]) + 1
    lines = ["*NODE,NSET=NALL"]
    for k, d in enumerate(depth):
        lines += nodes(low[k], x, np.full_like(x, -d))
        lines += nodes(high[k], x, d + height * (1.0 - d / depth[-1]))
    lines += [f"{plate}, 0, 0, 0", "*ELEMENT,TYPE=CPE4,ELSET=LOW", *elements(1, low[::-1])]
    first = (len(depth) - 1) * (len(x) - 1) + 1
    lines += ["*ELEMENT,TYPE=CPE4,ELSET=HIGH", *elements(first, high)]
    top = first - (len(x) - 1)
    lines += ["*SURFACE,NAME=TOP", *(f"{top + k}, S3" for k in paired)]
    lines += ["*SURFACE,NAME=FOOT", *(f"{first + k}, S1" for k in paired)]
    lines += ["*NSET,NSET=BASE", *map(str, low[-1])]
    lines += rigid(high[-1], x, float(depth[-1]), plate)
    young, poisson = scene.body.young, scene.body.poisson
    lines += ["*MATERIAL,NAME=BODY", "*ELASTIC", f"{young!r}, {poisson!r}"]
    lines += [f"*SOLID SECTION,ELSET={name},MATERIAL=BODY\n1." for name in ("LOW", "HIGH")]
    return "\n".join([*lines, *contact(scene, STIFFNESS * young / dx, plate)]) + "\n"


def distances(dx: float, fine: float, far: float) -> np.ndarray:
    """0, dx, 2 dx, ... up to `fine`, and then in growing steps up to `far`."""
    points = list(dx * np.arange(round(fine / dx) + 1))
    while points[-1] < far:
        points.append(points[-1] + dx)
        dx *= GROWTH
    return np.array(points)


def nodes(labels, x, y) -> list[str]:
    return [f"{n}, {a:.12g}, {b:.12g}, 0" for n, a, b in zip(labels, x, y, strict=True)]


def elements(first: int, rows: np.ndarray) -> list[str]:
    """The elements between rows of nodes, from below; of a row, from left to right."""
    count = itertools.count(first)
    return [
        f"{next(count)}, {a[k]}, {a[k + 1]}, {b[k + 1]}, {b[k]}"
        for a, b in itertools.pairwise(rows)
        for k in range(len(a) - 1)
    ]


def rigid(labels, x, height: float, plate: int) -> list[str]:
    """The nodes move as one plate, by the freedoms 1, 2 and 3 (a turn) of its node."""
    lines = []
    for n, a in zip(labels, x, strict=True):
        lines += ["*EQUATION", "3", f"{n}, 1, 1., {plate}, 1, -1., {plate}, 3, {height:.12g}"]
        lines += ["*EQUATION", "3", f"{n}, 2, 1., {plate}, 2, -1., {plate}, 3, {-a:.12g}"]
    return lines


def contact(scene: sie.Scene, stiffness: float, plate: int) -> list[str]:
    """The contact, its supports and the steps of load."""
    lines = ["*SURFACE INTERACTION,NAME=PAIR"]
    lines += ["*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.6g}"]
    sliding = f"{STICK * stiffness:.6g}"
    if scene.friction:
        lines += ["*FRICTION", f"{NO_FRICTION}, {sliding}"]
    lines += ["*CONTACT PAIR,INTERACTION=PAIR,TYPE=SURFACE TO SURFACE", "TOP, FOOT"]
    lines += ["*BOUNDARY", "BASE, 1, 2", *([] if scene.friction else [f"{plate}, 1, 1"])]
    push = f"{plate}, 2, {-scene.normal_load!r}"
    output = ["*NODE FILE,OUTPUT=2D,FREQUENCY=1000", "U", "*EL FILE,FREQUENCY=1000", "S"]
    output += ["*CONTACT FILE,FREQUENCY=1000", "CDIS,CSTR", "*END STEP"]
    lines += ["*STEP,INC=100", "*STATIC", "1., 1.", "*CLOAD", push, *output]
    if scene.friction:
        lines += ["*STEP,INC=100", "*CHANGE FRICTION,INTERACTION=PAIR", "*FRICTION"]
        lines += [
            f"{scene.friction!r}, {sliding}",
            "*STATIC",
            f"{INCREMENT}, 1., 1e-6, {INCREMENT}",
        ]
        lines += ["*CLOAD", push, f"{plate}, 1, {scene.tangential_load!r}", *output]
    return lines


def run(deck_file: Path) -> Path:
    """CalculiX' results, the .frd file; its messages go into a .log beside it."""
    with deck_file.with_suffix(".log").open("w") as log:
        command = ["ccx", deck_file.stem]
        subprocess.run(command, cwd=deck_file.parent, stdout=log, stderr=log, check=True)
    return deck_file.with_suffix(".frd")


if __name__ == "__main__":
    scene_name, count, name = sys.argv[1:]
    text = deck(scene_file.read(scene_name).scene, int(count))
    Path(name).write_text(text, encoding="utf-8")
