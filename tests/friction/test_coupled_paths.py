"""Load paths of dissimilar bodies."""

from __future__ import annotations

from dataclasses import replace

import pytest
from scenes import dissimilar

import sie


def scene(profile=None, beta=0.3, friction=0.3, load=1.0):
    return dissimilar(profile, beta, friction, normal_load=load)


@pytest.mark.parametrize(
    "points",
    [
        [(1.0, 0.1), (2.0, 0.1)],
        [(1.0, 0.0), (2.0, 0.1), (1.0, 0.1)],
        [(0.0, 0.0), (1.0, 0.1), (2.0, 0.1)],
        [(0.0, 0.0), (1.0, 0.1), (0.5, 0.05)],
    ],
)
def test_other_paths_of_dissimilar_bodies_are_refused(points):
    with pytest.raises(sie.ContactError, match="hold P at its mean") as caught:
        sie.follow(scene(), sie.Path(points))
    assert len(str(caught.value).split()) <= 40


def test_the_beginning_of_the_path_has_no_contact():
    history = sie.follow(scene(), sie.Path([(0.0, 0.0), (1.0, 0.0)]))
    with pytest.raises(sie.ContactError, match="P = 0"):
        _ = history[0].edges


@pytest.mark.slow
def test_points_where_the_normal_load_grows_and_then_the_tangential_one_are_those_of_scenes():
    path = sie.Path([(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, -0.15), (1.0, -0.2)])
    history = sie.follow(scene(), path)
    assert [row["energy_lost"] for row in history.rows()] == sorted(
        row["energy_lost"] for row in history.rows()
    )
    for point, (P, Q, _) in list(zip(history, path.points, strict=True))[1:]:
        alone = sie.solve(replace(scene(load=P), tangential_load=Q))
        assert point.edges == pytest.approx(alone.edges, rel=1e-12)
        assert point.stick[0] == pytest.approx(alone.stick[0], rel=1e-11)
        assert point.slip(0.3) == pytest.approx(float(alone.slip(0.3)), rel=1e-9, abs=1e-15)
        assert point.shear.resultant == Q and point.check().ok


def test_a_path_of_scenes_is_refused_before_any_work_where_all_slides():
    with pytest.raises(sie.LoadError, match="bodies slide"):
        sie.follow(scene(), sie.Path([(1.0, 0.0), (1.0, 0.1), (1.0, 0.4)]))
