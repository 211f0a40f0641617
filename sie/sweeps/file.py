"""A NetCDF file that holds the answers of a sweep while they are computed, by xarray.

It is replaced in one step, and so readable at any moment, also after the process was killed.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from sie import files

PERIOD = 5.0  # seconds between two writes, at least
SHARE = 20.0  # the time between two writes over the time that the last one took, at least


class Unwritten(OSError):
    """The file of a sweep could not be written.

    Parameters
    ----------
    message : str
        What the system says.
    result : xarray.Dataset
        The answers.
    """

    def __init__(self, message: str, result: Any) -> None:
        super().__init__(f"{message}; the answers are in the exception's `result`")
        self.result = result


class SweepFile:
    """The file of a growing result; None for the path writes nothing."""

    def __init__(self, path: str | Path | None) -> None:
        self._path = None if path is None else _new_file(Path(path))
        self._due = perf_counter() + PERIOD

    def grow(self, result: Callable[[], Any]) -> None:
        """Write the result if the last write was long enough ago.

        A write that fails is tried again later; `finish` is the last, and tells.
        """
        begin = perf_counter()
        if self._path is None or begin < self._due:
            return
        with suppress(OSError):
            write(result(), self._path)
        end = perf_counter()
        self._due = end + max(PERIOD, SHARE * (end - begin))

    def finish(self, result: Any) -> Any:
        """Write the result and return it. OSError with the result if it cannot be written."""
        try:
            if self._path is not None:
                write(result, self._path)
        except OSError as problem:
            raise Unwritten(str(problem), result) from None
        return result


def _new_file(path: Path) -> Path:
    """The path. ValueError if nothing can be written there."""
    if path.suffix != ".nc":
        raise ValueError(f"to = {str(path)!r} is no NetCDF file: let it end in .nc")
    if not find_spec("xarray"):
        raise ValueError(f"to = {str(path)!r} needs xarray: pip install xarray")
    if path.exists():
        raise ValueError(f"to = {str(path)!r} exists: remove it, or give another name")
    return files.writable(path)


def write(data: Any, path: Path) -> None:
    """Write a Dataset to a file. Raises OSError."""
    # Objects are text here; not all versions of the libraries find that out themselves.
    text = {n: v.astype(str) for n, v in data.variables.items() if v.dtype == object}
    with TemporaryDirectory() as folder:
        data.assign(text).to_netcdf(Path(folder, path.name))
        files.write_files({path: Path(folder, path.name).read_bytes()})
