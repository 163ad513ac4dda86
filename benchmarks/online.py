"""Who predicts best after one pass over a stream, at how many updates a second?

    python benchmarks/online.py [--only NAME ...] [--repeats N] [--json FILE] [--figure FILE]

Every contestant sees the first 500 samples of a stream, from which it may take what it likes, then
learns the rest in order once, and is asked about samples that it never saw. The score is the mean
square error over the variance, averaged over the outputs. All take turns on every replicate of
every stream; medians over replicates are shown. The clock is that of the processor, in one thread,
over the samples after the 500th: other programs on the machine disturb it less. Our networks and
whoever says "1,000" have 1,000 units; LoG-GP keeps every sample. Settings are the same on all
streams; --choose takes replicates from 100 on, for changing them. "evidence": length scales and
noise from the first 500 samples by our rule, which rivals may have too.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy loads

import json
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from online_log_gp import LogGP
from online_rivals import XCSF, Contestant, FourierRLS, FourierSGD, River
from online_streams import FIRST, STREAMS, Stream
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from handeye.networks import CMAC, GradientDescent, InputSpace, ResourceAllocatingNetwork
from handeye.networks.recursive import KalmanNetwork, RecursiveNetwork
from handeye.networks.recursive.evidence import Relevance, relevance

UNITS = 1000
Row = dict[str, Any]
Make = Callable[[int, int, np.ndarray, np.ndarray], Contestant]


def _usual(d: int, factor: float = 1.0) -> np.ndarray:
    return np.full(d, factor * np.sqrt(d))


def _ran(d: int, m: int, scales: np.ndarray, **settings: Any) -> ResourceAllocatingNetwork:
    return ResourceAllocatingNetwork(
        d, m, inputs=InputSpace.scaled(scales), capacity=UNITS, **settings
    )


def _fourier(m: int, found: Relevance) -> FourierRLS:
    return FourierRLS(len(found.scales), m, UNITS, found.scales, found.noise_ratio)


def _log_gp(m: int, points: int, found: Relevance | None, d: int) -> LogGP:
    scales = _usual(d) if found is None else found.scales
    ratio = 0.01 if found is None else found.noise_ratio
    return LogGP(scales, 1.0, ratio, m, points, 10_000)


def _kalman(m: int, scales: np.ndarray, units: int = UNITS, **settings: Any) -> KalmanNetwork:
    space = InputSpace.scaled(scales)
    return KalmanNetwork(len(scales), m, inputs=space, capacity=units, **settings)


ONLY_WEIGHTS: dict[str, Any] = {"shape_deviation": 0.0, "scale_deviation": 0.0}


CONTESTANTS: dict[str, Make] = {
    "recursive": lambda d, m, *_: RecursiveNetwork(d, m, capacity=UNITS),
    "recursive, blocks of 500": lambda d, m, *_: RecursiveNetwork(d, m, capacity=UNITS, block=500),
    "recursive, blocks of 250": lambda d, m, *_: RecursiveNetwork(d, m, capacity=UNITS, block=250),
    "Kalman": lambda d, m, *_: KalmanNetwork(d, m, capacity=UNITS),
    "Kalman, evidence": lambda _, m, *first: _kalman(m, relevance(*first).scales),
    "Kalman, evidence, only weights": lambda _, m, *first: _kalman(
        m, relevance(*first).scales, **ONLY_WEIGHTS
    ),
    "1993, virtual neuron": lambda d, m, *_: _ran(d, m, np.ones(d)),
    "1993, CMAC rule": lambda d, m, *_: _ran(d, m, np.ones(d), adaptation=CMAC()),
    "1993, gradient": lambda d, m, *_: _ran(d, m, np.ones(d), adaptation=GradientDescent()),
    "1993, virtual neuron, evidence": lambda d, m, *first: _ran(d, m, relevance(*first).scales),
    "Fourier 1,000 + RLS": lambda d, m, *_: FourierRLS(d, m, UNITS, _usual(d), 0.01),
    "Fourier 1,000 + RLS, evidence": lambda _, m, *first: _fourier(m, relevance(*first)),
    "LoG-GP, leaves of 50": lambda d, m, *_: _log_gp(m, 50, None, d),
    "LoG-GP, leaves of 50, evidence": lambda d, m, *first: _log_gp(m, 50, relevance(*first), d),
    "LoG-GP, leaves of 200, evidence": lambda d, m, *first: _log_gp(m, 200, relevance(*first), d),
    "scikit-learn, Fourier 1,000 + SGD": lambda d, m, *_: FourierSGD(d, m, UNITS, 1.0, 0.3),
    "river, nearest of 1,000": lambda _, m, *__: River(m, "neighbours"),
    "river, Hoeffding tree": lambda _, m, *__: River(m, "tree"),
    "xcsf, 1,000 rules": lambda d, m, x, _: XCSF(d, m, x, 0.2),
}

FEW: dict[str, Make] = {
    "Kalman, scales as they were": lambda d, m, *_: _kalman(m, _usual(d), scale_deviation=0.0),
    "Kalman 300, evidence": lambda _, m, *first: _kalman(m, relevance(*first).scales, 300),
    "Kalman 300, evidence, only weights": lambda _, m, *first: _kalman(
        m, relevance(*first).scales, 300, **ONLY_WEIGHTS
    ),
}
"""What moving neurons and scales is worth: run only when named."""


def score(contestant: Contestant, stream: Stream) -> float:
    """Normalised mean square error of the held-out samples, mean over the outputs."""
    asked = stream.test_x, stream.test_y
    if isinstance(contestant, River):  # a prediction takes milliseconds
        asked = stream.test_x[:500], stream.test_y[:500]
    errors = contestant.predict_many(asked[0]) - asked[1]
    return float(((errors**2).mean(axis=0) / asked[1].var(axis=0)).mean())


def run(name: str, stream_name: str, stream: Stream, replicate: int) -> Row:
    """One contestant on one replicate of a stream."""
    d, m = stream.x.shape[1], stream.y.shape[1]
    first = stream.x[:FIRST], stream.y[:FIRST]
    begun = time.process_time()
    contestant = (CONTESTANTS | FEW)[name](d, m, *first)
    contestant.learn_many(*first)
    started = time.process_time()
    contestant.learn_many(stream.x[FIRST:], stream.y[FIRST:])
    learned = time.process_time()
    return {
        "contestant": name,
        "stream": stream_name,
        "replicate": replicate,
        "nmse": score(contestant, stream),
        "start_s": started - begun,
        "per_second": (len(stream.x) - FIRST) / (learned - started),
    }


def warm_up(names: list[str]) -> None:
    """Have everything compiled before the clock runs."""
    rng = np.random.default_rng(0)
    x, y = rng.normal(size=(FIRST + 60, 2)), rng.normal(size=(FIRST + 60, 2))
    for name in names:
        run(name, "", Stream(x, y, x[:5], y[:5]), 0)


def medians(rows: list[Row]) -> dict[tuple[str, str], tuple[float, float]]:
    """(contestant, stream) -> median error and updates per second."""
    found: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        found.setdefault((row["contestant"], row["stream"]), []).append(row)
    return {
        key: (
            statistics.median(r["nmse"] for r in group),
            statistics.median(r["per_second"] for r in group),
        )
        for key, group in found.items()
    }


def table(rows: list[Row]) -> Table:
    """For people."""
    shown = Table(title="held-out error over variance / thousand updates per second", caption=(
        "medians over replicates, in processor time of one thread, all in one run; bold: least"
    ))  # fmt: skip
    values = medians(rows)
    streams = [s for s in STREAMS if any(s == key[1] for key in values)]
    shown.add_column("contestant")
    for name in streams:
        shown.add_column(name, justify="right")
    best = {s: min(v[0] for k, v in values.items() if k[1] == s) for s in streams}
    for name in CONTESTANTS | FEW:
        if not any(key[0] == name for key in values):
            continue
        cells: list[str] = []
        for s in streams:
            error, rate = values.get((name, s), (np.nan, np.nan))
            text = f"{error:.3g}" if error >= 1e-3 else f"{error:.1e}"
            bold = f"[bold]{text}[/bold]" if error == best[s] else text
            cells.append(f"{bold} / {rate / 1e3:.3g}")
        shown.add_row(name, *cells)
    return shown


def measured(
    names: list[str], streams: list[str], replicates: range, json_file: Path | None
) -> list[Row]:
    """All contestants on all streams, kept in the file as they come."""
    rows: list[Row] = []
    with Progress() as progress:
        total = len(replicates) * len(streams) * len(names)
        task = progress.add_task("warming up", total=total)
        warm_up(names)
        for replicate in replicates:
            for stream_name in streams:
                stream = STREAMS[stream_name](replicate)
                for name in names:
                    progress.update(task, description=f"{stream_name}: {name}")
                    rows.append(run(name, stream_name, stream, replicate))
                    progress.advance(task)
                if json_file is not None:
                    json_file.write_text(json.dumps(rows, indent=1) + "\n")
    return rows


def main(
    only: Annotated[list[str] | None, typer.Option(help="Contestants by name.")] = None,
    streams: Annotated[list[str] | None, typer.Option(help="Streams by name.")] = None,
    repeats: Annotated[int, typer.Option(help="Replicates.")] = 5,
    choose: Annotated[bool, typer.Option(help="Use the replicates for choosing.")] = False,
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the rows here.")] = None,
    shown: Annotated[Path | None, typer.Option(help="Measure nothing, show these rows.")] = None,
    figure: Annotated[Path | None, typer.Option(help="Draw error against speed here.")] = None,
) -> None:
    """Compare learners on five streams."""
    console = Console(width=max(150, Console().width))
    if shown is not None:
        rows = json.loads(shown.read_text())
    else:
        first = 100 if choose else 0
        replicates = range(first, first + repeats)
        rows = measured(list(only or CONTESTANTS), list(streams or STREAMS), replicates, json_file)
    console.print(table(rows))
    if figure is not None:
        from online_figure import draw  # noqa: PLC0415 (only this needs Matplotlib)

        draw(medians(rows), figure)


if __name__ == "__main__":
    typer.run(main)
