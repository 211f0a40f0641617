"""The page served on this machine: one answer at a time, and none that nobody waits for."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Lock
from typing import Any
from urllib.parse import parse_qsl, urlsplit

from sie.errors import ContactError
from sie.io.beside_scene import Units
from sie.problem.scene import Scene

from .answer import PARTS, answer
from .page import bokeh_script, served
from .setting import Setting, sliders

HOST = "127.0.0.1"  # no other machine is answered
NAMES = (HOST, "localhost")  # a page of another name would be of a site that points here


class LiveServer(ThreadingHTTPServer):
    """A server of one page and of the answers that it asks for.

    Parameters
    ----------
    file : Scene, optional
        The scene of a file, which is then the first of the punches.
    port : int, optional
        0 for any that is free.
    units : Units, optional
        Labels of the file's units.

    Raises
    ------
    ValueError
        If the port is taken, or the scene has no place on the sliders.
    ImportError
        If Bokeh is not installed.
    """

    request_queue_size = 128  # a slider that is dragged asks faster than connections are taken

    def __init__(
        self, file: Scene | None = None, port: int = 0, units: Units | None = None
    ) -> None:
        self.file, self.units, self.turns = file, units, Turns()
        try:
            super().__init__((HOST, port), _Handler)
        except OSError as problem:
            raise ValueError(
                f"port {port} cannot be served on ({problem.strerror}): give --port another "
                "number, or leave it out for any that is free"
            ) from None
        try:
            self.contents = {
                "/": ("text/html; charset=utf-8", served(file, sliders(file)).encode()),
                "/bokeh.js": ("text/javascript", bokeh_script()),
            }
        except BaseException:
            self.server_close()
            raise

    @property
    def address(self) -> str:
        """Where a browser finds the page."""
        return f"http://{HOST}:{self.server_port}/"


class Turns:
    """Requests that wait for a computation.

    A page numbers its settings: those of a later one leave no use for the answers before.
    """

    def __init__(self) -> None:
        self._work = Lock()
        self._newest: dict[str, int] = {}

    @contextmanager
    def taken(self, page: str, turn: int) -> Iterator[bool]:
        """Wait until no other request is worked on; False if the page has moved on by then."""
        self._newest[page] = max(turn, self._newest.get(page, turn))
        with self._work:
            yield turn >= self._newest[page]


class _Handler(BaseHTTPRequestHandler):
    """Answers one request: the page, its script, or a setting's answer."""

    server: LiveServer

    def do_GET(self) -> None:
        """Send what the path names."""
        path = urlsplit(self.path)
        name = self.headers.get("Host", "").rpartition(":")[0] or self.headers.get("Host", "")
        try:
            if name not in NAMES:
                sentence = f"this page is at {self.server.address}, for this machine alone"
                self._send(HTTPStatus.FORBIDDEN, "text/plain", sentence.encode())
            elif path.path == "/answer":
                self._answer(dict(parse_qsl(path.query)))
            elif path.path in self.server.contents:
                self._send(HTTPStatus.OK, *self.server.contents[path.path])
            else:
                self._send(HTTPStatus.NOT_FOUND, "text/plain", b"there is no such page")
        except (ValueError, ContactError) as mistake:
            self._send(HTTPStatus.BAD_REQUEST, "text/plain", str(mistake).encode())
        except (BrokenPipeError, ConnectionResetError):
            pass  # the page has moved on to another setting

    def _answer(self, words: dict[str, str]) -> None:
        """Send a setting's answer, or nothing if the page has moved on to a later setting."""
        part, page = words.pop("part", "contact"), words.pop("client", "")
        turn = int(words.pop("turn", "0"))
        if part not in PARTS:
            raise ValueError(f'there is no part "{part}": give one of {", ".join(PARTS)}')
        with self.server.turns.taken(page, turn) as wanted:
            if not wanted:
                self._send(HTTPStatus.NO_CONTENT)
                return
            setting = Setting.of_words(words, self.server.file)
            content = json.dumps(answer(setting, part, self.server.units)).encode()
        self._send(HTTPStatus.OK, "application/json", content)

    def _send(self, status: HTTPStatus, kind: str = "", content: bytes = b"") -> None:
        self.send_response(status)
        if content:
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: Any) -> None:
        """Write nothing: requests are of no interest."""


def serve(
    file: Scene | None, port: int, announce: Callable[[str], None], units: Units | None = None
) -> None:
    """Serve the page until Ctrl-C; `announce` is called with its address."""
    with LiveServer(file, port, units) as server:
        announce(server.address)
        server.serve_forever(poll_interval=0.1)
