"""Who learns to catch with how much practice? handeye's learner beside SAC, PPO and PID.

    python benchmarks/catching.py [--only NAME ...] [--seeds N] [--json FILE]

All are tested with the same 200 throws of either ball at either arm, identities unknown at the
start. Contestants:

thesis, improved     the learner of handeye.catching: random pursuits without a ball, tosses that it
                     watches, mentored throws; no reward
ppo, sac             Stable-Baselines3 on handeye/Catch-v0; every throw is practice. The reward is 1
                     for a catch plus, at each tick, the metres by which the arm came nearer to
                     where the ball will come down: it tells of the crossing at every tick
ppo-sparse, sac-sparse  the same with 1 for a catch and nothing else
pid                  tuned on 800 other throws and told the masses; ball and crossing it is told, or
                     it asks a learner that has watched 100 tosses of each ball
environment          no contestant: steps per second, one at a time and in batches

CPU seconds are those of training alone, in one thread. A learner of reinforcement stops when two
tests in a row are at least 0.99. SAC takes minutes for a few hundred throws.
"""

import itertools
import json
import time
from pathlib import Path
from statistics import median
from typing import Annotated, Any

import gymnasium
import numpy as np
import typer
from catching_plain import STAGES, pid_shares, practise, warm_up
from catching_rl import caught, train_ppo, train_sac
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from handeye.catching.environment import ID
from handeye.catching.settings import IMPROVED, THESIS
from handeye.catching.throws import Throws, draw_throws
from handeye.randomness import stream

LEARNERS = {"thesis": THESIS, "improved": IMPROVED}
TRAINERS = {"ppo": train_ppo, "sac": train_sac}
DEFAULT = ("thesis", "improved", "ppo", "ppo-sparse", "sac", "pid", "environment")
SHARES = (0.95, 0.99)
Row = dict[str, Any]


def learn(name: str, seed: int, throws: Throws, progress: Progress) -> list[Row]:
    """The tests of one of our learners."""
    rows: list[Row] = []
    task = progress.add_task(f"{name}, seed {seed}", total=len(STAGES))
    warm_up(LEARNERS[name])

    def told(pursuits: int, tosses: int, mentored: int, hits: np.ndarray, cpu: float) -> None:
        rows.append(row(name, seed, hits, cpu, pursuits=pursuits, tosses=tosses, throws=mentored))
        progress.advance(task)

    practise(LEARNERS[name], seed, throws, told)
    return rows


def reinforce(
    name: str, seed: int, throws: Throws, progress: Progress, most: int, every: int
) -> list[Row]:
    """The tests of a learner of reinforcement."""
    rows: list[Row] = []
    task = progress.add_task(f"{name}, seed {seed}", total=most)

    def test(model: Any, n: int, cpu: float) -> bool:
        rows.append(row(name, seed, caught(model, throws), cpu, throws=n))
        progress.update(task, completed=n, description=f"{name}, {rows[-1]['caught']:.3f} caught")
        return len(rows) > 1 and min(r["caught"] for r in rows[-2:]) >= 0.99

    kind, _, sparse = name.partition("-")
    TRAINERS[kind](seed, most, every, 0.0 if sparse else 1.0, test)
    return rows


def row(  # noqa: D103 (one test as it is stored)
    name: str, seed: int, hits: np.ndarray, cpu: float, **practice: int
) -> Row:
    counts = {"pursuits": 0, "tosses": 0, "throws": 0, **practice}
    return {
        "contestant": name, "seed": seed, **counts, "cpu_s": cpu,
        "caught": float(hits.mean()), "of": len(hits),
    }  # fmt: skip


def speeds(seconds: float = 1.0) -> list[Row]:
    """Steps per second of the environment: one at a time, wrapped by Gymnasium, and as a batch."""
    rows: list[Row] = []
    for n in (1, 16, 64, 256):
        for name in ("sync", "vector_entry_point"):
            env = gymnasium.make_vec(ID, num_envs=n, vectorization_mode=name)
            env.reset(seed=0)
            env.action_space.seed(0)
            actions = env.action_space.sample()
            env.step(actions)
            steps, begun = 0, time.perf_counter()
            while time.perf_counter() - begun < seconds:
                env.step(actions)
                steps += n
            rate = steps / (time.perf_counter() - begun)
            rows.append({"contestant": "environment", "n": n, "mode": name, "steps_per_s": rate})
            env.close()
    return rows


