"""A layered network as one file."""

from os import PathLike
from typing import TYPE_CHECKING, Any

from handeye.arrays import Array, finite
from handeye.errors import FileFormatError
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks.inputs import InputSpace
from handeye.networks.layered.activations import ACTIVATIONS

if TYPE_CHECKING:
    from handeye.networks.layered.network import LayeredNetwork

FORMAT = "handeye.layered"
VERSION = 1


def save(network: "LayeredNetwork", path: str | PathLike[str]) -> None:
    """Write the network; an old file is replaced only once the new one is complete.

    Raises InvalidInput for a network that has diverged: `load` refuses what is not finite.
    """
    arrays = {
        "weights": network._weights,  # pyright: ignore[reportPrivateUsage]
        "output_scale": network.output_scale,
        "low": network.inputs.low,
        "high": network.inputs.high,
        "scales": network.inputs.scales,
    }
    for name, array in arrays.items():
        finite(array, name)
    header: dict[str, Any] = {
        "hidden": list(network.hidden),
        "rate": network.rate,
        "trials": network.trials,
    }
    for role, kind in zip(("activation", "output"), network.kinds, strict=True):
        header[role] = {"kind": type(kind).__name__, **kind._asdict()}
    write_tensors(path, FORMAT, VERSION, arrays, header)


def load(path: str | PathLike[str]) -> "LayeredNetwork":
    """Read what `save` wrote; FileFormatError says what is wrong with any other file."""
    arrays, header = read_tensors(path, FORMAT, VERSION, "a stored layered network")
    try:
        return _network(arrays, header)
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


def _network(arrays: dict[str, Array], header: dict[str, Any]) -> "LayeredNetwork":
    from handeye.networks.layered.network import LayeredNetwork  # noqa: PLC0415 (a cycle)

    kinds: dict[str, Any] = {}
    for role in ("activation", "output"):
        fields = dict(header[role])
        name = fields.pop("kind")
        if name not in ACTIVATIONS:
            raise FileFormatError(
                f"it uses the {role} {name!r}, which is not registered: import the module that "
                f"defines it before loading (known: {', '.join(sorted(ACTIVATIONS))})"
            )
        kinds[role] = ACTIVATIONS[name](**fields)
    network = LayeredNetwork(
        arrays["low"].size,
        arrays["output_scale"].size,
        header["hidden"],
        inputs=InputSpace(arrays["low"], arrays["high"], arrays["scales"]),
        output_scale=arrays["output_scale"],
        rate=header["rate"],
        **kinds,
    )
    network._restore(arrays["weights"], header["trials"])  # pyright: ignore[reportPrivateUsage]
    return network
