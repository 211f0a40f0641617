"""Read regular files of limited size, and write files whole or not at all.

A file is written under another name beside its place and then moved there; the move is one step, so
that no reader opens half a file. A writer that is killed may leave a file ".sie-*.part" behind.
"""

from __future__ import annotations

import math
import os
import secrets
import shutil
import stat
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

KINDS = {
    stat.S_ISDIR: "a directory",
    stat.S_ISFIFO: "a pipe",
    stat.S_ISSOCK: "a socket",
    stat.S_ISCHR: "a device",
    stat.S_ISBLK: "a device",
}


# -- reading -------------------------------------------------------------------------------------


def named(path: str | Path) -> Path:
    """The path of a file that is named; ValueError, with the remedy, if the name is empty."""
    if not os.fspath(path):
        raise ValueError("the name of the file is empty: give one")
    return Path(path)


def content(path: str | Path, most: int) -> bytes:
    """The bytes of a regular file, at most so many.

    ValueError, with the remedy, if it is none (a device or a pipe may have no end) or is longer;
    OSError.
    """
    path = Path(path)
    mode = path.stat().st_mode
    for is_kind, kind in KINDS.items():
        if is_kind(mode):
            raise ValueError(f"{path.name or path} is {kind}: give a regular file")
    with open(path, "rb") as stream:
        data = stream.read(most + 1)  # some files of /proc report no length, and have no end
    if len(data) > most:
        raise ValueError(f"{path.name} has more than {most / 1e6:g} MB: give a shorter file")
    return data


# -- where a file may be written -----------------------------------------------------------------


def writable(path: str | Path) -> Path:
    """The path, if a file can be written there; ValueError, with the remedy, if not."""
    path = Path(path)
    if path.is_dir():
        raise ValueError(f"{path} is a directory: give the name of a file in it")
    parent = path.resolve().parent
    if not parent.is_dir():
        raise ValueError(
            f"{path} cannot be written, there is no directory {parent}: create it first"
        )
    touched = ([path] if path.exists() else []) + ([] if _is_device(path) else [parent])
    if not all(os.access(place, os.W_OK) for place in touched):
        raise ValueError(f"{path} cannot be written, permission is denied: choose another place")
    return path


def empty_folder(path: str | Path) -> Path:
    """The path, if it is a folder without files or one can be made there; ValueError if not."""
    path = Path(path)
    if not path.exists():
        return writable(path)
    if not path.is_dir():
        raise ValueError(f"{path} is no directory: give the name of a new or an empty one")
    if any(path.iterdir()):
        raise ValueError(f"{path} has files: give the name of a new or an empty directory")
    return writable(path / "file").parent


def same(one: str | int | Path, other: str | int | Path) -> bool:
    """Whether both are one file, or would be one once written.

    Links, and names that differ in case only, count. A number is the descriptor of an open file.
    """
    try:
        return os.path.samefile(one, other)
    except OSError:  # one of them does not exist
        if isinstance(one, int) or isinstance(other, int):
            return False
        places = [Path(place) for place in (one, other)]
        first, second = (str(place.resolve()).casefold() for place in places)
        return first == second and not any(place.exists() for place in places)


def table_of_columns(head: Sequence[str], columns: Mapping[str, Any]) -> str:
    """Columns, arrays, as CSV below lines of comment, with all digits; nan is an empty cell."""
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    lines = [*(f"# {line}" for line in head), ",".join(columns)]
    lines += [",".join("" if math.isnan(v) else repr(v) for v in row) for row in rows]
    return "\n".join(lines) + "\n"


def table_of_rows(rows: list[dict[str, float]]) -> Any:
    """A DataFrame of the rows where pandas is installed, otherwise these."""
    try:
        import pandas  # type: ignore[import, unused-ignore]  # noqa: PLC0415
    except ImportError:
        return rows
    return pandas.DataFrame(rows)


# -- writing -------------------------------------------------------------------------------------


def write_files(contents: Mapping[Path, bytes]) -> None:
    """Write all files. Raises OSError; what was there before is then still there."""
    with writing(contents):
        pass


@contextmanager
def writing(contents: Mapping[Path, bytes]) -> Iterator[None]:
    """Write all files; they are at their places after the block, or untouched if it fails.

    A BrokenPipeError in the block is no failure. A device or a pipe cannot be replaced and is
    written to as it is. Raises OSError.
    """
    parts: dict[Path, Path] = {}
    try:
        with _named(contents):
            devices = [path for path in contents if _is_device(path)]
            for path in (path for path in contents if path not in devices):
                place = path.resolve()  # a link stays a link
                parts[place] = place.with_name(f".sie-{secrets.token_hex(8)}.part")
                _write_part(parts[place], contents[path], like=place)
            for path in devices:
                path.write_bytes(contents[path])
        try:
            yield
        except BrokenPipeError:
            _move(parts, contents)
            raise
        _move(parts, contents)
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)


def _write_part(part: Path, data: bytes, like: Path) -> None:
    with open(part, "xb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())
    if like.exists():
        shutil.copymode(like, part)


def _move(parts: Mapping[Path, Path], contents: Iterable[Path]) -> None:
    with _named(contents):
        for place, part in parts.items():
            os.replace(part, place)


@contextmanager
def _named(contents: Iterable[Path]) -> Iterator[None]:
    """Put the names of the files in front of the system's message."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as problem:
        raise OSError(
            f"{' and '.join(map(str, contents))} not written: {problem.strerror}"
        ) from None


def _is_device(path: Path) -> bool:
    return path.exists() and not path.is_file()
