"""Records of a very small run of everything, for what is made from records."""

import fcntl
import os
from pathlib import Path

import pytest

from handeye.thesis.experiment import Effort
from handeye.thesis.reproduce import choose, measure
from handeye.thesis.storage import MANIFEST, Stored, read_records, write_records


@pytest.fixture(scope="session")
def smoke_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two replicates of every experiment with a fiftieth of their trials, run by one worker."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "smoke-records"
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / MANIFEST).exists():
            write_records(
                folder, *measure(choose(), replicates=2, jobs=1, effort=Effort(0.02))
            )  # fmt: skip
    return folder


@pytest.fixture(scope="session")
def smoke_run(smoke_folder: Path) -> Stored:
    """The same, read from its folder."""
    return read_records(smoke_folder)
