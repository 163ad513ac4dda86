"""Where measurements of real robots lie: they are not part of the package."""

import os
from pathlib import Path

_CHECKOUT = Path(__file__).resolve().parents[3]

ABSENT = (
    "Not run: data absent. Set HANDEYE_SHARED to the folder that holds `data` with the real "
    "measurements."
)


def real_data(name: str) -> Path | None:
    """The folder of measurements `name` ("ball_in_sockets"), None where it is absent.

    Looked for in the folder `data` of what HANDEYE_SHARED names, else of `shared` beside the
    checkout.
    """
    shared = Path(os.environ.get("HANDEYE_SHARED") or _CHECKOUT.parent / "shared")
    folder = shared / "data" / name
    return folder if folder.is_dir() else None
