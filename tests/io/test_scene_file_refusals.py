"""What a scene file may not say, and the sentence that says so."""

import tomllib

import pytest
from scene_texts import ILL_FORMED, KINDS, MEANINGLESS, PAIR, PARABOLA, PROFILE, SCENE, refusal

import sie
from sie.io.path_table import MOST_POINTS
from sie.io.scene_file import SceneFileError, example, parse, read


def keys_of(table):
    return [
        key
        for name, value in table.items()
        for key in (keys_of(value) if isinstance(value, dict) else [name])
    ]


@pytest.mark.parametrize("kind", KINDS)
def test_two_letters_swapped_in_any_key_of_an_example_suggest_the_key(kind):
    for key in filter(lambda key: len(key) > 3, keys_of(tomllib.loads(example(kind)))):
        typo = key[:2] + key[3] + key[2] + key[4:]
        lines = [
            typo + line[len(key) :] if line.startswith(key) else line
            for line in example(kind).splitlines()
        ]
        assert typo == key or f'did you mean "{key}"?' in refusal("\n".join(lines))


@pytest.mark.parametrize(("text", "said"), [*ILL_FORMED, *MEANINGLESS])
def test_a_file_that_makes_no_scene_is_refused_with_the_value_and_the_remedy(text, said):
    assert said in refusal(text)


