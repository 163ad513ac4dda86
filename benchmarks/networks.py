"""Speed, memory and error of the network beside others that learn online, on one stream.

    python benchmarks/networks.py [--json FILE]

Five inputs, two outputs. Every contestant first learns as many samples as it has neurons; a
resource-allocating network then has exactly that many. From then on all are timed by turns on the
same stream, several times over, and the median counts. Slow ones get fewer samples of each turn.
The three implementations of the same network must give the same numbers, or the script fails.

ours              handeye.networks
plain compiled    the straightforward Numba loop: one neuron after the other, math.exp for each
plain NumPy       the formulas over whole arrays
RBFSampler + SGD  scikit-learn: as many random Fourier features, one SGDRegressor for each output
river KNN         river: the nearest of as many stored samples, one KNNRegressor for each output
"""

import json
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from contestants import (
    Contestant,
    D,
    FourierSGD,
    Neighbours,
    Ours,
    Plain,
    PlainNumPy,
)
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

SIZES = (200, 1_000, 5_000, 13_000)
OPERATIONS = ("learn", "predict", "learn_many", "predict_many")


def stream(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Inputs (n, D) and smooth targets (n, M) of unit size, with one per cent of noise."""
    rng = np.random.default_rng(0)
    x = rng.random((n, D))
    y = np.column_stack(
        [
            np.sin(3.0 * x[:, 0] + 2.0 * x[:, 1]) * np.cos(2.0 * x[:, 2]) + x[:, 3] * x[:, 4],
            np.exp(-2.0 * ((x[:, 0] - 0.5) ** 2 + (x[:, 4] - 0.5) ** 2))
            + np.tanh(x[:, 1] - x[:, 2]),
        ]
    )
    y = (y - y.mean(axis=0)) / y.std(axis=0)
    return x, y + 0.01 * rng.normal(size=y.shape)


def assert_equal(ours: Ours, others: list[Plain], x: np.ndarray) -> float:
    """The same predictions within the bound of `handeye.networks.kernels.evaluate`, twice.

    Both sides may err by the bound. Returns the largest difference over what is allowed.
    """
    network = ours.network
    C, R, W = network.centers, network.widths, network.weights
    z = ((C[np.newaxis] - x[:, np.newaxis]) ** 2).sum(axis=2)
    o = np.exp(-z / R)
    allowed = 2.0 * 2.0**-53 * (len(R) * o + D + 12) @ np.abs(W)
    worst = max(
        float((np.abs(other.predict_many(x) - ours.predict_many(x)) / allowed).max())
        for other in others
    )
    if worst > 1.0:
        raise AssertionError(f"predictions differ by {worst:.2f} times the stated bound")
    return worst


def prequential(contestant: Contestant, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Errors (n, M) of predicting each sample before learning it."""
    errors = np.empty_like(y)
    for i in range(len(x)):
        errors[i] = y[i] - contestant.predict(x[i])
        contestant.learn(x[i], y[i])
    return errors


def timed(contestant: Contestant, operation: str, x: np.ndarray, y: np.ndarray) -> float:
    """Seconds for all of x."""
    call: Callable[..., Any] = getattr(contestant, operation)
    start = time.perf_counter()
    match operation:
        case "learn":
            for i in range(len(x)):
                call(x[i], y[i])
        case "predict":
            for i in range(len(x)):
                call(x[i])
        case "learn_many":
            call(x, y)
        case _:
            call(x)
    return time.perf_counter() - start


def compare(
    size: int, repeats: int, turn_s: float, tick: Callable[[], None]
) -> list[dict[str, Any]]:
    """One row of results for each contestant at this number of neurons."""
    judged, most = 100, 1_000
    x, y = stream(size + judged + most)
    fill, judge, turns = slice(size), slice(size, size + judged), slice(size + judged, None)
    ours = Ours(size, x[fill], y[fill])
    if ours.network.n_neurons != size:
        raise AssertionError(f"{ours.network.n_neurons} neurons instead of {size}")
    plain = [Plain(ours.network), PlainNumPy(ours.network)]
    of_bound = assert_equal(ours, plain, x[judge])
    contestants: list[Contestant] = [ours, *plain]
    contestants += [FourierSGD(size, x[fill], y[fill]), Neighbours(size, x[fill], y[fill])]
    tick()

    errors = {c.name: prequential(c, x[judge], y[judge]) for c in contestants}
    for other in plain:
        np.testing.assert_allclose(errors[other.name], errors[ours.name], rtol=1e-9, atol=1e-9)
    tick()

    seconds: dict[tuple[str, str], list[float]] = {}
    counts: dict[tuple[str, str], int] = {}
    for turn in range(-1, repeats):  # the first turn warms up and finds how many samples fit
        for operation in OPERATIONS:
            for contestant in contestants:
                key = contestant.name, operation
                n = counts.get(key, 4)
                try:
                    spent = timed(contestant, operation, x[turns][:n], y[turns][:n])
                    if turn < 0:
                        spent = timed(contestant, operation, x[turns][:n], y[turns][:n])
                        counts[key] = int(np.clip(turn_s / (spent / n), 4, most))
                    else:
                        seconds.setdefault(key, []).append(spent / n)
                except NotImplementedError:
                    continue
        tick()
    return [
        {
            "neurons": size,
            "contestant": c.name,
            "per_second": {
                operation: 1.0 / statistics.median(spent)
                for operation in OPERATIONS
                if (spent := seconds.get((c.name, operation)))
            },
            "per_second_best": {
                operation: 1.0 / min(spent)
                for operation in OPERATIONS
                if (spent := seconds.get((c.name, operation)))
            },
            "bytes_per_neuron": c.bytes_per_neuron(),
            "prequential_nmse": (errors[c.name] ** 2).mean(axis=0).tolist(),
            "difference_over_bound": of_bound if c in plain else None,
        }
        for c in contestants
    ]


def table(rows: list[dict[str, Any]]) -> Table:
    """For people."""
    shown = Table(title="samples per second (median over turns)", caption=(
        "nMSE: mean squared error before learning, of targets of unit variance, on 100 samples"
    ))  # fmt: skip
    shown.add_column("neurons", justify="right")
    shown.add_column("contestant")
    for name in (*OPERATIONS, "bytes/neuron", "nMSE 1", "nMSE 2"):
        shown.add_column(name, justify="right")
    for row in rows:
        speeds = [row["per_second"].get(operation) for operation in OPERATIONS]
        shown.add_row(
            f"{row['neurons']:,}",
            row["contestant"],
            *("-" if speed is None else f"{speed:,.0f}" for speed in speeds),
            f"{row['bytes_per_neuron']:,.0f}",
            *(f"{error:.4f}" for error in row["prequential_nmse"]),
            end_section=row is rows[-1] or row["contestant"] == Neighbours.name,
        )
    return shown


def main(
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the rows here.")] = None,
    repeats: Annotated[int, typer.Option(help="Turns that count.")] = 7,
    turn: Annotated[float, typer.Option(help="Seconds for one thing in one turn.")] = 0.1,
) -> None:
    """Compare learners on one stream, at 200 to 13,000 neurons."""
    console = Console(width=max(110, Console().width))  # the table is that wide
    rows: list[dict[str, Any]] = []
    with Progress(console=console) as progress:
        task = progress.add_task("", total=len(SIZES) * (repeats + 3))
        for size in SIZES:
            progress.update(task, description=f"{size:,} neurons")
            rows += compare(size, repeats, turn, lambda: progress.advance(task))
    console.print(table(rows))
    if json_file is not None:
        json_file.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    typer.run(main)
