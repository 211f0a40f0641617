"""Results of finite-element codes as these write them, for tests of what reads them."""

from pathlib import Path
from typing import Any

import numpy as np

import sie
from sie.io.mesh_comparison import compare
from sie.io.mesh_result import read_mesh

SOLUTION = sie.solve(
    sie.Scene(
        profile=sie.RoundedFlat(0.5, 4.0),
        modulus=10.0,
        poisson=0.3,
        normal_load=1.0,
        friction=0.3,
        tangential_load=0.1,
    )
)
X = np.linspace(*SOLUTION.edges, 21)
P, Q = SOLUTION.pressure(X), SOLUTION.shear(X)
WRITTEN = 2e-4  # the fewest digits that a code writes, relative to the largest value


def rows(layout: str, *columns: Any) -> str:
    return "\n".join(layout.format(*row) for row in zip(range(1, 22), *columns, strict=True))


ABAQUS_FIELD = f"""
********************************************************************************
Field Output Report, written Mon Nov 23 10:12:41 2026

Source 1
---------

   ODB: C:/temp/punch.odb
   Step: Step-2
   Frame: Increment     12: Step Time =    1.000

Loc 1 : Nodal values from source 1

Output sorted by column "Node Label".

Field Output reported at nodes for part: BLOCK-1

            Node          CPRESS         CSHEAR1     COORD.COOR1     COORD.COOR2
           Label          @Loc 1          @Loc 1          @Loc 1          @Loc 1
---------------------------------------------------------------------------------
{rows("{:16d}{:16.5E}{:16.5E}{:16.5E}              0.", P, Q, X)}


  Minimum                     0.              0.             -1.              0.
  At Node                      1               1               1               1
  Maximum              530.E-03         90.E-03              1.              0.
  At Node                     11              11              21               1
"""


def compared(
    text: str,
    folder: Path,
    name: str = "mesh.csv",
    solution: sie.Solution = SOLUTION,
    **options: Any,
) -> Any:
    (folder / name).write_text(text, encoding="utf-8")
    return compare(solution, read_mesh(folder / name, **options), 1e-2)


# Two blocks of four elements in one row, the upper one from nodes 11 to 20.
AT = np.linspace(-1.2, 1.2, 5)
NODES = {10 * k + i + 1: (x, y) for k, ys in enumerate(((-0.4, 0.0), (0.0, 0.4)))
         for i, (x, y) in enumerate((x, y) for y in ys for x in AT)}  # fmt: skip
ELEMENTS = {
    4 * k + i + 1: (10 * k + i + 1, 10 * k + i + 2, 10 * k + i + 7, 10 * k + i + 6)
    for k in (0, 1)
    for i in range(4)
}
DECK = "\n".join(
    [
        "*HEADING", "two blocks", "*Node, NSET=Nall",
        *(f"{n}, {float(x)!r}, {y!r}, 0." for n, (x, y) in NODES.items()),
        "** the blocks", "*Element, TYPE=CPE4, ELSET=Eall",
        *(f"{e}, {', '.join(map(str, nodes))}" for e, nodes in ELEMENTS.items()),
        "*Step", "*Static", "*End Step",
    ]
)  # fmt: skip


def frd(times: tuple[float, ...] = (1.0,), label: int = 10, bend: float = 0.0) -> str:
    """A .frd file with stress, and contact stress at nodes 6 to 10 of a surface that may bend."""
    kind = 1 if label == 10 else 0
    lines = ["    1C", "    1UPGM               CalculiX"]
    lines += [f"    2C{20:30d}{kind:38d}"]
    lines += [
        f" -1{n:{label}d}{x:12.5E}{y + bend * x * x:12.5E}{0:12.5E}" for n, (x, y) in NODES.items()
    ]
    lines += [" -3", f"    3C{8:30d}{kind:38d}"]
    for e, nodes in ELEMENTS.items():
        lines += [
            f" -1{e:{label}d}    9    0    1",
            " -2" + "".join(f"{n:{label}d}" for n in nodes),
        ]
    lines += [" -3"]
    for time in times:
        for name, parts in (
            ("STRESS", ("SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX")),
            ("CONTACT", ("COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2")),
        ):
            lines += [f"  100CL  101{time:12.9f}{20:12d}                     0    1{kind:12d}"]
            lines += [f" -4  {name:<8}    6    1"]
            lines += [f" -5  {part:<8}    1    4    1    1" for part in parts]
            for n, (x, y) in NODES.items():
                values = frd_values(name, n, x, -y if n <= 10 else y, time)
                lines += [f" -1{n:{label}d}" + "".join(f"{v:12.5E}" for v in values)]
            lines += [" -3"]
    return "\n".join([*lines, " 9999", ""])


def frd_values(name: str, n: int, x: float, depth: float, time: float) -> Any:
    if name == "CONTACT":
        on = n in range(6, 11)
        p, q = float(SOLUTION.pressure(x)), float(SOLUTION.shear(x))
        return (0, 0, 0, time * p * on, -time * q * on, 0)
    if n > 10:
        return (1e3,) * 6
    s = SOLUTION.stress(x, depth)
    return (time * float(s.xx), time * float(s.yy), time * float(s.zz), -time * float(s.xy), 0, 0)


PRINTED = """
 contact stress (slave node,press,tang1,tang2) for all contact elements and time  0.1000000E+01

         6  1.000000E+00  0.000000E+00  0.000000E+00
"""
# Pages of a few lines, as Ansys prints them; numbers may stand without a blank between them.
NODE_PAGE = "\n   NODE        X             Y             Z           THXY     THYZ\n"
NLIST = "\n LIST ALL SELECTED NODES.   DSYS=      0\n SORT TABLE ON  NODE  NODE  NODE\n"
VALUE_PAGE = """
 PRINT CONT NODAL SOLUTION PER NODE

  ***** POST1 NODAL CONTACT LISTING *****

  LOAD STEP=     2  SUBSTEP=     1
   TIME=    2.0000      LOAD CASE=   0

    NODE    STAT        PENE        PRES        SFRIC
"""
PRNSOL = ""
for k in range(21):
    NLIST += "" if k % 8 else NODE_PAGE
    NLIST += f"{k + 1:9d}{X[k]:16.9f}        0.0000        0.0000          0.00     0.00\n"
    PRNSOL += "" if k % 12 else VALUE_PAGE
    PRNSOL += f"{k + 1:8d}    3.0000   0.000   {P[k]:.6E}{-Q[k]:+.6E}\n"
PRNSOL += "\n MAXIMUM ABSOLUTE VALUES\n NODE          1         11\n VALUE   3.0000     0.5\n"


def written(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path
