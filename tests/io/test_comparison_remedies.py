"""Every remedy that a refused comparison offers is followed: the mesh result is then compared, and
agrees with the exact answer that it was made of.
"""

import json
from pathlib import Path

import numpy as np
import pytest

import sie
from sie.cli import main

SCENE = """[profile]
kind = "rounded-flat"
half_flat = 0.5
radius = 4.0
[pair]
modulus = 10.0
[load]
normal_load = 1.0
"""
SOLUTION = sie.solve(sie.Scene(profile=sie.RoundedFlat(0.5, 4.0), modulus=10.0, normal_load=1.0))
X = np.linspace(*SOLUTION.edges, 41)[1:-1]
P = SOLUTION.pressure(X)


def written(x=X, p=P, header="x,p", **columns):
    rows = np.column_stack([x, *columns.values(), p])
    lines = [header, *(",".join(map(repr, row)) for row in rows.tolist())]
    return "\n".join(lines) + "\n"


HALVES = np.concatenate((np.zeros(len(X)), np.full(len(X), -0.1), np.full(len(X), 0.1)))
BOTH_SIDES = written(np.tile(X, 3), np.tile(P, 3), "x,y,p", y=HALVES)
ONE_SIDE = written(np.tile(X, 2), np.tile(P, 2), "x,y,p", y=HALVES[: 2 * len(X)])
# What is refused, what the refusal offers, and the file in which that was done.
REFUSED = {
    "a header without a quantity": (
        written(header="x,result"), "say which hold x and p or q", written()
    ),
    "a header that nearly has one": (
        written(header="x,presure"), 'is "presure" meant as "pressure"?',
        written(header="x,pressure"),
    ),
    "a mark for what is missing": (
        written(p=np.where(X[5] == X, 1e300, P)), "delete such lines",
        written(np.delete(X, 5), np.delete(P, 5)),
    ),
    "points on both sides": (BOTH_SIDES, "leave the other out", ONE_SIDE),
    "one point": (written(X[:1], P[:1]), "needs at least two", written(X[:2], P[:2])),
    "no point on the surface": (
        written(header="x,y,p", y=np.linspace(0.2, 0.3, len(X))), "on the surface, y = 0",
        written(header="x,y,p", y=np.zeros(len(X))),
    ),
    "another unit of length": (written(1000.0 * X + 5.0), "the units of length", written()),
}  # fmt: skip


def compared(text):
    Path("mesh.csv").write_text(text)
    return main(["compare", "scene.toml", "mesh.csv", "--json", "found.json"])


@pytest.mark.parametrize("case", REFUSED)
def test_what_a_refused_comparison_offers_is_answered(case, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(SCENE)
    refused, remedy, followed = REFUSED[case]
    assert compared(refused) == 2
    assert remedy in capsys.readouterr().err
    assert not Path("found.json").exists()
    assert compared(followed) == 0
    assert json.loads(Path("found.json").read_text())["differences"]["p"]["l2"] <= 1e-12
