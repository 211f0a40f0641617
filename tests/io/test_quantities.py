"""Quantities with units in scene files: converted exactly, checked, or refused in a sentence."""

import sys

import pytest

import sie
from sie.cli import main
from sie.io.scene_file import SceneFileError, parse

pytest.importorskip("pint")

SCENE = """
[units]
{units}
[profile]
kind = "rounded-flat"
half_flat = {flat}
radius = {radius}
[body]
young = {young}
poisson = 0.3
[load]
friction = 0.5
{load}
"""
PLAIN = {
    "units": "", "flat": "0.02", "radius": "50.0", "young": "210e3", "load": "normal_load = 500.0",
}  # fmt: skip


def scene(**changed):
    return SCENE.format(**(PLAIN | changed))


@pytest.mark.parametrize(
    "changed",
    [
        {"flat": '"20 um"'},
        {"flat": '"20 µm"'},
        {"flat": '"2e-5m"'},
        {"radius": '"5 cm"'},
        {"young": '"210 GPa"'},
        {"young": '"210e3 N/mm²"'},
        {"young": '"210 kN / mm**2"'},
        {"load": 'normal_load = "500 N/mm"'},
        {"load": 'normal_load = "500 kN/m"'},
        {"load": 'normal_load = "500 MPa mm"'},
    ],
    ids=lambda changed: " ".join(changed.values()),
)
def test_a_quantity_is_the_number_in_the_units_of_the_file(changed):
    assert parse(scene(**changed)).scene == parse(scene()).scene


def test_the_units_of_the_file_are_those_of_the_scene():
    metres = 'length = "m"\nforce = "N/m"\nstress = "Pa"'
    made = parse(scene(units=metres, flat='"20 um"', radius='"50 mm"', young='"210 GPa"')).scene
    assert made.profile == sie.RoundedFlat(2e-5, 0.05) and made.body.young == 210e9


def test_angles_moments_stresses_and_modifiers_are_converted():
    load = 'normal_load = 500.0\nmoment = "2 N m/m"\nbulk_stress = "0.1 GPa"\n'
    made = parse(scene(load=load).replace("[body]", 'shifted = "1 um"\n[body]')).scene
    assert (made.moment, made.bulk_stress) == (2.0, 100.0)
    assert made.profile == sie.RoundedFlat(0.02, 50.0).shifted(1e-3)
    tilted = parse(scene(load='normal_load = 500.0\ntilt = "0.18 deg"')).scene
    assert tilted.tilt == pytest.approx(0.001 * 3.141592653589793, rel=1e-15)


def test_a_path_may_mix_numbers_and_quantities():
    load = (
        'columns = ["Q", "P", "tilt"]\npath = [[0.0, "0.5 kN/mm", 0.0], ["9 N/mm", 500, "1 mrad"]]'
    )
    file = parse(scene(load=load))
    assert file.load_path == sie.Path([(500.0, 0.0), (500.0, 9.0)], tilt=(0.0, 1e-3))


def test_constants_of_the_material_and_terms_of_a_profile_are_converted():
    more = '[fatigue]\nfatemi_socie_k = 0.3\nyield_stress = "0.9 GPa"\ndepth = ["20 um", 0.1]\n'
    plus = '[[profile.plus]]\nkind = "parabola"\nradius = "1 m"\n'
    file = parse(scene() + plus + more)
    assert (file.fatigue.yield_stress, file.fatigue.depth) == (900.0, (0.02, 0.1))
    assert file.scene.profile == sie.RoundedFlat(0.02, 50.0) + sie.Parabola(1000.0)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"radius": '"50 MPa"'},
         '[profile] radius = "50 MPa" is not a number and not a length: give it in mm'),
        ({"radius": '"50 foo"'}, '[profile] radius = "50 foo" is not a number and not a length'),
        ({"young": '"210 mm"'},
         '[body] young = "210 mm" is not a number and not a stress: give it in MPa'),
        ({"load": 'normal_load = "500 N"'},
         '"500 N" is not a number and not a force per length: give it in N/mm'),
        ({"load": 'normal_load = 1.0\ntilt = "1 mm"'},
         'tilt = "1 mm" is not a number and not an angle: give it in deg'),
        ({"load": 'path = [[1.0, 0.0], [1.0, "1 MPa"]]'},
         '[load] path[1][1] = "1 MPa" is not a number and not a force per length'),
        ({"radius": '"1e999 mm"'}, "beyond the floating-point range in mm"),
        ({"radius": '"50"'}, 'radius = "50" is not a number'),
        ({"load": 'normal_load = 1.0\nsliding = "1 mm"'}, 'sliding = "1 mm" is not a number'),
        ({"flat": '"1 mm"', "units": 'force = "N"'}, '[units] force = "N" is not stress × length'),
        ({"units": 'checked = true\nlength = "m"'}, "is not stress × length, MPa m"),
        ({"units": 'checked = true\nlength = "ell"'},
         'length = "ell" is not a unit that pint knows'),
        ({"units": "checked = 1"}, "checked = 1 is neither true nor false"),
    ],
)  # fmt: skip
def test_a_wrong_quantity_is_refused_with_key_value_and_dimension(changed, said):
    with pytest.raises(SceneFileError) as refused:
        parse(scene(**changed))
    assert said in str(refused.value) and "\n" not in str(refused.value)


def test_labels_are_free_where_nothing_is_converted_or_checked():
    assert parse(scene(units='length = "ell"')).units.length == "ell"


@pytest.mark.parametrize(
    "changed",
    [
        {"radius": '"9 mm**9**9**9**9"'},
        {"radius": '"1e999999999 mm"'},
        {"units": 'checked = true\nlength = "mm*9**9**9**9"'},
        {"radius": '"1 __import__"'},
    ],
)
def test_a_hostile_unit_is_refused_before_it_is_computed(changed):
    with pytest.raises(SceneFileError):
        parse(scene(**changed))


@pytest.mark.parametrize("changed", [{"radius": '"5 cm"'}, {"units": "checked = true"}])
def test_without_pint_the_extra_is_named_and_nothing_is_written(
    changed, tmp_path, monkeypatch, capsys
):
    monkeypatch.setitem(sys.modules, "pint", None)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(scene(**changed))
    assert main(["solve", "scene.toml", "--csv", "out.csv"]) == 2
    out, err = capsys.readouterr()
    assert 'needs pint: pip install "plane-contact[units]"' in err and err.count("\n") == 1
    assert not out and not (tmp_path / "out.csv").exists()
    assert parse(scene()).scene.normal_load == 500.0
