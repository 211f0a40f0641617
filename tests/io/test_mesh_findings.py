"""What is found in a mesh result, noted about it, and refused."""

from dataclasses import replace

import numpy as np
import pytest
from mesh_cases import (
    ABAQUS_FIELD,
    AT,
    NLIST,
    PRINTED,
    PRNSOL,
    SOLUTION,
    WRITTEN,
    P,
    Q,
    X,
    compared,
    frd,
)

import sie
from sie.io.mesh_files.names import meaning


@pytest.mark.parametrize(
    ("quantity", "names"),
    [
        ("x", "COORD.1 COORD_1 Points:0 Points_0 Points_X coord.coor1 coor_x x X-coordinate"),
        ("y", "COORD.2 Points:1 Points_1 Points_Y COORD.COOR2 coor_y depth"),
        ("x", "x-Koordinate Koordinate_x X-Position x_Ort"),
        ("p", "Kontaktdruck Flächenpressung Druck Pressung_p contact_pressure_p"),
        ("q", "Schubspannung Reibspannung_q"),
        ("sxy", "Schubspannung_xy Spannung_xy"),
        ("p", "cpress_path lags_c solid.tn solid.Tn CONTACT_CPRESS press CONT_PRES"),
        ("q", "CSHEAR1 tang1 CONTACT_CSHEAR1 solid.Ttx"),
        ("sxx", "S11 S.S11 S-S11 S:S11 SIXX sigma_xx SX stress_xx solid.sx"),
        ("sxy", "S12 SIXY tau_xy SXY stress_xy"),
        ("mises", "VMIS vonmises_stress S.Mises SEQV solid.mises"),
        ("", "time id z Points:2 COORD.COOR3 CSHEAR2 tang2 S13 SYZ CSLIP1"),
    ],
)  # fmt: skip
def test_the_names_of_the_codes_are_known(quantity, names):
    assert {name: meaning(name) for name in names.split()} == dict.fromkeys(names.split(), quantity)


@pytest.mark.parametrize(
    "name", ["x location (mm)", "X Location (mm)", "x_mm", "x [m]", "x/mm", "x, mm", '"Points:0"']
)
def test_a_unit_behind_a_name_is_no_part_of_it(name):
    assert meaning(name) == "x"


def table(header, *columns):
    lines = [header, *(",".join(map(repr, row)) for row in np.column_stack(columns).tolist())]
    return "\n".join(lines) + "\n"


SCALE = np.linspace(0.0, 3.0, 13)


def block(height, sign=-1.0):
    """Positions, heights, depths and stress of a block whose surface is at a height."""
    x, depth = (a.ravel() for a in np.meshgrid(X, SCALE))
    s = SOLUTION.stress(x, depth)
    return x, height + sign * depth, depth, s


@pytest.mark.parametrize("height", [40.0, 2.0, -7.0, 0.0])
def test_the_height_of_the_surface_is_found_by_the_pressure(height, tmp_path):
    x, y, depth, s = block(height)
    p = np.where(depth == 0.0, SOLUTION.pressure(x), 0.0)
    text = table("x,y,CPRESS,S11,S12", x, y, p, s.xx, -s.xy)
    comparison = compared(text, tmp_path)
    assert max(d.l2 for d in comparison.differences.values()) < 1e-12
    assert comparison.differences["p"].points == 21
    assert bool(height) == any(f"at y = {height:g}" in note for note in comparison.mesh.notes)


def test_the_height_of_the_surface_is_found_by_the_stress(tmp_path):
    x, y, _, s = block(3.0)  # from the bottom, y = 0, to the surface
    comparison = compared(table("x,y,S22,S12", x, y, s.yy, -s.xy), tmp_path)
    assert max(d.l2 for d in comparison.differences.values()) < 1e-12
    assert any("largest at y = 3" in note for note in comparison.mesh.notes)


@pytest.mark.parametrize(("body", "sign"), [("below", -1.0), ("above", 1.0)])
def test_a_body_is_chosen_by_an_option(body, sign, tmp_path):
    x, y, _, s = block(1.0, sign)
    other = np.full(len(x), 9.0)
    text = table(
        "x,y,S11,S12",
        np.tile(x, 2), np.concatenate((y, 2.0 - y + 1e-3 * -sign)),
        np.concatenate((s.xx, other)), np.concatenate((sign * s.xy, other)),
    )  # fmt: skip
    comparison = compared(text, tmp_path, surface=1.0, body=body)
    assert max(d.l2 for d in comparison.differences.values()) < 1e-12


def test_nodes_that_stand_twice_are_averaged_with_a_note(tmp_path):
    x, p = np.tile(X, 2), np.concatenate((1.1 * P, 0.9 * P))
    comparison = compared(table("x,p", x, p), tmp_path)
    assert comparison.differences["p"].points == 21
    assert comparison.differences["p"].l2 < 1e-12
    assert "42 values of p stand at 21 places" in comparison.mesh.notes[0]