@pytest.mark.parametrize(
    ("data", "said"), [(b'title = "\xe9"', "not UTF-8 text"), (b"\x00", "not TOML")]
)
def test_a_file_that_is_no_text_is_refused(data, said, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(data)
    with pytest.raises(SceneFileError, match=said):
        read(path)


DEEP = 100_000
HOSTILE = {
    "arrays within arrays": "a = " + "[" * DEEP,
    "tables within tables": "a = " + "{a=" * DEEP,
    "a long dotted header": "[a" + " . a" * DEEP + "]",
    "a string without end": 'a = "' + r"\"" * DEEP,
    "a key as long as a file": SCENE + "normal_load" * (DEEP // 2) + " = 1\n",
    "an integer of 5000 digits": PROFILE + f'kind = "parabola"\nradius = {"9" * 5000}',
    "more than a megabyte": "#" * 10**6 + "\n" + SCENE,
    "a date": PROFILE + 'kind = "parabola"\nradius = 1979-05-27',
    "old line ends": SCENE.replace("\n", "\r"),
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_file_is_refused_in_a_sentence_that_can_be_read(text):
    assert len(refusal(text)) < 500


def test_a_file_that_cannot_be_read_is_refused(tmp_path):
    with pytest.raises(SceneFileError, match="does not exist: write one with"):
        read(tmp_path / "none.toml")
    with pytest.raises(SceneFileError, match="is a directory"):
        read(tmp_path)
    with pytest.raises(SceneFileError, match="the name of the file is empty"):
        read("")


def test_a_load_path_takes_the_place_of_the_loads():
    file = parse(PAIR + PARABOLA + "[load]\nfriction = 0.5\npath = [[2, 0.5], [2.0, -0.25, 0]]\n")
    assert file.load_path == sie.Path([(2.0, 0.5), (2.0, -0.25)])
    scene = file.scene
    assert (scene.normal_load, scene.tangential_load, scene.bulk_stress) == (2.0, -0.25, 0.0)


@pytest.mark.parametrize(
    ("load", "said"),
    [
        ("path = [[2, 0.5]]\nfriction = 0.5\nnormal_load = 2\n", "both path and normal_load"),
        ("path = [[1]]\n", r"give \(P, Q\)"),
        ("path = [[1, 'a']]\n", "not a number"),
        ("path = 3\n", "not a list"),
    ],
)
def test_a_load_path_that_means_nothing_is_refused(load, said):
    with pytest.raises(SceneFileError, match=said):
        parse(PAIR + PARABOLA + "[load]\n" + load)


def test_a_path_longer_than_a_report_can_list_is_refused():
    text = PAIR + PARABOLA + "[load]\nfriction = 0.5\npath = {}\n"
    most = [[1.0, 0.1 * (-1) ** k] for k in range(MOST_POINTS)]
    assert len(parse(text.format(most)).load_path) == len(most)
    assert "follow it in Python" in refusal(text.format([*most, [1.0, 0.0]]))


def read_beside(tmp_path, load, cycle, name="cycle.csv"):
    (tmp_path / name).write_text(cycle, encoding="utf-8")
    (tmp_path / "scene.toml").write_text(PAIR + PARABOLA + "[load]\nfriction = 0.5\n" + load)
    return read(tmp_path / "scene.toml")


CYCLE = sie.Path([(2.0, 0.5, 0.1), (1.5, -0.25, 0.0)], tilt=(0.0, 0.01))
WRITTEN = {
    "a header in another order": (
        'path = "cycle.csv"',
        "time,Q (N/mm),sigma [MPa],P,tilt\n0,0.5,0.1,2,0\n1,-0.25,0,1.5,0.01\n",
    ),
    "names of scenes": (
        'path = "cycle.csv"',
        "normal_load;tangential_load;bulk_stress;tilt\n2;0,5;0,1;0\n1,5;-0,25;0;0,01\n",
    ),
    "names in the scene file": (
        'path = "cycle.csv"\ncolumns = ["", "P", "Q", "sigma", "tilt"]',
        "# a rig\nt  Fn  Ft  S  angle\n0  2  0.5  0.1  0\n1  1.5  -0.25  0  0.01\n",
    ),
    "rows": (
        'path = [[0.0, 2, 0.5, 0.1], [0.01, 1.5, -0.25, 0]]\ncolumns = ["tilt", "P", "Q", "σ"]',
        "",
    ),
}


@pytest.mark.parametrize(("load", "cycle"), WRITTEN.values(), ids=WRITTEN)
def test_a_load_path_is_read_from_columns(load, cycle, tmp_path):
    assert read_beside(tmp_path, load, cycle).load_path == CYCLE


def test_columns_without_a_header_are_the_three_loads_in_order(tmp_path):
    file = read_beside(tmp_path, 'path = "cycle.csv"', "2,0.5,0.1\n1.5,-0.25,0\n")
    assert file.load_path == sie.Path(CYCLE.points)


def test_a_moment_along_a_path_is_read(tmp_path):
    file = read_beside(tmp_path, 'path = "cycle.csv"', "P,Q,moment\n2,0.5,0.1\n1.5,-0.25,0.2\n")
    assert file.load_path == sie.Path([(2.0, 0.5), (1.5, -0.25)], moment=(0.1, 0.2))


@pytest.mark.parametrize(
    ("load", "cycle", "said"),
    [
        ('path = "none.csv"', "", "there is no such file"),
        ('path = "cycle.csv"', "", "no line with two numbers"),
        ('path = "cycle.csv"', "t,Fn,Ft\n0,2,0.5\n", "header names t, fn, ft"),
        ('path = "cycle.csv"', "1,2,3,4\n", "no header"),
        ('path = "cycle.csv"', "P,Q\n2,0.5\n2,\n", "lacks a value in line 3"),
        ('path = "cycle.csv"', "P,Q\n2,0.5\n2,x\n", "text where a number is wanted, in line 3"),
        ('path = "cycle.csv"', "P,Q\n2,0.5\n-2,0\n", "P of point 1 = -2 is not positive"),
        ('path = "cycle.csv"', "P,Q\n" + "2,0.5\n" * (MOST_POINTS + 1), "the loads turn"),
        ('path = "cycle.csv"\ncolumns = ["P", "T"]', "2,0.5\n", '"T" is not known'),
        ('path = "cycle.csv"\ncolumns = ["P", "P"]', "2,0.5\n", "two columns are named P"),
        ('path = "cycle.csv"\ncolumns = ["P", ""]', "2,0.5\n", "no column Q"),
        ('path = "cycle.csv"\ncolumns = ["P", "Q", "tilt"]', "2,0.5\n", "has 2"),
        ('path = "cycle.csv"', "P,Q,tilt,moment\n2,0.5,0,0\n", "both tilt and moment"),
        ('path = [[2, 0.5]]\ncolumns = ["P", "Q", "tilt"]', "", "2 numbers for 3 columns"),
        ('normal_load = 1.0\ncolumns = ["P", "Q"]', "", "columns without path"),
    ],
)
def test_a_table_that_makes_no_load_path_is_refused(load, cycle, said, tmp_path):
    with pytest.raises(SceneFileError, match=said):
        read_beside(tmp_path, load, cycle)
