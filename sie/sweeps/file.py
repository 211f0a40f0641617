"""A file that holds the answers of a sweep while they are computed: NetCDF or Zarr, by xarray.

The file is readable at any moment, also after the process was killed. A NetCDF file is replaced in
one step. The arrays of a Zarr store are written anew in place, first the values, then the reasons;
points turn from nan into their values, so any mixture of old and new is right. Where a shape has
changed, the whole store is replaced, which takes two steps.
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
        self._write, self._path = _no_file if path is None else _writer(Path(path)), path
        self._due = perf_counter() + PERIOD

    def grow(self, result: Callable[[], Any]) -> None:
        """Write the result if the last write was long enough ago.

        A write that fails is tried again later; `finish` is the last, and tells.
        """
        begin = perf_counter()
        if self._path is None or begin < self._due:
            return
        with suppress(OSError):
            self._write(result())
        end = perf_counter()
        self._due = end + max(PERIOD, SHARE * (end - begin))

    def finish(self, result: Any) -> Any:
        """Write the result and return it. OSError with the result if it cannot be written."""
        try:
            self._write(result)
        except OSError as problem:
            raise Unwritten(str(problem), result) from None
        return result


def _no_file(_: Any) -> None: ...


def _writer(path: Path) -> Callable[[Any], None]:
    """What writes to a path. ValueError if nothing can be written there."""
    writers = {".nc": (_write_netcdf, ("xarray",)), ".zarr": (_write_zarr, ("xarray", "zarr"))}
    if path.suffix not in writers:
        raise ValueError(f"to = {str(path)!r} is of no kind known: let it end in .nc or .zarr")
    write, needed = writers[path.suffix]
    missing = [name for name in needed if not find_spec(name)]
    if missing:
        absent = " and ".join(missing)
        raise ValueError(f"to = {str(path)!r} needs {absent}: pip install {' '.join(missing)}")
    if path.exists():
        raise ValueError(f"to = {str(path)!r} exists: remove it, or give another name")
    files.writable(path)
    return lambda data: write(data, path)


def _write_netcdf(data: Any, path: Path) -> None:
    # Objects are text here; not all versions of the libraries find that out themselves.
    text = {n: v.astype(str) for n, v in data.variables.items() if v.dtype == object}
    with TemporaryDirectory() as folder:
        data.assign(text).to_netcdf(Path(folder, path.name))
        files.write_files({path: Path(folder, path.name).read_bytes()})


def _write_zarr(data: Any, path: Path) -> None:
    values = data.drop_vars(["reason", *data.coords])
    try:
        values.to_zarr(path, mode="r+")
        data[["reason"]].drop_vars(list(data.coords)).to_zarr(path, mode="r+")
    except (FileNotFoundError, ValueError):  # it is new, or a shape has changed
        _replace_zarr(data, path)


def _replace_zarr(data: Any, path: Path) -> None:
    """The whole store in the place of the old one."""
    with TemporaryDirectory(dir=path.parent, prefix=".sie-") as folder:
        new = Path(folder, "new")
        # Zarr has no specification of text in its format 3 yet.
        data.to_zarr(new, mode="w-", zarr_format=2)
        if path.exists():
            path.rename(Path(folder, "old"))
        new.rename(path)
