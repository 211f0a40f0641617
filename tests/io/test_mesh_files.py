"""Results in the layouts of finite-element codes agree with what they were made of."""

import re

import numpy as np
import pytest
from mesh_cases import (
    ABAQUS_FIELD,
    DECK,
    ELEMENTS,
    NLIST,
    NODES,
    PRNSOL,
    SOLUTION,
    WRITTEN,
    P,
    Q,
    X,
    compared,
    frd,
    frd_values,
    rows,
    written,
)

from sie.io.mesh_comparison import compare
from sie.io.mesh_result import read_mesh

DEEP = SOLUTION.stress(X, 0.2)
ABAQUS_ELEMENTS = f"""
Field Output Report, written Mon Nov 23 10:12:41 2026

Field Output reported at integration points for part: BLOCK-1

         Element             Int           S.S11           S.S22           S.S12     COORD.COOR1
           Label              Pt          @Loc 1          @Loc 1          @Loc 1          @Loc 1
------------------------------------------------------------------------------------------------
{rows("{:16d}               1{:16.6E}{:16.6E}{:16.6E}{:16.6E}", DEEP.xx + 1, DEEP.yy, DEEP.xy, X)}
{rows("{:16d}               2{:16.6E}{:16.6E}{:16.6E}{:16.6E}", DEEP.xx - 1, DEEP.yy, DEEP.xy, X)}
"""
ABAQUS_XY = f"""

              X               CPRESS-PATH


{rows("{1:16.6E}{2:24.6E}", X, P)}

"""
PARAVIEW = '"Point ID","CONTACT:CPRESS","Points:0","Points:1","Points:2"\n' + rows(
    "{},{},{},0,0", P, X
)
ANSYS = "Node Number\tX Location (mm)\tY Location (mm)\tZ Location (mm)\tPressure (MPa)\n" + rows(
    "{}\t{:.6e}\t0.\t0.\t{:.5e}", X, P
)
ASTER = f"""
#
#--------------------------------------------------------------------------------
#
#ASTER 16.04.00 CONCEPT TAB CALCULE LE 23/11/2026 A 10:12:41 DE TYPE
#TABLE_SDASTER
 NOM_CHAM         NUME_ORDRE   INST         NOEUD    COOR_X       COOR_Y       LAGS_C
{rows(" DEPL                       2  1.00000E+00 N{:<7d} {:12.5E}  0.00000E+00 {:12.5E}", X, -P)}
"""
COMSOL = f"""% Model:              punch.mph
% Version:            COMSOL 6.1.0.252
% Date:               Nov 23 2026, 10:12
% Dimension:          1
% Nodes:              21
% Expressions:        2
% Description:        Contact pressure, Friction force, x component
% Length unit:        mm
% x                       solid.Tn (N/mm^2) @ t=1   solid.Ttx (N/mm^2) @ t=1
{rows("{1!r:<26}{2!r:<26}{3!r}", X.tolist(), P.tolist(), Q.tolist())}
"""
FENICSX = "# x y p\n" + rows("{1:.18e} 0.000000000000000000e+00 {2:.18e}", X, P)
UNITS_BELOW = "x,p\nmm,MPa\n" + rows("{1},{2}", X, P)
GERMAN = "x-Koordinate [mm];Kontaktdruck p [MPa];Schubspannung [MPa]\n" + rows(
    "{1:.9f};{2:.9f};{3:.9f}", X, P, Q
).replace(".", ",")
EXPORTS = {
    "abaqus field.rpt": ABAQUS_FIELD,
    "abaqus xy.rpt": ABAQUS_XY,
    "paraview.csv": PARAVIEW,
    "ansys.txt": ANSYS,
    "aster.txt": ASTER,
    "comsol.txt": COMSOL,
    "fenicsx.txt": FENICSX,
    "units below.csv": UNITS_BELOW,
    "german.csv": GERMAN,
}


@pytest.mark.parametrize("name", EXPORTS)
def test_an_export_agrees_with_what_it_was_made_of(name, tmp_path):
    comparison = compared(EXPORTS[name], tmp_path, name)
    assert "p" in comparison.differences
    for difference in comparison.differences.values():
        assert difference.points == 21
        assert difference.l2 < WRITTEN


def test_integration_points_of_a_report_are_averaged_over_elements(tmp_path):
    difference = compared(ABAQUS_ELEMENTS, tmp_path, "elements.rpt").differences["sxx"]
    assert difference.points == 21


def report(part, y, pressed):
    """The table of one part; contact output has the names of the pair of surfaces behind it."""
    return f"""
Field Output reported at nodes for part: {part}

            Node   CPRESS   ASSEMBLY_S/ASSEMBLY_M     COORD.COOR1     COORD.COOR2     S.S11
           Label                           @Loc 1          @Loc 1          @Loc 1    @Loc 1
--------------------------------------------------------------------------------------------
{rows("{:16d}{:16.6E}{:20.12E}{:16.6E}{:16.6E}", pressed * P, X, y + 0.0 * X, SURFACE.xx * pressed)}

"""


SURFACE = SOLUTION.stress(X, 0.0)