def practice_table(rows: list[Row]) -> Table:
    """What each contestant needed, median over seeds and the range."""
    table = Table(title="practice until so much of 200 test throws is caught", caption=(
        "median over seeds (least to most); at the first of two tests in a row that reach it"
    ))  # fmt: skip
    for column in ("contestant", "seeds", "caught"):
        table.add_column(column)
    for column in ("pursuits", "tosses watched", "throws", "CPU s", "last test"):
        table.add_column(column, justify="right")
    for name in dict.fromkeys(r["contestant"] for r in rows if "cpu_s" in r):
        runs: dict[int, list[Row]] = {}
        for r in rows:
            if r["contestant"] == name:
                runs.setdefault(r["seed"], []).append(r)
        last = _spread([run[-1]["caught"] for run in runs.values()], "{:.3f}")
        for share in SHARES:
            first = [_reached(run, share) for run in runs.values()]
            there = [r for r in first if r is not None]
            cells = [
                _spread([r[key] for r in there], form)
                for key, form in (
                    ("pursuits", "{:,.0f}"), ("tosses", "{:,.0f}"),
                    ("throws", "{:,.0f}"), ("cpu_s", "{:,.1f}"),
                )
            ]  # fmt: skip
            reached = f"{len(there)} of {len(runs)}"
            table.add_row(name, reached, f"{share}", *cells, last, end_section=share is SHARES[-1])
    return table


def _reached(run: list[Row], share: float) -> Row | None:
    """The first of two tests in a row at which so much was caught: one may be luck."""
    pairs = itertools.pairwise(run)
    return next((one for one, two in pairs if min(one["caught"], two["caught"]) >= share), None)


def _spread(values: list[float], form: str) -> str:
    if not values:
        return "-"
    low, middle, high = (form.format(f(values)) for f in (min, median, max))
    return middle if low == high else f"{middle} ({low} to {high})"


def other_tables(rows: list[Row]) -> list[Table]:
    """PID controllers, and the environment's speed."""
    pid, speed = Table(title="PID, no practice"), Table(title="steps per second")
    for column in ("follows", "caught"):
        pid.add_column(column)
    shares: dict[str, list[float]] = {}
    for r in rows:
        if r["contestant"] == "pid":
            shares.setdefault(r["follows"], []).append(r["caught"])
    for follows, values in shares.items():
        pid.add_row(follows, _spread(values, "{:.3f}"))
    for column in ("environments", "SyncVectorEnv", "CatchVectorEnv", "ratio"):
        speed.add_column(column, justify="right")
    rates = {(r["n"], r["mode"]): r["steps_per_s"] for r in rows if "mode" in r}
    for n in sorted({n for n, _ in rates}):
        sync, ours = rates[n, "sync"], rates[n, "vector_entry_point"]
        speed.add_row(f"{n}", f"{sync:,.0f}", f"{ours:,.0f}", f"{ours / sync:.1f}")
    return [pid, speed]


def main(
    only: Annotated[
        list[str] | None, typer.Option(help="Contestants; default: all but sac-sparse.")
    ] = None,
    seeds: Annotated[
        int, typer.Option(help="Training seeds; SAC gets one unless --only names it.")
    ] = 3,
    sac_throws: Annotated[int, typer.Option(help="At most for SAC.")] = 1_500,
    ppo_throws: Annotated[int, typer.Option(help="At most for PPO.")] = 15_000,
    tests: Annotated[int, typer.Option(help="Test throws.")] = 200,
    json_file: Annotated[
        Path | None, typer.Option("--json", help="Keep the rows here, with those already there.")
    ] = None,
) -> None:
    """Train contestants and show what practice and CPU time they needed."""
    console = Console(width=max(120, Console().width))
    kept = json_file is not None and json_file.exists()
    rows: list[Row] = json.loads(json_file.read_text()) if kept and json_file else []
    with Progress(console=console) as progress:
        for name in only or DEFAULT:
            rows = [r for r in rows if r["contestant"] != name]
            slow = name.startswith("sac") and name not in (only or ())
            for seed in range(1 if slow or name == "environment" else seeds):
                throws = draw_throws(tests, stream("benchmark catching: tests", seed))
                if name in LEARNERS:
                    rows += learn(name, seed, throws, progress)
                elif name == "environment":
                    rows += speeds()
                elif name == "pid":
                    rows += [
                        {"contestant": "pid", "seed": seed, "follows": follows, "caught": share}
                        for follows, share in pid_shares(seed, throws).items()
                    ]
                else:
                    most, every = (sac_throws, 50) if "sac" in name else (ppo_throws, 300)
                    rows += reinforce(name, seed, throws, progress, most, every)
                if json_file is not None:
                    json_file.write_text(json.dumps(rows, indent=1) + "\n")
    for table in (practice_table(rows), *other_tables(rows)):
        if table.row_count:
            console.print(table)


if __name__ == "__main__":
    typer.run(main)
