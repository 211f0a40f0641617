"""Parts of scene files, and the sentence with which one is refused."""

import pytest

from sie.io.scene_file import SceneFileError, parse
from sie.profiles import kinds

KINDS = list(kinds.KINDS)
PARABOLA = '[profile]\nkind = "parabola"\nradius = 10.0\n'
BODY = "[body]\nyoung = 1e5\npoisson = 0.3\n"
PAIR = "[pair]\nmodulus = 1e5\n"
LOAD = "[load]\nnormal_load = 5.0\n"


def refusal(text: str) -> str:
    with pytest.raises(SceneFileError) as caught:
        parse(text, "scene.toml")
    message = str(caught.value)
    assert message.startswith("scene.toml") and "\n" not in message
    return message