def test_of_two_parts_of_a_report_the_lower_one_is_compared(tmp_path):
    text = "Field Output Report\n" + report("PUNCH-1", 7.5, 0.0) + report("BLOCK-1", 7.0, 1.0)
    comparison = compared(text, tmp_path, "two.rpt")
    assert comparison.differences["p"].l2 < WRITTEN
    assert comparison.differences["sxx"].l2 < WRITTEN
    assert any("at y = 7" in note for note in comparison.mesh.notes)


def test_coordinates_that_a_report_lacks_come_from_the_deck(tmp_path):
    written(tmp_path / "job.inp", DECK)
    pressures = [(n, float(SOLUTION.pressure(NODES[n][0]))) for n in range(6, 11)]
    lines = "\n".join(f"{n:16d}{p:16.6E}" for n, p in pressures)
    head = "Field Output Report\n\n  Node  CPRESS\n  Label  @Loc 1\n" + 30 * "-"
    text = f"{head}\n{lines}\n\n"
    comparison = compared(text, tmp_path, "job.rpt", nodes=tmp_path / "job.inp")
    assert comparison.differences["p"].l2 < WRITTEN


@pytest.mark.parametrize("label", [10, 5], ids=["long", "short"])
def test_the_last_step_of_a_frd_file_is_read_with_the_lower_body(label, tmp_path):
    comparison = compared(frd((0.5, 1.0), label), tmp_path, "run.frd")
    assert set(comparison.differences) == {"p", "q", "sxx", "syy", "sxy", "szz"}
    assert max(d.l2 for d in comparison.differences.values()) < WRITTEN
    assert comparison.differences["sxx"].points == 10
    said = " ".join(comparison.mesh.notes)
    assert "the last of 2 times is read, 1" in said
    assert "part 1 of 2" in said
    assert "q has the other sign" in said


def test_contact_at_nodes_that_a_frd_file_does_not_list_is_noted(tmp_path):
    start, title, contact = frd().partition(" -4  CONTACT")
    moved = re.sub(r"\n -1(.{10})", lambda node: f"\n -1{int(node[1]) + 900:10d}", contact)
    comparison = compared(start + title + moved, tmp_path, "run.frd")
    assert set(comparison.differences) == {"sxx", "syy", "sxy", "szz"}
    assert any("OUTPUT=3D" in note for note in comparison.mesh.notes)


def test_values_by_node_find_their_places_in_a_list_of_another_file(tmp_path):
    listed = written(tmp_path / "nlist.lis", NLIST)
    comparison = compared(PRNSOL, tmp_path, "prnsol.lis", nodes=listed)
    assert set(comparison.differences) == {"p", "q"}
    assert max(d.l2 for d in comparison.differences.values()) < WRITTEN
    assert comparison.differences["p"].points == 21


def test_nodes_of_a_deck_and_of_a_table_are_read(tmp_path):
    values = "Knoten;Druck [MPa]\n" + "\n".join(
        f"{n};{float(SOLUTION.pressure(x)):.6f}".replace(".", ",")
        for n, (x, _) in NODES.items()
        if 6 <= n <= 10
    )
    table = "node,x,y\n" + "\n".join(f"{n},{x:.9f},{y}" for n, (x, y) in NODES.items())
    for name, text in (("job.inp", DECK), ("nodes.csv", table)):
        nodes = written(tmp_path / name, text)
        comparison = compared(values, tmp_path, "p.csv", nodes=nodes)
        assert comparison.differences["p"].points == 5
        assert comparison.differences["p"].l2 < WRITTEN


@pytest.mark.parametrize(
    ("header", "columns"),
    [
        ("Ort [mm]\tNormalenlast [MPa]\tQuerlast", {"x": "Ort", "p": "Normalenlast"}),
        ("x\tp\tCPRESS", {"x": "0", "p": "1"}),
        ("s\tp\tCPRESS", {"x": "s [mm]"}),
    ],
)
def test_columns_are_named_by_the_user(header, columns, tmp_path):
    text = header + "\n" + rows("{1:.9e}\t{2:.9e}\t{3:.9e}", X, P, Q)
    comparison = compared(text, tmp_path, columns=columns)
    assert set(comparison.differences) == {"p"} and comparison.differences["p"].l2 < 1e-8


def test_a_column_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(ValueError, match='no column "Querlast" for q'):
        compared(COMSOL, tmp_path, columns={"q": "Querlast"})


def test_a_mesh_that_meshio_reads_is_compared(tmp_path):
    meshio = pytest.importorskip("meshio", reason="meshio is not installed")
    points = np.array([[x, y, 0.0] for x, y in NODES.values()])
    cells = np.array([[n - 1 for n in nodes] for nodes in ELEMENTS.values()])
    contact = np.array([frd_values("CONTACT", n, x, 0.0, 1.0) for n, (x, _) in NODES.items()])
    x, y = points[cells].mean(axis=1)[:, :2].T
    exact = SOLUTION.stress(x, np.abs(y))
    stress = np.stack((exact.xx, exact.yy, exact.zz, -exact.xy), axis=1)
    mesh = meshio.Mesh(points, [("quad", cells)], {"CONTACT": contact}, {"stress": [stress]})
    mesh.write(tmp_path / "run.vtu")
    comparison = compare(SOLUTION, read_mesh(tmp_path / "run.vtu"), 1e-2)
    assert set(comparison.differences) == {"p", "q", "sxx", "syy", "sxy", "szz"}
    assert max(d.l2 for d in comparison.differences.values()) < WRITTEN
