"""What a scene file may not say, and the sentence that says so."""

import tomllib

import pytest
from scene_texts import BODY, KINDS, LOAD, PAIR, PARABOLA, refusal

import sie
from sie.io.path_table import MOST_POINTS
from sie.io.scene_file import SceneFileError, example, parse, read

KIND = 'kind = "parabola", radius = 2.0'
PROFILE, SCENE = BODY + LOAD + "[profile]\n", BODY + PARABOLA + LOAD


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


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (BODY + PARABOLA + "[load]\nnormal_laod = 5.0\n",
         '[load] has no key "normal_laod": did you mean "normal_load"?'),
        ("[laod]\nnormal_load = 5.0\n", 'there is no key or table "laod": did you mean "load"?'),
        (PROFILE + 'kind = "wegde"\nslope = 0.1\n',
         '[profile] kind = "wegde" is not known: did you mean "wedge"?'),
        (PROFILE + 'kind = "wedge"\nrise = 0.1\n', 'of kind "wedge" has no key "rise"'),
        (PROFILE + "radius = 1.0\n", "[profile] lacks kind"),
        (PROFILE + 'kind = "rounded-flat"\nradius = 1.0\n', "lacks half_flat"),
        (BODY + LOAD + PARABOLA + 'want = ["edges"]\n', '"want": it stands at the top of the file'),
        ("normal_load = 5.0\n" + BODY + PARABOLA, '"normal_load": it belongs in [load]'),
        (SCENE + "young = 1.0\n", '"young": it belongs in [body] or [indenter]'),
        (BODY + PARABOLA + "[load]\nload = 500\n",
         '[load] has no key "load": did you mean "normal_load"?'),
        (PROFILE + 'kind = "sampled"\nfile = "x.csv"\n',
         'of kind "sampled" has no key "file": did you mean "path"?'),
        (SCENE + "mu = 0.3\n", 'no key "mu": did you mean "friction"?'),
        (PROFILE + 'kind = "wedge"\nfile = "x.csv"\nslope = 0.1\n', 'it belongs to kind "sampled"'),
        (PROFILE + 'profile = "parabola"\nkind = "parabola"\nradius = 1\n',
         'has no key "profile": did you mean "kind"?'),
        (BODY + "body = 3\n" + PARABOLA + LOAD, '[body] has no key "body": choose "young"'),
        (SCENE + "pair = 3\n",
         "it is a table of its own, write the header [pair] and its keys below it"),
        (BODY + PARABOLA + "half_flat = 1.0\n" + LOAD,
         'of kind "parabola" has no key "half_flat": it belongs to kind "rounded-flat"'),
        (BODY + PARABOLA + "breaks = [1.0]\n" + LOAD,
         'it belongs to kind "piecewise" or "function"'),
        (BODY + PARABOLA + f"of = [{{{KIND}}}]\n" + LOAD, '"of": it belongs to kind "row"'),
        (PROFILE + f'kind = "row"\nof = [{{{KIND}, period = 3.0}}]\n',
         '"period": it belongs in [profile], and repeats the whole of it'),
        (BODY + PARABOLA + "shifted = nan\n" + LOAD, "[profile] shifted is nan: give a number"),
        ("[body]\nrigid = true\n" + PARABOLA + LOAD,
         "both rigid: nothing can deform; give one of them young and poisson"),
        (BODY + PARABOLA, "there is no [load]: give [load]"),
        (BODY + LOAD, "there is no [profile]: give [profile]"),
        (PARABOLA + LOAD, "neither [body] nor [pair]"),
        (BODY + PAIR + PARABOLA + LOAD, "both [pair] and [body]"),
        ("[pair]\npoisson = 0.3\n" + PARABOLA + LOAD, "[pair] lacks modulus"),
        ("[body]\nyoung = 1e5\n" + PARABOLA + LOAD, "[body] lacks poisson"),
        ('indenter = "rigit"\n' + SCENE, 'indenter = "rigit" is not known'),
        (BODY + "[indenter]\nrigid = true\nyoung = 1.0\n" + PARABOLA + LOAD,
         "[indenter] is rigid and has young"),
        (BODY + PARABOLA + '[load]\nnormal_load = "5 N"\n', 'normal_load = "5 N" is not a number'),
        (BODY + PARABOLA + f"[load]\nnormal_load = 1{'0' * 400}\n",
         "beyond the floating-point range"),
        (BODY + PARABOLA + "[load]\nnormal_load = nan\n", "normal_load is nan"),
        (BODY + PARABOLA + "[load]\nnormal_load = -5\n", "normal_load = -5 is not positive"),
        (SCENE + "half_width = 1.0\n", "both of normal_load and half_width"),
        ("load = 5.0\n" + BODY + PARABOLA, "load = 5.0 is not a table"),
        (BODY + PARABOLA + "[[load]]\nnormal_load = 5.0\n", "[load] is a list"),
        (PROFILE + 'kind = "parabola"\nradius = -1.0\n', "[profile] radius = -1 is not positive"),
        (PROFILE + 'kind = "piecewise"\nbreaks = 1.0\npieces = [[0.0]]\n',
         "breaks = 1.0 is not a list"),
        (PROFILE + 'kind = "function"\nslope = "os.remove(x)"\n', "[profile] expression"),
        (BODY + LOAD + PARABOLA + 'mirrored = "yes"\n',
         'mirrored = "yes" is neither true nor false'),
        (BODY + LOAD + PARABOLA + "plus = 3\n", "write the header [[profile.plus]]"),
        (BODY + LOAD + PARABOLA + '[[profile.plus]]\nkind = "wedge"\nslope = 0\n',
         "[[profile.plus]] slope = 0 is not positive"),
        ("[body]\nyoung = 1e5\npoisson = 0.7\n" + PARABOLA + LOAD,
         "[body] poisson = 0.7 is outside"),
        ('title = "a\\nb"\n' + SCENE, "not one line of plain text"),
        ('want = ["edgse"]\n' + SCENE, 'want "edgse" is not known: did you mean "edges"?'),
        ("[load\n", "is not TOML"),
    ],
)  # fmt: skip
def test_a_file_that_makes_no_scene_is_refused_with_the_value_and_the_remedy(text, said):
    assert said in refusal(text)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b'title = "\xe9"', "not UTF-8 text"),
        (b"\xff\xfe\x00", "not UTF-8 text"),
        (b"\x00", "not TOML"),
    ],
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
        ("path = []\n", "no points"),
        ("path = [[1]]\n", r"give \(P, Q\)"),
        ("path = [[1, 'a']]\n", "not a number"),
        ("path = 3\n", "not a list"),
        ("path = [[0, 0]]\n", "nothing ever touches"),
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
        ('normal_load = 1.0\ncolumns = ["P", "Q"]', "", "columns without a path"),
    ],
)
def test_a_table_that_makes_no_load_path_is_refused(load, cycle, said, tmp_path):
    with pytest.raises(SceneFileError, match=said):
        read_beside(tmp_path, load, cycle)
