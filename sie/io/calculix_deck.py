"""An input deck of CalculiX for two blocks in contact, with the exact ends of half-planes.

Around the contact all elements (plane strain, CPE4) are dx wide, the half-width over a given
number; beyond it, and downwards, each is GROWTH times as large as the one before, up to REACH
half-widths away. There the outer nodes have the exact displacements of the half-planes, so that the
answer in the blocks tends to that of the half-planes. The load is a result then: contact is a stiff
spring, and gives way by p over its stiffness.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.problem.material import Elastic

Array = NDArray[np.float64]

FINE, GROWTH, REACH = 1.25, 1.1, 4.0  # half-widths with small elements, their growth, the ends
STIFFNESS, STICK = 50.0, 0.03  # of the contact, in E / dx, and of its sticking, in that
PAIRED = 1.4  # half-widths that can touch
NO_FRICTION = 1e-3
INCREMENT = 0.1  # of a step with friction
BEYOND = 1.0  # f P / E* that sliding bodies move beyond incipient sliding


def deck(states: Sequence[Any], per_half_width: int) -> str:
    """The deck that leads through the states of a contact of two bodies, one after the other."""
    last, friction = states[-1], [state.scene.friction for state in states]
    blocks = Blocks.around(last, per_half_width)
    outer = blocks.outer(last.scene.indenter)
    lines = blocks.lines(last.scene.profile)
    for name, (labels, _) in outer.items():
        lines += [f"*NSET,NSET={name}", *map(str, labels)]
    elastic = [body for body in (last.scene.body, last.scene.indenter) if isinstance(body, Elastic)]
    for name, body in (("LOW", elastic[0]), ("HIGH", elastic[-1])):
        lines += [f"*MATERIAL,NAME=OF-{name}", "*ELASTIC", f"{body.young!r}, {body.poisson!r}"]
        lines += [f"*SOLID SECTION,ELSET={name},MATERIAL=OF-{name}", "1."]
    stiffness = STIFFNESS * min(body.young for body in elastic) / blocks.dx
    lines += contact(stiffness, friction[0] or (NO_FRICTION if friction[-1] else 0.0))
    loads = [_exact_ends(state, outer) for state in states]
    return "\n".join([*lines, *steps(loads, friction, stiffness)]) + "\n"


@dataclass(frozen=True)
class Blocks:
    """Two blocks, the upper one with the profile, and the labels of their nodes.

    x, depth    columns of nodes, and their distances from the surface
    low, high   labels of the nodes, shape (depths, columns)
    paired      columns of the elements that can touch
    touching    half the width of the part of the profile that is meshed
    """

    x: Array
    depth: Array
    dx: float
    touching: float

    @classmethod
    def around(
        cls,
        solution: Any,
        per_half_width: int,
        *,
        reach: float = REACH,
        growth: float = GROWTH,
    ) -> Blocks:
        """The blocks for a contact near x = 0, or for one period."""
        period = solution.scene.profile.period
        r = max(map(abs, solution.edges))
        dx, touching = r / per_half_width, PAIRED * r
        if math.isinf(period):
            side, far = _distances(dx, FINE * r, reach * r, growth), reach * r
        else:
            side = np.linspace(0.0, 0.5 * period, math.ceil(0.5 * period / dx) + 1)
            far, touching = period, 0.5 * period
        x = np.concatenate((-side[:0:-1], side))
        return cls(x, _distances(dx, 0.0, far, growth), dx, touching)

    @property
    def labels(self) -> NDArray[np.int64]:
        """Labels of the nodes, of the lower block and of the upper one."""
        size = len(self.depth), len(self.x)
        return np.arange(1, 2 * size[0] * size[1] + 1).reshape(2, *size)

    def lines(self, profile: Any) -> list[str]:
        """Nodes, elements and the surfaces that can touch."""
        low, high = self.labels
        x, depth = self.x, self.depth
        # Beyond what can touch the profile is cut off, so that the block has no slope there.
        height = profile.height(np.clip(x, -self.touching, self.touching))
        lines = ["*NODE,NSET=NALL"]
        for k, d in enumerate(depth):
            lines += _nodes(low[k], x, np.full_like(x, -d))
            lines += _nodes(high[k], x, d + height * (1.0 - d / depth[-1]))
        across = len(x) - 1
        first = (len(depth) - 1) * across + 1
        lines += ["*ELEMENT,TYPE=CPE4,ELSET=LOW", *_elements(1, low[::-1])]
        lines += ["*ELEMENT,TYPE=CPE4,ELSET=HIGH", *_elements(first, high)]
        paired = [k for k in range(across) if abs(x[k] + x[k + 1]) < 2.0 * self.touching]
        lines += ["*SURFACE,NAME=TOP", *(f"{first - across + k}, S3" for k in paired)]
        return [*lines, "*SURFACE,NAME=FOOT", *(f"{first + k}, S1" for k in paired)]

    def outer(self, indenter: Any) -> dict[str, tuple[Any, Array]]:
        """The outer nodes of each block, all of a rigid one: labels, places in the half-plane."""
        ends = {}
        for name, labels, sign in zip(("LOW", "HIGH"), self.labels, (1.0, -1.0), strict=True):
            on = np.ones(labels.shape, dtype=bool)
            on[:-1, 1:-1] = sign < 0.0 and not isinstance(indenter, Elastic)
            places = np.stack(np.broadcast_arrays(self.x, sign * self.depth[:, None]), axis=-1)
            ends[f"OUTER-{name}"] = labels[on], places[on]
        return ends


def _exact_ends(state: Any, outer: dict[str, tuple[Any, Array]]) -> list[str]:
    """The lines that move the outer nodes as those of half-planes."""
    scene, lines = state.scene, []
    for (labels, places), body in zip(outer.values(), ("body", "indenter"), strict=True):
        data = state.boundary_data(places, body=body, labels=labels)
        if body == "indenter" and scene.slides:
            more = BEYOND * scene.slides * scene.friction * state.normal_load / scene.Estar
            data = replace(data, values=data.values | {"u_x": data.values["u_x"] + more})
        lines += [line for line in data.keywords().splitlines() if not line.startswith("**")]
    return lines


def _distances(dx: float, fine: float, far: float, growth: float) -> Array:
    """0, dx, 2 dx, ... up to `fine`, and then in growing steps up to `far`."""
    points = list(dx * np.arange(round(fine / dx) + 1))
    while points[-1] < far:
        points.append(points[-1] + dx)
        dx *= growth
    return np.array(points)


def _nodes(labels: Any, x: Array, y: Array) -> list[str]:
    """Lines of nodes."""
    return [f"{n}, {a:.12g}, {b:.12g}, 0" for n, a, b in zip(labels, x, y, strict=True)]


def _elements(first: int, rows: Any) -> list[str]:
    """The elements between rows of nodes, from below; of a row, from left to right."""
    count = itertools.count(first)
    return [
        f"{next(count)}, {a[k]}, {a[k + 1]}, {b[k + 1]}, {b[k]}"
        for a, b in itertools.pairwise(rows)
        for k in range(len(a) - 1)
    ]


def contact(stiffness: float, friction: float) -> list[str]:
    """The contact of the two surfaces."""
    lines = ["*SURFACE INTERACTION,NAME=PAIR"]
    lines += ["*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.6g}"]
    lines += _friction(friction, stiffness) if friction else []
    return [*lines, "*CONTACT PAIR,INTERACTION=PAIR,TYPE=SURFACE TO SURFACE", "TOP, FOOT"]


def steps(loads: Sequence[list[str]], friction: Sequence[float], stiffness: float) -> list[str]:
    """A step for each state, in increments with friction; bodies press before it acts."""
    output = ["*NODE FILE,OUTPUT=2D,FREQUENCY=1000", "U", "*EL FILE,FREQUENCY=1000", "S"]
    output += ["*CONTACT FILE,FREQUENCY=1000", "CDIS,CSTR", "*END STEP"]
    lines = []
    for load, f, before in zip(loads, friction, [friction[0], *friction], strict=False):
        change = ["*CHANGE FRICTION,INTERACTION=PAIR", *_friction(f, stiffness)] * (f != before)
        times = f"{INCREMENT}, 1., 1e-6, {INCREMENT}" if f else "1., 1."
        lines += ["*STEP,INC=1000", *change, "*STATIC", times, *load, *output]
    return lines


def _friction(f: float, stiffness: float) -> list[str]:
    return ["*FRICTION", f"{f!r}, {STICK * stiffness:.6g}"]
