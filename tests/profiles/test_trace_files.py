"""Traces from files: their forms, their units, and which side is material."""

import json

import numpy as np
import pytest

import sie
from sie.cli import main
from sie.io import scene_file

ROWS = [(0.5 * k, 2.0 + 0.1 * (k - 4) ** 2) for k in range(9)]
STYLUS = (
    "Scan Parameters\r\r\nScan Type,Standard Scan\r\nStylus,Radius: 2.5 µm\r\n"
    "Location,0.0 um, 0.0 um\r\nProfile,Hills&Valleys\r\n\r\r\nAnalytical Results\r\r\n"
    "Function,R.Cur Pos,Result\r\nRa,4.0 um,0.00525 um\r\nSkew,4.0 um,6.96\r\n\r\r\n"
    "Scan Data\r\r\nLateral um,Raw Micrometer,\r\n"
)
HEADS = {
    "stylus": (STYLUS, ",", ",,\r\n", "latin-1"),
    "a line of units and a count": ("µm µm\n9\n", ",   ", "\n", "utf-8"),
    "brackets": ("x [um]\tz (µm)\n", "\t", "\n", "utf-8"),
    "comment": ("# x_um z_um\n", "   ", "\n", "utf-8"),
}


def scan(folder, head):
    before, between, end, encoding = HEADS[head]
    file = folder / "scan.csv"
    text = before + "".join(f"{x:.3e}{between}{z:.3e}{end}" for x, z in ROWS)
    file.write_bytes(text.encode(encoding))
    return file


@pytest.mark.parametrize("head", HEADS)
def test_units_in_a_head_are_used_and_contradicted_in_a_sentence(head, tmp_path):
    file, (x, z) = scan(tmp_path, head), np.transpose(ROWS)
    read = sie.Sampled.read(file, length="mm")
    assert read.points == pytest.approx(1e-3 * x, rel=1e-14)
    assert read.heights == pytest.approx(1e-3 * z, rel=1e-14)
    assert read.reading.units == ("um", "um") and read.mended == (0, 0, False)
    assert read == sie.Sampled.read(file, scale=1e-3, length="mm")
    assert sie.Sampled.read(file, units=("mm", "nm"), length="m").heights.max() < 1e-8
    with pytest.raises(ValueError, match=r"x in um and h in um.*scale = .* contradicts"):
        sie.Sampled.read(file, scale=(1e-3, 1e-6))
    with pytest.raises(ValueError, match=r"x in um and h in um.*scale = .* contradicts"):
        sie.Sampled.read(file, scale=1e-6, length="mm")
    with pytest.raises(ValueError, match='give length = "mm"'):
        sie.Sampled.read(file)


def test_heights_of_a_surface_are_turned_over_once(tmp_path):
    file, (_, z) = scan(tmp_path, "comment"), np.transpose(ROWS)
    surface = sie.Sampled.read(file, length="mm", heights="surface")
    assert surface.heights == pytest.approx(1e-3 * (z.max() - z), rel=1e-14)
    assert eval(repr(surface), {"Sampled": sie.Sampled}) == surface
    with pytest.raises(ValueError, match="turns the heights over"):
        sie.Sampled.read(file, scale=(1e-3, -1e-3), heights="surface")
    with pytest.raises(ValueError, match='"gap" or "surface"'):
        sie.Sampled.read(file, length="mm", heights="up")


def test_a_scene_reads_the_units_of_its_trace_and_says_so(tmp_path, capsys):
    scan(tmp_path, "stylus")
    scene = tmp_path / "scene.toml"
    text = '[profile]\nkind = "sampled"\npath = "scan.csv"\nheights = "gap"\n'
    text += "[pair]\nmodulus = 1.0\n[load]\nnormal_load = 1e-5\n"
    scene.write_text(text)
    assert scene_file.read(scene).scene.profile.points[-1] == pytest.approx(4e-3, rel=1e-14)
    answer = tmp_path / "answer.json"
    assert main(["solve", str(scene), "--want", "edges", "--json", str(answer)]) == 0
    said = capsys.readouterr().out
    assert "x in um and h in um, converted to mm; h is the gap" in " ".join(said.split())
    (reading,) = json.loads(answer.read_text())["readings"]
    assert reading.pop("units") == ["um", "um"]
    assert reading == {"file": "scan.csv", "length": "mm", "scale": "", "side": "gap"}
