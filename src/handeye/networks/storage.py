"""A network as plain arrays and JSON-able settings, and as one file of them."""

from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

from handeye.arrays import Array, finite, scalar
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks.adaptation import RULES
from handeye.networks.inputs import InputSpace
from handeye.networks.responses import RESPONSES
from handeye.networks.schedules import SCHEDULES
from handeye.networks.units import Units

if TYPE_CHECKING:
    from handeye.networks.network import ResourceAllocatingNetwork

FORMAT = "handeye.network"
VERSION = 1
_KINDS = {"response": RESPONSES, "schedule": SCHEDULES, "adaptation": RULES}


def checked_kind(role: str, kind: NamedTuple) -> NamedTuple:
    """`kind` with plain numbers in its fields.

    Raises InvalidInput unless it is an instance of a registered class of that role and its fields
    are finite numbers.
    """
    known = _KINDS[role]
    if known.get(type(kind).__name__) is not type(kind):
        hint = f" (an instance, {kind.__name__}(), not the class)" if isinstance(kind, type) else ""
        raise InvalidInput(
            f"{role} must be one of {', '.join(sorted(known))}{hint}, got {kind!r}; "
            "docs/how-to/extend-networks.md shows how to add a kind"
        )
    numbers = {name: scalar(value, f"{role} {name}") for name, value in kind._asdict().items()}
    # 1 for 1.0 would compile everything once more; but a kind may count with a whole number.
    counts = {k for k, v in type(kind).__annotations__.items() if v in {int, "int"}}
    return kind._replace(**{k: int(v) if k in counts else v for k, v in numbers.items()})


def to_arrays(network: "ResourceAllocatingNetwork") -> tuple[dict[str, Array], dict[str, Any]]:
    """The arrays and the JSON-able rest of a network.

    Raises InvalidInput for a network that has diverged: `from_arrays` refuses what is not finite.
    """
    n, units = network.n_neurons, network._units  # pyright: ignore[reportPrivateUsage]
    arrays = {
        "centers": units.centers[:, :n],
        "widths": units.widths[:n],
        "weights": units.weights[:, :n],
        "low": network.inputs.low,
        "high": network.inputs.high,
        "scales": network.inputs.scales,
    }
    for name, array in arrays.items():
        finite(array, name)
    rest: dict[str, Any] = {
        "trials": network.trials,
        "capacity": network.capacity,
        "settings": {k: v for k, v in network.settings._asdict().items() if k != "diameter"},
    }
    for role in _KINDS:
        kind = getattr(network, role)
        rest[role] = {"kind": type(kind).__name__, **kind._asdict()}
    return arrays, rest


def from_arrays(arrays: dict[str, Array], rest: dict[str, Any]) -> "ResourceAllocatingNetwork":
    """The network of `to_arrays`.

    Raises FileFormatError, or what Python raises where parts are missing or do not fit together.
    """
    from handeye.networks.network import ResourceAllocatingNetwork  # noqa: PLC0415 (a cycle)

    kinds: dict[str, Any] = {}
    for role, known in _KINDS.items():
        fields = dict(rest[role])
        name = fields.pop("kind")
        if name not in known:
            raise FileFormatError(
                f"it uses the {role} {name!r}, which is not registered: import the module that "
                f"defines it before loading (known: {', '.join(sorted(known))})"
            )
        kinds[role] = known[name](**fields)
    network = ResourceAllocatingNetwork(
        len(arrays["centers"]),
        len(arrays["weights"]),
        inputs=InputSpace(arrays["low"], arrays["high"], arrays["scales"]),
        capacity=rest["capacity"],
        **kinds,
        **rest["settings"],
    )
    units = Units(arrays["centers"], arrays["widths"], arrays["weights"])
    network._restore(units, rest["trials"])  # pyright: ignore[reportPrivateUsage]
    return network


def save(network: "ResourceAllocatingNetwork", path: str | PathLike[str]) -> None:
    """Write the network; an old file is replaced only once the new one is complete."""
    arrays, rest = to_arrays(network)
    write_tensors(path, FORMAT, VERSION, arrays, rest)


def load(path: str | PathLike[str]) -> "ResourceAllocatingNetwork":
    """Read what `save` wrote; FileFormatError says what is wrong with any other file."""
    arrays, rest = read_tensors(path, FORMAT, VERSION, "a stored handeye network")
    try:
        return from_arrays(arrays, rest)
    except FileFormatError as error:
        raise FileFormatError(f"{path}: {error}") from error
    except (
        AttributeError,
        LookupError,
        MemoryError,
        OverflowError,
        TypeError,
        ValueError,
    ) as error:
        raise FileFormatError(
            f"{path}: damaged, its parts do not fit together ({error})"
        ) from error
