"""Files are written whole or not at all."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Mapping
from pathlib import Path


def writable(path: str | Path) -> Path:
    """The path, if a file can be written there; ValueError, with the remedy, if not. Nothing is written."""
    path = Path(path)
    if path.is_dir():
        raise ValueError(f"{path} is a directory: give the name of a file in it")
    parent = path.resolve().parent
    if not parent.is_dir():
        raise ValueError(f"{path} cannot be written, there is no directory {parent}: create it first")
    touched = ([path] if path.exists() else []) + ([] if _is_device(path) else [parent])
    if not all(os.access(place, os.W_OK) for place in touched):
        raise ValueError(f"{path} cannot be written, permission is denied: choose another place")
    return path


def write_files(contents: Mapping[Path, bytes]) -> None:
    """Write all files. Each is first written beside its place, then moved there, so that none is ever seen half written.

    A device or a pipe cannot be replaced and is written to as it is. Raises OSError; what was there before is then still there.
    """
    parts: dict[Path, Path] = {}
    try:
        for path, data in contents.items():
            if _is_device(path):
                path.write_bytes(data)
            else:
                place = path.resolve()  # a link stays a link
                parts[place] = place.with_name(f".{secrets.token_hex(8)}.part")
                _write_part(parts[place], data, like=place)
        for place, part in parts.items():
            os.replace(part, place)
    except OSError as problem:
        raise OSError(f"{' and '.join(map(str, contents))} not written: {problem.strerror}") from None
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)


def _write_part(part: Path, data: bytes, like: Path) -> None:
    with open(part, "xb") as stream:
        stream.write(data)
    if like.exists():
        shutil.copymode(like, part)


def _is_device(path: Path) -> bool:
    return path.exists() and not path.is_file()
