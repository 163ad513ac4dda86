"""What kind of stored thing a file is, without reading all of it."""

from os import PathLike
from typing import Any, cast

from safetensors import SafetensorError, safe_open

from handeye.errors import FileFormatError


def kind_of(path: str | PathLike[str]) -> str:
    """The format that a file of `handeye.io.tensors` says it has, such as "handeye.network".

    Raises:
        FileFormatError: no such file, or one of another program.
    """
    try:
        with cast("Any", safe_open(path, framework="numpy")) as tensors:
            metadata: dict[str, str] = tensors.metadata() or {}
    except FileNotFoundError as error:
        raise FileFormatError(f"{path}: no such file") from error
    except (SafetensorError, OSError) as error:
        raise FileFormatError(f"{path}: damaged, or not stored by handeye ({error})") from error
    if "format" not in metadata:
        raise FileFormatError(f"{path}: was not stored by handeye")
    return metadata["format"]
