"""The file of a sweep grows while the work goes on, and is readable at any moment."""

import numpy as np
import pytest

import sie
from sie.sweeps import file as sweep_file

xarray = pytest.importorskip("xarray", reason='needs the extra "sweep"')

SCENE = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0)
LOADS = {"normal_load": [1.0, 2.0, 3.0, 4.0]}


@pytest.fixture
def path(tmp_path, monkeypatch):
    """A new file; a sweep writes it after every point."""
    monkeypatch.setattr(sweep_file, "PERIOD", 0.0)
    monkeypatch.setattr(sweep_file, "SHARE", 0.0)
    return tmp_path / "sweep.nc"


def opened(path):
    with xarray.open_dataset(path) as data:
        return data.load()


def half_width_and(act):
    """A quantity that does something else at the third load."""

    def quantity(solution):
        if solution.normal_load == 3.0:
            act()
        return solution.half_width

    return {"half_width": quantity}


def test_a_file_holds_what_a_sweep_returns(path):
    want = ["half_width", "edges", "elastic_limit"]
    found = sie.sweep(SCENE, LOADS | {"profile.radius": [1.0, 2.0]}, want, to=path)
    xarray.testing.assert_identical(opened(path), found)
    assert [entry.name for entry in path.parent.iterdir()] == [path.name]


def test_a_file_is_readable_while_the_work_goes_on(path):
    seen = []
    sie.sweep(SCENE, LOADS, half_width_and(lambda: seen.append(opened(path))), to=path)
    assert np.isfinite(seen[0]["half_width"]).values.tolist() == [True, True, False, False]
    assert seen[0]["reason"].values.tolist() == ["", "", *["not computed yet"] * 2]


def test_a_sweep_that_ends_in_the_middle_of_a_write_leaves_a_readable_file(path, monkeypatch):
    class Killed(BaseException):
        pass

    def end(*_, **__):
        raise Killed

    def end_in_a_write():
        monkeypatch.setattr(xarray.Dataset, "to_netcdf", end)
        monkeypatch.setattr(sweep_file.files, "write_files", end)

    with pytest.raises(Killed):
        sie.sweep(SCENE, LOADS, half_width_and(end_in_a_write), to=path)
    left = opened(path)
    assert left["reason"].values.tolist() == ["", "", *["not computed yet"] * 2]
    assert left["half_width"].values[1] == sie.solve(SCENE).with_(normal_load=2.0).half_width


def test_answers_are_not_lost_where_the_file_cannot_be_written(path, monkeypatch):
    def full(*_, **__):
        raise OSError("No space left on device")

    monkeypatch.setattr(xarray.Dataset, "to_netcdf", full)
    with pytest.raises(OSError, match=r"No space left .*`result`") as caught:
        sie.sweep(SCENE, LOADS, "half_width", to=path)
    assert np.isfinite(caught.value.result["half_width"]).all()


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("sweep.zarr", "end in .nc"),
        ("missing/sweep.nc", "no directory"),
        ("there.nc", "exists: remove it"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_any_work(name, said, tmp_path):
    asked = []
    (tmp_path / "there.nc").touch()
    with pytest.raises(ValueError, match=said):
        sie.sweep(SCENE, LOADS, {"b": asked.append}, to=tmp_path / name)
    assert not asked


def test_the_package_that_is_needed_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(sweep_file, "find_spec", lambda package: None)
    with pytest.raises(ValueError, match="pip install xarray"):
        sie.sweep(SCENE, LOADS, "half_width", to=tmp_path / "sweep.nc")
