"""A learner as one file: its settings, every network, and what it replays."""

from dataclasses import asdict
from os import PathLike
from typing import TYPE_CHECKING, Any, cast

from handeye.arrays import Array, count
from handeye.catching.comparator import Comparator
from handeye.catching.settings import CatcherSettings, Tuning
from handeye.catching.skills import Samples
from handeye.errors import FileFormatError
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks.storage import from_arrays, to_arrays

if TYPE_CHECKING:
    from handeye.catching.learner import Learner

FORMAT = "handeye.catcher"
VERSION = 1
_EXPERIENCE = ("experienced_inputs", "experienced_outputs")


def save(learner: "Learner", path: str | PathLike[str]) -> None:
    """Write everything a learner knows; an old file is replaced only once the new is complete."""
    arrays: dict[str, Array] = {}
    networks: dict[str, Any] = {}
    for name, skill in learner.repertoire.skills():
        inside, networks[name] = to_arrays(skill.network)
        inside |= dict(zip(_EXPERIENCE, skill.experience, strict=True))
        arrays |= {f"{name}/{part}": array for part, array in inside.items()}
    header = {
        "settings": asdict(learner.settings),
        "n_balls": learner.n_balls,
        "n_arms": learner.n_arms,
        "pursuits": learner.pursuits,
        "tosses": learner.tosses,
        "mentored": learner.mentored,
        "networks": networks,
    }
    write_tensors(path, FORMAT, VERSION, arrays, header)


def load(path: str | PathLike[str]) -> "Learner":
    """Read what `save` wrote; FileFormatError says what is wrong with any other file."""
    arrays, header = read_tensors(path, FORMAT, VERSION, "a learner that catches")
    try:
        return _learner(arrays, header)
    except (
        FileFormatError, AttributeError, LookupError, MemoryError, OverflowError, TypeError,
        ValueError,
    ) as error:  # fmt: skip
        raise FileFormatError(
            f"{path}: damaged, its parts do not fit together ({error})"
        ) from error


def _learner(arrays: dict[str, Array], header: dict[str, Any]) -> "Learner":
    from handeye.catching.learner import Learner  # noqa: PLC0415 (a cycle)

    learner = Learner(
        _settings(header["settings"]), n_balls=header["n_balls"], n_arms=header["n_arms"]
    )
    for name, skill in learner.repertoire.skills():
        prefix = f"{name}/"
        inside = {k.removeprefix(prefix): a for k, a in arrays.items() if k.startswith(prefix)}
        experience = Samples(*(inside.pop(part) for part in _EXPERIENCE))
        skill.take_over(from_arrays(inside, header["networks"][name]), experience)
    for name, room in (("pursuits", learner.pursuits), ("tosses", learner.tosses)):
        room[:] = [count(done, name, least=0) for _, done in zip(room, header[name], strict=True)]
    learner.mentored = count(header["mentored"], "mentored", least=0)
    return learner


def _settings(parts: dict[str, Any]) -> CatcherSettings:
    """The settings of `dataclasses.asdict`, after a trip through JSON."""
    return CatcherSettings(**{name: _setting(value) for name, value in parts.items()})


def _setting(value: Any) -> Any:
    """Lists become tuples again, and dictionaries what they were made from."""
    if isinstance(value, list):
        return tuple(cast("list[float]", value))
    if isinstance(value, dict):
        fields = {k: _setting(v) for k, v in cast("dict[str, Any]", value).items()}
        return (Comparator if "window" in fields else Tuning)(**fields)
    return value
