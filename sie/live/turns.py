"""The order in which a server works: one answer at a time, and none that nobody waits for."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Condition

PAGES = 64  # that are remembered: a page that is forgotten is answered like a new one


class Turns:
    """Requests that wait for a computation.

    A page numbers its settings: those of a later one leave no use for the answers before.
    """

    def __init__(self) -> None:
        self._change = Condition()
        self._busy = False
        self._newest: OrderedDict[str, int] = OrderedDict()

    @contextmanager
    def taken(self, page: str, turn: int) -> Iterator[bool]:
        """Wait until no other request is worked on; False at once if the page has moved on."""
        with self._change:
            self._note(page, turn)
            self._change.wait_for(lambda: not self._busy or self._late(page, turn))
            wanted = not self._late(page, turn)
            self._busy = self._busy or wanted
        try:
            yield wanted
        finally:
            if wanted:
                with self._change:
                    self._busy = False
                    self._change.notify_all()

    def _note(self, page: str, turn: int) -> None:
        self._newest[page] = max(turn, self._newest.pop(page, turn))
        while len(self._newest) > PAGES:
            self._newest.popitem(last=False)
        self._change.notify_all()

    def _late(self, page: str, turn: int) -> bool:
        return turn < self._newest.get(page, turn)
