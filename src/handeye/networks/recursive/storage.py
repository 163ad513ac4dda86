"""A recursive network as one file."""

from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks.inputs import InputSpace
from handeye.networks.recursive.learner import Learner
from handeye.networks.recursive.posterior import refactor, with_block
from handeye.networks.recursive.units import LONGEST

if TYPE_CHECKING:
    from handeye.networks.recursive.network import RecursiveNetwork

FORMAT = "handeye.recursive_network"
VERSION = 1


def save(network: "RecursiveNetwork", path: str | PathLike[str]) -> None:
    """Write the network; an old file is replaced only once the new one is complete."""
    learner = network._learner  # pyright: ignore[reportPrivateUsage]
    units, pending, information, prior = learner.posterior
    known = learner.known
    arrays = {
        "low": network.inputs.low,
        "high": network.inputs.high,
        "box_scales": network.inputs.scales,
        "scales": network.scales,
        "first": network._first,  # pyright: ignore[reportPrivateUsage]
        "points": learner.points[: learner.waiting],
        "noise": learner.noise,
        "signal": np.zeros(0) if learner.signal is None else learner.signal,
        "coupling": pending.coupling[:known, :known],
        "innovations": pending.innovations[:known],
    }
    for b, n in enumerate(units.counts):
        upper = np.triu_indices(n)
        arrays |= {
            f"centers {b}": units.centers[b, :, :n],
            f"weights {b}": units.weights[b, :, :n],
            f"information {b}": information[b][upper],
            f"prior {b}": prior[b][upper],
            f"responses {b}": pending.responses[b, :known, :n],
            f"solved {b}": pending.solved[b, :n, :known],
        }
    header = {
        "n_inputs": network.n_inputs,
        "n_outputs": network.n_outputs,
        "capacity": network.capacity,
        "settings": network.settings._asdict(),
        "trials": network.trials,
        "noise_ratio": learner.settings.noise_ratio,
        "known": known,
        "blocks": len(units.counts),
    }
    write_tensors(path, FORMAT, VERSION, arrays, header)


def load(path: str | PathLike[str]) -> "RecursiveNetwork":
    """Read what `save` wrote; FileFormatError says what is wrong with any other file."""
    arrays, header = read_tensors(path, FORMAT, VERSION, "a stored recursive network")
    try:
        return _from_arrays(arrays, header)
    except (LookupError, MemoryError, TypeError, ValueError) as error:
        raise FileFormatError(
            f"{path}: damaged, its parts do not fit together ({error})"
        ) from error


def _from_arrays(arrays: dict[str, Array], header: dict[str, Any]) -> "RecursiveNetwork":
    from handeye.networks.recursive.network import RecursiveNetwork  # noqa: PLC0415 (a cycle)

    d, m = header["n_inputs"], header["n_outputs"]
    settings = dict(header["settings"])
    network = RecursiveNetwork(
        d,
        m,
        inputs=InputSpace(arrays["low"], arrays["high"], arrays["box_scales"]),
        capacity=header["capacity"],
        **settings,
    )
    scales = shaped(arrays["scales"], (d,), "scales")
    trials = count(header["trials"], "trials", least=0)
    first = shaped(arrays["first"], (None, d + m), "first")
    ratio = scalar(header["noise_ratio"], "noise_ratio", above=0.0)
    learner = Learner(d, m, network.capacity, network.settings._replace(noise_ratio=ratio))
    learner.trials = trials
    learner.known = count(header["known"], "known", least=0)
    learner.noise = shaped(arrays["noise"], (m,), "noise")
    if len(arrays["signal"]):
        learner.signal = shaped(arrays["signal"], (m,), "signal")
    points = shaped(arrays["points"], (None, d), "points")
    if max(learner.known, len(points)) > LONGEST or not np.all(scales > 0.0):
        raise InvalidInput("it is not the state of a network")
    learner.waiting = len(points)
    learner.points[: len(points)] = points
    blocks = count(header["blocks"], "blocks")
    for _ in range(blocks - 1):
        learner.posterior = with_block(learner.posterior)
    for b in range(blocks):
        _restore_block(learner, arrays, b)
    q, pending = learner.known, learner.posterior.pending
    pending.coupling[:q, :q] = shaped(arrays["coupling"], (q, q), "coupling")
    pending.innovations[:q] = shaped(arrays["innovations"], (q, m), "innovations")
    refactor(learner.posterior)
    network._take_over(learner, scales, trials, first)  # pyright: ignore[reportPrivateUsage]
    return network


def _restore_block(learner: Learner, arrays: dict[str, Array], b: int) -> None:
    units, pending, information, prior = learner.posterior
    q, n = learner.known, arrays[f"centers {b}"].shape[-1]
    _, d, size = units.centers.shape
    if n > size:
        raise InvalidInput(f"{n} neurons in a block of {size}")
    units.counts[b] = n
    units.centers[b, :, :n] = shaped(arrays[f"centers {b}"], (d, n), "centers")
    units.weights[b, :, :n] = shaped(arrays[f"weights {b}"], (units.weights.shape[1], n), "weights")
    upper = np.triu_indices(n)
    for matrix, name in ((information, "information"), (prior, "prior")):
        matrix[b][upper] = shaped(arrays[f"{name} {b}"], (len(upper[0]),), name)
    pending.responses[b, :q, :n] = shaped(arrays[f"responses {b}"], (q, n), "responses")
    pending.solved[b, :n, :q] = shaped(arrays[f"solved {b}"], (n, q), "solved")
