"""From names of claims and figures to records and verdicts."""

import re
from collections.abc import Sequence
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import NamedTuple

from handeye.errors import InvalidInput
from handeye.thesis.claims import Claim, load_all
from handeye.thesis.experiment import FULL, Effort
from handeye.thesis.experiments import EXPERIMENTS
from handeye.thesis.judge import Row, judge, not_run
from handeye.thesis.manifest import Manifest
from handeye.thesis.real_data import ABSENT
from handeye.thesis.runner import Progress, run, silent
from handeye.thesis.storage import Stored

_FIGURE = re.compile(r"(?:fig(?:ure)?s?\.?[\s_-]*)?((?:\d+|[AB])\.\d+)", re.IGNORECASE)


class Selection(NamedTuple):
    """What is to be reproduced: claims, and figures by number (None: all that can be drawn)."""

    claims: list[Claim]
    figures: tuple[str, ...] | None
    experiments: tuple[str, ...]


def reproduce(
    names: Sequence[str] = (),
    replicates: int | None = None,
    jobs: int | None = None,
    progress: Progress = silent,
    *,
    effort: Effort = FULL,
) -> list[Row]:
    """Run what names need; judge the claims in the thesis's order, then the targets.

    Args:
        names: claims or targets (`plant-uncorrected`), else beginnings of names (`preferred`) or
            patterns (`*-noisy`), or figures (`3.22`, `figure-3.22`) for the claims that they show;
            by default every one that this version can measure.
        replicates: repetitions with other random numbers, by default 20, and 10 for catching.
        jobs: processes, by default one for each core (see `run`).
        progress: told what is done.
        effort: how much of each experiment to run; verdicts mean something only with all of it.

    Raises:
        InvalidInput: a name that no claim has, or only claims that cannot be measured yet;
            replicates or jobs below one.
    """
    chosen = choose(names)
    return verdicts(chosen.claims, measure(chosen, replicates, jobs, progress, effort=effort))


def measure(
    chosen: Selection,
    replicates: int | None = None,
    jobs: int | None = None,
    progress: Progress = silent,
    *,
    effort: Effort = FULL,
) -> Stored:
    """The records of a selection's experiments, and how they came about; see `reproduce`.

    Those whose measurements of real robots are absent are left out.
    """
    experiments = [one for name in chosen.experiments if (one := EXPERIMENTS[name]).can_run]
    records = run(experiments, replicates=replicates, jobs=jobs, progress=progress, effort=effort)
    return Stored(records, Manifest.of(experiments, replicates, effort))


def verdicts(claims: Sequence[Claim], stored: Stored) -> list[Row]:
    """The rows of claims, from records only; "not run" where real measurements are absent.

    Raises:
        InvalidInput: the records lack what a claim needs.
    """
    there = stored.manifest.experiments
    absent = {name for name, one in EXPERIMENTS.items() if name not in there and not one.can_run}
    return [
        not_run(claim, ABSENT) if absent.intersection(claim.experiments) else _judged(claim, stored)
        for claim in claims
    ]


def _judged(claim: Claim, stored: Stored) -> Row:
    ran = stored.manifest.experiments
    missing = [name for name in claim.experiments if name not in ran]
    if missing:
        raise InvalidInput(
            f"these records hold nothing of {', '.join(missing)}, which {claim.id} needs: they "
            f"hold {', '.join(ran)}"
        )
    certain = stored.manifest.deterministic(claim.experiments)
    return judge(claim, stored.records, deterministic=certain)


def choose(names: Sequence[str] = (), stored: Stored | None = None) -> Selection:
    """What names of claims and figures mean.

    stored: records to judge again; without names, what is chosen is what they suffice for.

    Raises:
        InvalidInput: as `reproduce`.
        MissingExtra: a figure is named and the extra "report" is absent.
    """
    known = EXPERIMENTS if stored is None else stored.manifest.experiments
    if not names:
        claims = [claim for claim in select() if all(name in known for name in claim.experiments)]
        return Selection(claims, None, tuple(known))
    numbers = {name: number for name in names if (number := figure_number(name))}
    named = [name for name in names if name not in numbers]
    claims = select(named) if named else []
    figures = ()
    needed = {experiment for claim in claims for experiment in claim.experiments}
    if numbers:
        from handeye.thesis.figures import find_figure  # noqa: PLC0415 (needs an extra)

        found = [find_figure(number) for number in numbers.values()]
        shown = {claim for figure in found for claim in figure.shows}
        chosen = {claim.id for claim in claims} | shown
        claims = [claim for claim in load_all() if claim.id in chosen and claim.measure]
        figures = tuple(figure.number for figure in found)
        needed |= {experiment for figure in found for experiment in figure.experiments}
        needed |= {experiment for claim in claims for experiment in claim.experiments}
    return Selection(claims, figures, tuple(name for name in EXPERIMENTS if name in needed))


def figure_number(name: str) -> str | None:
    """The number in "3.22", "fig 3.22" or "figure-3.22"; None for what names no figure."""
    found = _FIGURE.fullmatch(name.strip())
    return found[1].upper() if found else None


def select(ids: Sequence[str] = ()) -> list[Claim]:
    """The claims and targets that names mean and this version can measure, in order.

    Raises:
        InvalidInput: as `reproduce`.
    """
    claims = load_all()
    chosen: set[str] = set()
    for name in ids or ("*",):
        found = [claim for claim in claims if claim.id == name]
        found = found or [claim for claim in claims if _means(name, claim.id)]
        ready = [claim.id for claim in found if claim.measure]
        if not found:
            raise InvalidInput(_unknown(name, [claim.id for claim in claims]))
        if not ready:
            raise InvalidInput(
                f"no experiment of this version measures {', '.join(c.id for c in found)}; it has "
                f"experiments for {', '.join(c.id for c in claims if c.measure)}"
            )
        chosen.update(ready)
    return [claim for claim in claims if claim.id in chosen]


def _means(name: str, claim_id: str) -> bool:
    """A beginning that ends with a word, or a pattern."""
    return claim_id.startswith(f"{name}-") or fnmatchcase(claim_id, name)


def _unknown(name: str, known: list[str]) -> str:
    near = get_close_matches(name, known, n=3, cutoff=0.5) or [k for k in known if name in k]
    hint = f"did you mean {' or '.join(near)}?" if near else f"claims begin with {_heads(known)}"
    return f"no claim is called {name!r}: {hint}"


def _heads(known: list[str]) -> str:
    return ", ".join(dict.fromkeys(claim_id.split("-")[0] for claim_id in known))
