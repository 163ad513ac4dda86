"""A table on disk, written from its rows."""

import pytest
from tests.io.log_files import HEADER


@pytest.fixture
def table(tmp_path):
    def write(*rows, header=HEADER, name="run.csv"):
        path = tmp_path / name
        path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
        return path

    return write
