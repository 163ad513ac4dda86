"""The code blocks of README, tutorials and how-to pages run as they stand.

Each page is one test: its blocks run in order, in one namespace and one empty folder. `python`
blocks are executed. In `console` blocks the lines `$ handeye ...` are run, and where output is
shown below a command it must match (`...` stands for any text). Other languages and other
commands are not run.
"""

import doctest
import shlex
import sys
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

from handeye import cli

ROOT = Path(__file__).resolve().parents[1]
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def blocks_of(page: Path) -> list[tuple[str, int, str]]:
    """Language, line number and text of every block that is to run."""
    tokens = MarkdownIt().parse(page.read_text(encoding="utf-8"))
    return [
        (language, token.map[0] + 2, token.content)
        for token in tokens
        if token.type == "fence" and token.map is not None
        if (language := token.info.split(" ")[0]) == "python"
        or (language in {"console", "bash"} and "$ handeye" in token.content)
    ]


def pages() -> list[Path]:
    candidates = [ROOT / "README.md", *sorted(ROOT.glob("docs/*/*.md"))]
    return [page for page in candidates if blocks_of(page)]


def commands_of(text: str) -> list[tuple[str, str]]:
    """Each command of a console block with the output shown below it."""
    found: list[tuple[str, str]] = []
    for line in text.splitlines(keepends=True):
        if line.startswith("$ "):
            found.append((line[2:].strip(), ""))
        elif found:
            command, shown = found[-1]
            found[-1] = (command, shown + line)
    return found


def run_command(command: str) -> int:
    program, *arguments = shlex.split(command)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", [program, *arguments])
        try:
            cli.main()
        except SystemExit as stop:
            return int(stop.code or 0)
    return 0


@pytest.mark.parametrize("page", [pytest.param(p, id=str(p.relative_to(ROOT))) for p in pages()])
def test_page_runs(
    page: Path, tmp_path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")
    namespace = {"__name__": "__main__"}
    for language, line, text in blocks_of(page):
        if language == "python":
            exec(compile("\n" * (line - 1) + text, str(page), "exec"), namespace)
            continue
        for command, shown in commands_of(text):
            if not command.startswith("handeye "):
                continue
            capsys.readouterr()
            assert run_command(command) == 0, f"{page}:{line}: {command}"
            printed = capsys.readouterr().out
            if shown.strip():
                assert doctest.OutputChecker().check_output(shown, printed, FLAGS), (
                    f"{page}:{line}: {command} printed\n{printed}"
                )
