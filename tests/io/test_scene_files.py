"""What scene files say is what is solved."""

import dataclasses

import numpy as np
import pytest
from scene_texts import BODY, KINDS, LOAD, PAIR, PARABOLA, refusal

import sie
from sie.io.scene_file import SceneFileError, example, parse, read
from sie.profiles import kinds


def profile_of(text):
    return parse(PAIR + LOAD + text).scene.profile


@pytest.mark.parametrize("kind", KINDS)
def test_each_example_has_a_title_and_a_profile_of_its_kind_which_is_a_public_name(kind):
    file = parse(example(kind))
    assert file.title and type(file.scene.profile) is kinds.KINDS[kind]
    assert kinds.KINDS[kind].__name__ in sie.__all__


@pytest.mark.parametrize("kind", KINDS)
def test_each_example_reads_back_as_the_same_value_from_any_shell(kind, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(example(kind), encoding="ascii")
    assert read(path) == parse(example(kind))
    profile = read(path).scene.profile
    assert sie.Scene.from_dict(read(path).scene.to_dict()) == read(path).scene
    assert eval(repr(profile), vars(sie) | {"inf": float("inf")}) == profile


@dataclasses.dataclass(frozen=True)
class Cosine(sie.Profile):
    """h = depth (1 - cos(x/length)), as a new kind of profile."""

    depth: float
    length: float = 1.0

    @property
    def pieces(self):
        return sie.FromFunction(self._slope, domain=(-3.0 * self.length, 3.0 * self.length)).pieces

    def _slope(self, x):
        return self.depth / self.length * np.sin(x / self.length)

    def height(self, x):
        return self.depth * (1.0 - np.cos(np.asarray(x) / self.length))


@pytest.fixture
def cosine(monkeypatch):
    monkeypatch.setitem(kinds.KINDS, "cosine", Cosine)


def test_a_line_in_the_table_of_kinds_lets_a_scene_file_name_a_new_kind(cosine):
    text = PAIR + LOAD + '[profile]\nkind = "cosine"\ndepth = 0.1\nlength = 2.0\n'
    scene = parse(text).scene
    assert scene.profile == Cosine(0.1, 2.0)
    assert sie.solve(scene).check().ok


def test_the_parameters_of_a_new_kind_say_what_a_scene_file_must_and_may_hold(cosine):
    assert profile_of('[profile]\nkind = "cosine"\ndepth = 0.1\n') == Cosine(0.1)
    missing = PAIR + LOAD + '[profile]\nkind = "cosine"\nlength = 2.0\n'
    assert "lacks depth: give depth = ..." in refusal(missing)
    stray = PAIR + LOAD + PARABOLA + "depth = 0.1\n"
    assert '"depth": it belongs to kind "cosine"' in refusal(stray)


def test_the_showcase_still_works_with_its_commented_lines_switched_on():
    hidden = ("# want", "# mirrored", "# tilted", "# shifted", "# [[", "# kind", "# radius")
    lines = [
        line.removeprefix("# ") if line.startswith(hidden) else line
        for line in example("rounded-flat").splitlines()
    ]
    profile = sie.RoundedFlat(1.0, 50.0).mirrored().tilted(1e-4).shifted(0.5) + sie.Parabola(2000.0)
    assert parse("\n".join(lines)).scene.profile == profile


def test_terms_add_up_and_modifiers_act_on_their_own_term():
    text = '[[profile.plus]]\nkind = "wedge"\nslope = 0.1\nshifted = 1.0\n'
    text += '[[profile.plus]]\nkind = "flat"\nhalf_width = 3\n'
    assert profile_of(PARABOLA + text) == sie.Parabola(10.0) + sie.Wedge(0.1).shifted(
        1.0
    ) + sie.Flat(3.0)


@pytest.mark.parametrize(
    "text", ['indenter = "rigid"\n' + BODY, BODY + "[indenter]\nrigid = true\n"]
)
def test_a_rigid_indenter_is_a_word_at_the_top_or_a_table(text):
    assert parse(text + PARABOLA + LOAD).scene.indenter == sie.RIGID


def test_the_bodies_of_a_scene_can_be_written():
    scene = parse(BODY + PARABOLA + LOAD).scene
    assert scene.indenter == scene.body == sie.Elastic(1e5, 0.3)
    text = BODY + "[indenter]\nyoung = 2e5\npoisson = 0.4\n[pair]\ndundurs = 0\n" + PARABOLA + LOAD
    bodies = {"body": sie.Elastic(1e5, 0.3), "indenter": sie.Elastic(2e5, 0.4)}
    given = {**bodies, "dundurs": 0.0, "normal_load": 5.0}
    assert parse(text).scene == sie.Scene(profile=sie.Parabola(10.0), **given)


def test_units_are_labels_and_default_to_mm_and_mpa():
    units = parse(PAIR + PARABOLA + LOAD).units
    assert (units.length, units.force, units.stress, units.moment) == ("mm", "N/mm", "MPa", "N")
    text = '[units]\nlength = "m"\nforce = "kN"\n' + PAIR + PARABOLA + LOAD
    assert parse(text).units.moment == "kN m"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_files_of_common_editors_and_shells_are_read(encoding, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('title = "Grüße"\n' + BODY + PARABOLA + LOAD, encoding=encoding)
    assert read(path).title == "Grüße"


TRACE = """
[profile]
kind = "sampled"
x = [-2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5, 2]
h = [6.0, 3.75, 2.0, 0.75, 0.0, -0.25, 0.0, 0.75, 2.0]
{}
[pair]
modulus = 1.0
[load]
normal_load = 0.1
"""


@pytest.mark.parametrize(
    ("line", "made"),
    [
        ("levelled = true", lambda t: t.levelled()),
        ("levelled = [-1, 1]", lambda t: t.levelled((-1, 1))),
        ("without_outliers = true", lambda t: t.without_outliers()),
        ("levelled = false", lambda t: t),
        (
            "levelled = true\nwithout_outliers = true\nshifted = 1.0",
            lambda t: t.without_outliers().levelled().shifted(1.0),
        ),
    ],
)
def test_a_trace_is_treated_in_the_scene_file(line, made):
    plain = parse(TRACE.format("")).scene.profile
    assert parse(TRACE.format(line)).scene.profile == made(plain)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("levelled = [1]", r"levelled = \[1\] is not a pair"),
        ("levelled = [5, 6]", "holds 0 points"),
        ("levelled = 3", "neither true nor false"),
        ("outliers = true", "without_outliers"),
    ],
)
def test_a_bad_treatment_is_refused_with_the_remedy(line, words):
    with pytest.raises(SceneFileError, match=words):
        parse(TRACE.format(line))
