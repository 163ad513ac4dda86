"""Arrays and a JSON header in one safetensors file: data, never code."""

import hashlib
import json
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save as to_bytes

from handeye.arrays import Array
from handeye.errors import FileFormatError
from handeye.io.files import replace_file

Header = dict[str, Any]
Parts = tuple[dict[str, Array], Header]
"""What a file holds: arrays by name, and the JSON-able rest."""

T = TypeVar("T")


def write_tensors(
    path: str | PathLike[str],
    kind: str,
    version: int,
    arrays: dict[str, Array],
    header: Header,
) -> None:
    """Write a file of `kind`, such as "handeye.network"; an old one is replaced at the very end.

    `header` is whatever JSON can hold. The file is in the format safetensors; kind, version, header
    and a SHA-256 of everything stand in its metadata.

    Raises OSError as the operating system gives it, TypeError for a header that JSON cannot hold.
    """
    text = json.dumps(header)
    contiguous: Any = {name: np.ascontiguousarray(a) for name, a in arrays.items()}
    metadata = {
        "format": kind,
        "version": str(version),
        "header": text,
        "sha256": _digest(contiguous, text),
    }
    replace_file(path, to_bytes(contiguous, metadata=metadata))


def read_tensors(path: str | PathLike[str], kind: str, version: int, title: str) -> Parts:
    """Read what `write_tensors` wrote; `title` names the kind of file for a person.

    Raises:
        FileFormatError: no such file, damaged, another kind, or a newer version.
    """
    file = Path(path)
    if not file.is_file():
        raise FileFormatError(f"{file}: no such file")
    try:
        with cast("Any", safe_open(file, framework="numpy")) as tensors:
            metadata: dict[str, str] = tensors.metadata() or {}
            if metadata.get("format") != kind:
                raise FileFormatError(f"{file}: not {title}")
            if int(metadata["version"]) > version:
                raise FileFormatError(
                    f"{file}: written in format {metadata['version']} by a newer handeye (this one "
                    f"reads up to {version}): update handeye"
                )
            names: list[str] = list(tensors.keys())
            arrays = {name: tensors.get_tensor(name) for name in names}
            if metadata["sha256"] != _digest(arrays, metadata["header"]):
                raise FileFormatError(f"{file}: damaged, what is in it is not what was written")
            return arrays, json.loads(metadata["header"])
    except (SafetensorError, KeyError, TypeError, ValueError, OSError) as error:
        raise FileFormatError(f"{file}: damaged, or not {title} ({error})") from error


def restore(
    path: str | PathLike[str],
    kind: str,
    version: int,
    title: str,
    build: Callable[[dict[str, Array], Header], T],
) -> T:
    """What `build` makes of the arrays and the header that `write_tensors` wrote.

    `build` may raise whatever Python raises where they do not fit together.

    Raises:
        FileFormatError: as `read_tensors`, and for parts of which nothing can be built.
    """
    arrays, header = read_tensors(path, kind, version, title)
    try:
        return build(arrays, header)
    except FileFormatError as error:
        raise FileFormatError(f"{path}: {error}") from error
    except (
        AttributeError, LookupError, MemoryError, OverflowError, TypeError, ValueError,
    ) as error:  # fmt: skip
        raise FileFormatError(
            f"{path}: damaged, its parts do not fit together ({error})"
        ) from error


def _digest(arrays: dict[str, Array], header: str) -> str:
    """Changes with every bit of what is stored."""
    digest = hashlib.sha256(header.encode())
    for name, array in sorted(arrays.items()):
        digest.update(f"{name} {array.dtype} {array.shape}".encode() + array.tobytes())
    return digest.hexdigest()
