"""Putting a finished file in its place."""

import os
import tempfile
from pathlib import Path

from handeye.errors import InvalidInput


def write_file(target: Path, content: bytes) -> None:
    """Write `content` to `target`, making its folders; what stood there is replaced as a whole.

    A reader sees the old file or the new one, never half of one. Raises InvalidInput with the
    reason when the place cannot be written to.
    """
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        _replace(target, content)
    except OSError as refused:
        reason = refused.strerror or str(refused)
        raise InvalidInput(
            f"{target}: cannot be written ({reason}); choose a folder that you may write to"
        ) from refused


def _replace(target: Path, content: bytes) -> None:
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:40]}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