def test_a_traction_on_a_curved_surface_is_compared_where_it_acts(tmp_path):
    comparison = compared(frd(bend=0.01), tmp_path, "run.frd")
    assert comparison.differences["p"].points == np.count_nonzero(SOLUTION.pressure(AT))
    assert comparison.differences["p"].l2 < WRITTEN
    assert any("where they act" in note for note in comparison.mesh.notes)


UNSHEARED = SOLUTION.with_(tangential_load=0.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("first", [0.0, 0.02])
def test_half_a_model_is_mirrored_with_a_note(first, side, tmp_path):
    x = side * np.arange(first, 1.3, 0.04)
    text = table("x,p,S11,S12", x, UNSHEARED.pressure(x), x**2, x)
    comparison = compared(text, tmp_path, solution=UNSHEARED)
    assert abs(comparison.differences["p"].resultant) < 0.01
    assert any("mirrored" in note for note in comparison.mesh.notes)
    x, _, sxy = comparison.mesh.fields["sxy"]
    assert sxy == pytest.approx(x)


def test_half_a_contact_with_a_tangential_load_is_not_mirrored(tmp_path):
    x = np.arange(0.0, 1.3, 0.04)
    comparison = compared(table("x,p", x, SOLUTION.pressure(x)), tmp_path)
    assert comparison.differences["p"].resultant == pytest.approx(-0.5, abs=0.05)
    (note,) = (note for note in comparison.mesh.notes if "load is that of this half" in note)
    assert note.endswith("as the contact has a tangential load")


def test_the_verdict_names_the_quantities_that_exceed(tmp_path):
    comparison = compared(table("x,p,q", X, P, 1.1 * Q), tmp_path)
    assert str(comparison).endswith("l2 of q EXCEEDS 0.01; that of p is within it")


def test_stress_far_from_the_contact_is_left_out_with_a_note(tmp_path):
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-40.0, 40.0, 81), np.linspace(0.0, 1.0, 3)))
    wrong = SOLUTION.stress(x, y).xx + np.where(np.abs(x) > 20.0, 1e3, 0.0)
    comparison = compared(table("x,y,S11", x, y, wrong), tmp_path)
    assert comparison.ok
    assert any("half-widths of the contact" in note for note in comparison.mesh.notes)


def test_what_needs_an_unknown_poisson_ratio_is_passed_over_with_a_note(tmp_path):
    solution = sie.solve(replace(SOLUTION.scene, poisson=None))
    x, y, _, s = block(0.0)
    comparison = compared(table("x,y,S11,S33", x, y, s.xx, s.zz), tmp_path, solution=solution)
    assert set(comparison.differences) == {"sxx"}
    assert any("szz is not compared" in note for note in comparison.mesh.notes)


REFUSED = {
    "more names than columns": ("x,press,extra\n0,1\n0.1,1\n", "a.csv", "names 3"),
    "fewer names than columns": ("x press\n0 1 2\n0.1 1 2\n", "a.txt", "has 3 columns"),
    "a comment of another width": ("# x y p\n0 1\n0.1 1\n", "a.txt", "names 3"),
    "what CalculiX prints": (PRINTED, "run.dat", "have a .frd written"),
    "values by node without coordinates": (PRNSOL, "a.lis", "--nodes nlist.lis"),
    "a node that is not listed": (
        NLIST.replace("       21 ", "       22 ") + PRNSOL, "a.lis", "no node 21",
    ),
    "a list with a cell that is no number": (
        NLIST + PRNSOL.replace("   0.000   ", "   *****   ", 1), "a.lis", "list every node",
    ),
    "two nodes of one number": (
        NLIST + NLIST.replace("0.0000", "0.0001") + PRNSOL, "a.lis", "node 1 at two places",
    ),
    "a frd file that is cut off": (frd()[:2000] + "\n -1     xyz 1.0", "a.frd", "is cut off"),
    "a frd file that ends too early": (
        "\n".join(frd().splitlines()[:-4]), "a.frd", "ends within a block",
    ),
    "a frd file of displacements": (
        frd().replace("STRESS", "DISP  ").replace("CONTACT", "DISP   ").replace(" -5  S", " -5  D")
        .replace("CPRESS", "D1    ").replace("CSHEAR1", "D2     "), "a.frd", "*EL FILE",
    ),
    "a report without coordinates": (
        ABAQUS_FIELD.replace("COORD.COOR1", "U.U1       "), "a.rpt", "write COORD",
    ),
    "a vtu file that is none": ("<VTKFile", "a.vtu", "meshio"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_compared_is_refused_in_a_sentence(case, tmp_path):
    text, name, says = REFUSED[case]
    with pytest.raises(ValueError) as refusal:
        compared(text, tmp_path, name)
    assert says in str(refusal.value)
    assert name in str(refusal.value)
    assert "\n" not in str(refusal.value) and len(str(refusal.value).split()) <= 40
