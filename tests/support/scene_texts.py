"""Parts of scene files, and the sentence with which one is refused."""

import pytest

from sie.io.scene_file import SceneFileError, parse
from sie.profiles import kinds

KINDS = list(kinds.KINDS)
PARABOLA = '[profile]\nkind = "parabola"\nradius = 10.0\n'
BODY = "[body]\nyoung = 1e5\npoisson = 0.3\n"
PAIR = "[pair]\nmodulus = 1e5\n"
LOAD = "[load]\nnormal_load = 5.0\n"
KIND = 'kind = "parabola", radius = 2.0'
PROFILE, SCENE = BODY + LOAD + "[profile]\n", BODY + PARABOLA + LOAD
# What the schema refuses, and the reader with these words.
ILL_FORMED = [
    (BODY + PARABOLA + "[load]\nnormal_laod = 5.0\n",
     '[load] has no key "normal_laod": did you mean "normal_load"?'),
    ("[laod]\nnormal_load = 5.0\n", 'there is no key or table "laod": did you mean "load"?'),
    (PROFILE + 'kind = "wegde"\nslope = 0.1\n',
     '[profile] kind = "wegde" is not known: did you mean "wedge"?'),
    (PROFILE + 'kind = "wedge"\nrise = 0.1\n', 'of kind "wedge" has no key "rise"'),
    (PROFILE + "radius = 1.0\n", "[profile] lacks kind"),
    (PROFILE + 'kind = "rounded-flat"\nradius = 1.0\n', "lacks half_flat"),
    ("normal_load = 5.0\n" + BODY + PARABOLA, '"normal_load": it belongs in [load]'),
    (SCENE + "young = 1.0\n", '"young": it belongs in [body] or [indenter]'),
    (PROFILE + 'kind = "sampled"\nfile = "x.csv"\n', "a file is named by path"),
    (SCENE + "mu = 0.3\n", 'no key "mu": choose "normal_load"'),
    (PROFILE + 'kind = "wedge"\npath = "x.csv"\nslope = 0.1\n', 'it belongs to kind "sampled"'),
    (BODY + "body = 3\n" + PARABOLA + LOAD, '[body] has no key "body": choose "young"'),
    (BODY + PARABOLA + "breaks = [1.0]\n" + LOAD,
     'it belongs to kind "piecewise" or "function"'),
    (BODY + PARABOLA + f"of = [{{{KIND}}}]\n" + LOAD, '"of": it belongs to kind "row"'),
    (PROFILE + f'kind = "row"\nof = [{{{KIND}, period = 3.0}}]\n',
     '"period": it belongs in [profile], and repeats the whole of it'),
    (BODY + PARABOLA, "there is no [load]: give [load]"),
    (BODY + LOAD, "there is no [profile]: give [profile]"),
    (PARABOLA + LOAD, "neither [body] nor [pair]"),
    ("[pair]\npoisson = 0.3\n" + PARABOLA + LOAD, "[pair] lacks modulus"),
    ("[body]\nyoung = 1e5\n" + PARABOLA + LOAD, "[body] lacks poisson"),
    ('indenter = "rigit"\n' + SCENE, 'indenter = "rigit" is not known'),
    (BODY + PARABOLA + "[load]\nnormal_load = -5\n", "normal_load = -5 is not positive"),
    (SCENE + "half_width = 1.0\n", "both of normal_load and half_width"),
    ("load = 5.0\n" + BODY + PARABOLA, "load = 5.0 is not a table"),
    (BODY + PARABOLA + "[[load]]\nnormal_load = 5.0\n", "[load] is a list"),
    (PROFILE + 'kind = "parabola"\nradius = -1.0\n', "[profile] radius = -1 is not positive"),
    (PROFILE + 'kind = "piecewise"\nbreaks = 1.0\npieces = [[0.0]]\n',
     "breaks = 1.0 is not a list"),
    (BODY + LOAD + PARABOLA + 'mirrored = "yes"\n',
     'mirrored = "yes" is neither true nor false'),
    (BODY + LOAD + PARABOLA + "plus = 3\n", "write the header [[profile.plus]]"),
    (BODY + PARABOLA + LOAD + "pair = 3\n", "write the header [pair]"),
    (BODY + PARABOLA + LOAD + 'title = "a"\n', "top of the file"),
    ("[body]\nyoung = 1e5\npoisson = 0.7\n" + PARABOLA + LOAD,
     "[body] poisson = 0.7 is outside"),
    ('want = ["edgse"]\n' + SCENE, 'want "edgse" is not known: did you mean "edges"?'),
    ("[body]\nrigid = false\n" + PARABOLA + LOAD, "lacks young"),
    (SCENE + 'friction = "0.5 mm"\n', "friction"),
    (SCENE + 'columns = ["P", "Q"]\n', "columns without path: give path"),
    (BODY + PARABOLA + '[load]\nnormal_load = "500 N/mm"\n',
     '"500 N/mm" is not a number: write a plain number without quotes and unit'),
    ("[units]\nchecked = true\n" + SCENE, "units are labels, and nothing is converted"),
    (SCENE + "[fatigue]\nshear_limit = 3.0\n", "findley_k"),
    (PROFILE + 'kind = "row"\nof = []\n', "of"),
    (SCENE.replace("[load]", "levelled = true\n[load]"), "levelled"),
    (BODY + PARABOLA + '[load]\nnormal_load = "much"\n', "is not a number"),
]  # fmt: skip
# What the reader alone refuses.
MEANINGLESS = [
    (BODY + "[pair]\nmodulus = 1e5\n" + PARABOLA + LOAD,
     "give dundurs = 0 or coupling alone"),
    (BODY + PARABOLA + "shifted = nan\n" + LOAD, "[profile] shifted is nan: give a number"),
    ("[body]\nrigid = true\n" + PARABOLA + LOAD,
     "both rigid: nothing can deform; give one of them young and poisson"),
    (BODY + "[indenter]\nrigid = true\nyoung = 1.0\n" + PARABOLA + LOAD,
     "[indenter] is rigid and has young"),
    (BODY + PARABOLA + f"[load]\nnormal_load = 1{'0' * 400}\n",
     "beyond the floating-point range"),
    (BODY + PARABOLA + "[load]\nnormal_load = nan\n", "normal_load is nan"),
    (PROFILE + 'kind = "function"\nslope = "os.remove(x)"\n', "[profile] expression"),
    (BODY + LOAD + PARABOLA + '[[profile.plus]]\nkind = "wedge"\nslope = 0\n',
     "[[profile.plus]] slope = 0 is not positive"),
    ('title = "a\\nb"\n' + SCENE, "not one line of plain text"),
    ("[load\n", "is not TOML"),
]  # fmt: skip


def refusal(text: str) -> str:
    with pytest.raises(SceneFileError) as caught:
        parse(text, "scene.toml")
    message = str(caught.value)
    assert message.startswith("scene.toml") and "\n" not in message
    return message
