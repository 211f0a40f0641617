"""What the columns of finite-element codes are called, as one table for all codes.

A name is compared in lower case, without its unit ("x location (mm)", "p_MPa", "x, mm"), without
what follows two blanks or an @ (the surfaces of an Abaqus contact pair, the time of COMSOL), and
with one underscore for blanks and punctuation: COORD.COOR1, Points:0 and S-S11 are looked up as
coord_coor1, points_0 and s_s11.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

Meaning = Callable[[str], str]  # of the name of a column: what it holds, "" for nothing known

TRACTIONS = ("p", "q")
STRESSES = ("sxx", "syy", "sxy", "szz", "mises")
QUANTITIES = (*TRACTIONS, *STRESSES)
BODIES = ("below", "above")

# Coordinates are numbered from 1 in Abaqus and from 0 in VTK; Code_Aster and Ansys name the axes.
_AXIS = """{a} {a}_coordinate {a}_coord coord_{a} coor_{a} coordinates_{a} {a}_location
    {a}_koordinate koordinate_{a} {a}_position {a}_ort ort_{a} points_{a} coor{n} coord{n} coord_{n}
    coord_coor{n} points_{k} coordinates_{k}"""
# Code_Aster's SIXX, the solid mechanics of COMSOL and Ansys' SX; S11 of Abaqus; names by letters.
_STRESS = """s{a} s{n} s_s{n} s_s{a} s_{a} s_{n} si{a} sigma_{a} sigma{a} sigma_{n} σ_{a} σ{a}
    sig_{a} stress_{a} stress_{n} stress_s{a} spannung_{a}"""
_CALLED = {
    **{axis: _AXIS.format(a=axis, n=k + 1, k=k) for k, axis in enumerate("xy")},
    "p": """p pressure cpress contact_pressure contact_cpress press pres contact_press cont_press
        cont_pres contpres tn lags_c normal_lm mortar_normal_lm frictional_normal_lm p_n druck
        kontaktdruck pressung flächenpressung flaechenpressung kontaktpressung""",
    "q": """q shear cshear1 cshear_1 contact_cshear1 traction tang1 contact_tang1 sfric cont_sfric
        contsfric ttx lags_f1 tangential_lm mortar_tangential_lm frictional_tangential_lm
        schubspannung reibspannung reibschubspannung kontaktschubspannung schub""",
    **{
        f"s{letters}": _STRESS.format(a=letters, n=digits)
        for letters, digits in (("xx", "11"), ("yy", "22"), ("xy", "12"), ("zz", "33"))
    },
    "mises": """mises von_mises von_mises_stress vonmises_stress s_mises seqv vmis sigma_mises
        equivalent_stress equivalent_von_mises_stress stress_mises vergleichsspannung
        von_mises_vergleichsspannung mises_vergleichsspannung""",
}
_ALSO = {
    "y": "depth tiefe",
    "sxx": "sx normalspannung_x",
    "syy": "sy normalspannung_y",
    "szz": "sz normalspannung_z",
    "sxy": "tau_xy txy τ_xy schubspannung_xy",
}
_TABLE = {
    word: quantity
    for called in (_CALLED, _ALSO)
    for quantity, words in called.items()
    for word in words.split()
}
WORDS = tuple(_TABLE)
# Words that decide, whatever stands around them: "cpress_path", "PI: BLOCK-1 N: 23 CPRESS".
_DECISIVE = {"cpress": "p", "cshear1": "q"}
# Columns whose values are negative in compression.
_NEGATIVE = frozenset({"lags_c"})
_UNIT = re.compile(r"_(mm|um|µm|m|inch|in|pa|kpa|mpa|gpa|psi|ksi|n_mm_?2|n_mm\^?2|n_m\^?2)$")


def spelling(name: str) -> str:
    """The name in lower case without unit, with underscores.

    >>> spelling("X Location (mm)"), spelling("COORD.COOR1"), spelling("p_MPa")
    ('x_location', 'coord_coor1', 'p')
    """
    bare = re.split(r"\s{2,}|@|[\[(]", name.strip().strip("\"'").lower())[0]
    bare = re.sub(r"[\s:.,\-/]+", "_", bare.strip()).strip("_")
    return re.sub(r"^solid\d*_", "", _UNIT.sub("", re.sub(r"_+", "_", bare)))


def meaning(name: str) -> str:
    """The axis or the quantity that a column of this name holds, "" for other names.

    A symbol may stand behind a name of the same meaning.

    >>> meaning("Points:0"), meaning("CPRESS   ASSEMBLY_S/ASSEMBLY_M"), meaning("time")
    ('x', 'p', '')
    >>> meaning("Kontaktdruck p [MPa]"), meaning("depth p")
    ('p', '')
    """
    spelt = spelling(name)
    word, _, symbol = spelt.rpartition("_")
    if word in _TABLE and _TABLE[word] == _TABLE.get(symbol):
        return _TABLE[word]
    words = set(spelling(re.sub(r"\s+|@", "_", name)).split("_"))
    decisive = [quantity for word, quantity in _DECISIVE.items() if word in words]
    return _TABLE.get(spelt) or (decisive[0] if len(decisive) == 1 else "")


def chosen_names(columns: Mapping[str, str]) -> Meaning:
    """The meaning of names where `columns` has those of some quantities.

    >>> means = chosen_names({"p": "Last [MPa]"})
    >>> means("Last [MPa]"), means("CPRESS"), means("CSHEAR1")
    ('p', '', 'q')
    """
    given = {spelling(name): quantity for quantity, name in columns.items()}

    def means(name: str) -> str:
        known = meaning(name)
        return given.get(spelling(name)) or ("" if known in columns else known)

    return means


def negative_in_compression(name: str) -> bool:
    """Whether the code writes this pressure with the other sign."""
    return spelling(name) in _NEGATIVE
