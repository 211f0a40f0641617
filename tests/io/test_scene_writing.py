"""A scene is written as the tables of a scene file, as JSON and as TOML, and reads back equal."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import between, chains, parabolas, polynomials, powers, rounded_flats, texts, wedges

import sie
from sie.io.export import strict_json
from sie.io.scene_file import from_tables
from sie.io.scene_schema import schema

SCHEMA = pytest.importorskip("jsonschema").Draft7Validator(schema())

flats = st.builds(sie.Flat, half_width=between(0.5, 3.0))
traces = st.builds(
    lambda n, rise, smoothing: sie.Sampled(
        np.linspace(-1.0, 1.0, n), rise * np.linspace(-1.0, 1.0, n) ** 2, smoothing
    ),
    st.integers(9, 30), between(0.1, 1.0), st.sampled_from([0.0, 1e-9, "gcv"]),
)  # fmt: skip

kinds = st.one_of(
    parabolas, rounded_flats, wedges, powers, polynomials, chains(), texts, flats, traces
)


@st.composite
def terms(draw, kinds=kinds):
    """A profile of a kind, moved as a scene file moves it."""
    profile = draw(kinds)
    profile = profile.mirrored() if draw(st.booleans()) else profile
    for move in ("tilted", "shifted", "raised"):
        profile = getattr(profile, move)(draw(st.one_of(st.just(0.0), between(-0.1, 0.1))))
    return profile


@st.composite
def nameable(draw):
    """Any profile that a scene file can name."""
    form = draw(st.sampled_from(["term", "sum", "row", "wave"]))
    if form == "row":
        indenters = st.lists(
            terms(st.one_of(parabolas, rounded_flats, chains(), flats)), max_size=2
        )
        return sie.Row([sie.Wedge(0.5), *draw(indenters)]).shifted(0.5)
    profile = draw(terms())
    if form == "sum":
        for term in draw(st.lists(terms(), min_size=1, max_size=2)):
            profile = profile + term
    return sie.Periodic(draw(parabolas).shifted(0.25), 4.0) if form == "wave" else profile


bodies = st.one_of(
    st.just({"body": sie.Elastic(2.1e5, 0.3), "indenter": sie.RIGID}),
    st.just({"body": sie.RIGID, "indenter": sie.Elastic(1.1e5, 0.34, plane="stress")}),
    st.just({"body": sie.Elastic(70.0, 0.1), "indenter": sie.Elastic(7.0, 0.5), "dundurs": 0.0}),
    st.just({"modulus": 3.5, "dundurs": -0.1, "poisson": 0.2, "coupling": "goodman"}),
    st.builds(lambda E: {"modulus": E}, between(0.1, 10.0)),
)
loads = st.one_of(
    st.builds(lambda P: {"normal_load": P}, between(0.1, 10.0)),
    st.just({"half_width": 0.125, "tilt": -1e-3}),
    st.just({"normal_load": 1e-9, "moment": -3.0, "friction": 0.3, "tangential_load": 1e-10}),
    st.just({"normal_load": 2.0, "friction": 0.3, "sliding": -1, "bulk_stress": 5.0}),
)


@given(profile=nameable(), of=bodies, load=loads)
def test_a_scene_reads_back_equal_from_its_dict_and_json_that_the_schema_accepts(profile, of, load):
    scene = sie.Scene(profile=profile, **of, **load)
    tables = scene.to_dict()
    assert sie.Scene.from_dict(tables) == scene
    assert sie.Scene.from_dict(json.loads(strict_json(tables))) == scene
    SCHEMA.validate(tables)


def test_the_infinite_friction_of_full_stick_reads_back_from_json():
    scene = sie.Scene(profile=sie.Flat(1.0), modulus=1.0, normal_load=1.0, friction=np.inf)
    assert sie.Scene.from_dict(json.loads(strict_json(scene.to_dict()))) == scene


def half(x):
    return 0.5 * x


@pytest.mark.parametrize(
    "profile",
    [
        (sie.Parabola(1.0) + sie.Wedge(0.1)).shifted(1.0),
        sie.Parabola(1.0).shifted(1.0).tilted(0.5),
        (sie.Polynomial((0.0, 0.1, 0.5)).raised(0.5).mirrored() + sie.Wedge(0.1)).tilted(0.25),
    ],
)
def test_a_profile_is_written_in_whatever_order_it_was_moved_and_added(profile):
    scene = sie.Scene(profile=profile, modulus=1.0, normal_load=1.0)
    assert sie.Scene.from_dict(scene.to_dict()) == scene


@pytest.mark.parametrize(
    "profile", [sie.FromFunction(half), sie.Row([sie.Parabola(1.0) + sie.Wedge(0.1)])]
)
def test_a_profile_that_no_scene_file_can_name_is_refused(profile):
    scene = sie.Scene(profile=profile, modulus=1.0, normal_load=1.0)
    with pytest.raises(ValueError, match="cannot be named in a scene file"):
        scene.to_dict()


def test_arrays_stand_for_lists_in_a_dict():
    x = np.linspace(-1.0, 1.0, 9)
    trace = {"kind": "sampled", "x": x, "h": tuple(x**2)}
    loads = {"normal_load": np.float64(0.25)}
    scene = sie.Scene.from_dict({"profile": trace, "pair": {"modulus": 1.0}, "load": loads})
    assert scene == sie.Scene(profile=sie.Sampled(x, x**2), modulus=1.0, normal_load=0.25)


def test_a_trace_that_tables_name_is_in_the_unit_of_a_scene_file(tmp_path):
    rows = "\n".join(f"{100 * k},{k * k}" for k in range(-9, 10))
    (tmp_path / "trace.csv").write_text(f"x [um],z [um]\n{rows}\n")
    profile = {"kind": "sampled", "path": str(tmp_path / "trace.csv")}
    tables = {"profile": profile, "pair": {"modulus": 1.0}, "load": {"normal_load": 1.0}}
    assert sie.Scene.from_dict(tables) == from_tables(tables).scene
    in_metres = tables | {"units": {"length": "m"}}
    assert sie.Scene.from_dict(in_metres).profile.domain[1] == pytest.approx(9e-4, rel=1e-12)


WEDGE = {"profile": {"kind": "wedge", "slope": 1.0}}
QUESTION = WEDGE | {"pair": {"modulus": 1.0}, "load": {"normal_load": 1.0}}
NESTED = {}
for _ in range(5000):
    NESTED = {"profile": NESTED}


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({}, "there is no"),
        (3, "are no tables"),
        ({"profile": {3: 1}, "load": {}}, "the key 3 is not text"),
        (NESTED, "nested too deeply"),
        ({"profile": {"kind": "parabole", "radius": 1.0}, "load": {}}, "did you mean"),
        (WEDGE | {"pair": {"modulus": 1.0}, "load": {"path": [[1.0, 0.0]]}}, "more than one scene"),
        (QUESTION | {"fatigue": {"limit": 1.0}}, "has no key"),
        (QUESTION | {"crack": {"depth": 1.0}}, "has no key"),
        (QUESTION | {"want": ["presure"]}, "is not known"),
        (QUESTION | {"title": 3}, "is not text"),
    ],
)
def test_tables_of_no_scene_are_refused(tables, said):
    with pytest.raises(ValueError, match=said):
        sie.Scene.from_dict(tables)
