"""The layers of the package, as the contracts in pyproject.toml state them."""

from pathlib import Path

import pytest
from importlinter.cli import lint_imports


def test_no_import_goes_up_or_sideways(
    repository: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(repository)
    kept = lint_imports(no_cache=True, no_logo=True) == 0
    assert kept, capsys.readouterr().out
