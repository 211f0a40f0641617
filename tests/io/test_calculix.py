"""A real run of CalculiX comes near the exact contact, and nearer on a finer mesh."""

import importlib
import shutil
from pathlib import Path

import pytest

HOW_TO = Path(__file__).parents[2] / "docs" / "how-to"
pytestmark = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX is not installed: apt install calculix-ccx"
)


@pytest.fixture
def study(monkeypatch):
    monkeypatch.syspath_prepend(HOW_TO)
    return importlib.import_module("punch_study")


@pytest.mark.slow
@pytest.mark.parametrize("exact", [False, True], ids=["60 half-widths", "exact ends"])
def test_a_mesh_comes_near_the_exact_pressure_and_nearer_if_it_is_finer(study, exact):
    errors = [found for _, _, found in study.study((10, 20), ("without friction",), ends=(exact,))]
    assert errors[1]["p"] < 0.015
    for name, error in errors[1].items():
        assert error < 0.7 * errors[0][name] or (name == "sxx" and not exact)
    for count, found in zip((10, 20), errors, strict=True):
        typed = study.stored()["without friction", exact, count]
        assert found == pytest.approx(typed, rel=0.1)


@pytest.mark.slow
def test_a_mesh_comes_near_the_exact_contact_with_friction(study):
    ((key, at_nodes, errors),) = study.study((10,), ("friction 0.3",), ends=(True,))
    assert abs(at_nodes.differences["q"].resultant) < 0.05
    assert errors == pytest.approx(study.stored()[key], rel=0.1)
    assert max(errors.values()) < 0.05


def test_exact_ends_leave_a_third_of_the_error_that_sixty_half_widths_leave(study):
    stored = study.stored()
    for scene in study.SCENES:
        far, exact = (stored[scene, ends, 80] for ends in (False, True))
        assert exact["sxx"] < far["sxx"] / 3.0
        assert max(exact.values()) < 1e-2
