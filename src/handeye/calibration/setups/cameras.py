"""The cameras of a description: their numbers as stated there, or in a camera_info file of ROS."""

from collections.abc import Sequence
from pathlib import Path

from handeye.arrays import Array
from handeye.calibration.arm.measurements import Numbers, lens
from handeye.io.yaml_entries import Entry, read_yaml

_BARE, _COMMON = ("matrix", "distortion"), ("within", "size")


def read_cameras(
    named: Sequence[tuple[str, Entry]], folder: Path
) -> tuple[dict[str, Numbers], dict[str, tuple[int, int]]]:
    """Cameras by name, and the sizes (width, height) of their pictures where they are stated.

    folder: where camera_info files are looked for.

    Raises:
        InvalidInput: with file, line and key.
        FileFormatError: a camera_info file that is not YAML.
    """
    cameras: dict[str, Numbers] = {}
    sizes: dict[str, tuple[int, int]] = {}
    for name, entry in named:
        cameras[name], size = _camera(name, entry, folder)
        if size is not None:
            sizes[name] = size
    return cameras, sizes


def _camera(name: str, entry: Entry, folder: Path) -> tuple[Numbers, tuple[int, int] | None]:
    keys = entry.table((*_BARE, *_COMMON, "camera_info"))
    if ("matrix" in keys) == ("camera_info" in keys):
        raise entry.error("needs either `matrix` (fx, fy, cx, cy) or `camera_info`, a file of ROS")
    within = keys["within"].numbers() if "within" in keys else 0.0
    if "camera_info" in keys:
        if "distortion" in keys or "size" in keys:
            raise entry.error("`camera_info` has distortion and size already: leave them out here")
        four, five, size = _ros(folder / keys["camera_info"].text())
    else:
        four = keys["matrix"].numbers()
        five: list[float] = keys["distortion"].numbers().tolist() if "distortion" in keys else []
        size = _size(keys["size"]) if "size" in keys else None
    with entry.blamed():
        return lens(name, four.tolist(), five, within), size


def _size(entry: Entry) -> tuple[int, int]:
    parts = entry.items()
    if len(parts) != 2 or any(part.whole() < 1 for part in parts):
        raise entry.error("must be [width, height] in pixels")
    return parts[0].whole(), parts[1].whole()


def _ros(path: Path) -> tuple[Array, list[float], tuple[int, int]]:
    """fx, fy, cx, cy; distortion; width and height."""
    whole = read_yaml(path)
    keys = whole.tables()
    needed = ("image_width", "image_height", "camera_matrix", "distortion_coefficients")
    missing = [key for key in needed if key not in keys]
    if missing:
        raise whole.error(f"lacks {', '.join(missing)}: give a camera_info file as ROS writes it")
    if "distortion_model" in keys:
        keys["distortion_model"].text(("plumb_bob",))
    K, distortion = (
        keys[key].table(("rows", "cols", "data"), ("data",))["data"].numbers()
        for key in ("camera_matrix", "distortion_coefficients")
    )
    if K.shape != (9,):
        raise keys["camera_matrix"].error("must have 9 numbers under data")
    size = keys["image_width"].whole(), keys["image_height"].whole()
    return K[[0, 4, 2, 5]], distortion.tolist(), size
