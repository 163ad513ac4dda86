import json
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from handeye.cli.console import MISUSE, ErrorsForPeople
from handeye.cli.reproduce import reproduce
from handeye.thesis.reproduce import select
from handeye.thesis.storage import read_records

app = typer.Typer(cls=ErrorsForPeople)
app.command()(reproduce)


@app.command()
def other() -> None:
    """A second command, so that the first is called by its name."""


def handeye(*arguments: str, columns: int = 80) -> tuple[int, str, str]:
    runner = CliRunner(env={"COLUMNS": str(columns), "NO_COLOR": "1", "TERM": "dumb"})
    result = runner.invoke(app, ["reproduce", *arguments])
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


FAST = ("plant-excluded-region", "plant-uncorrected", "--jobs", "1")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("reproduction")


@pytest.fixture(scope="module")
def table(folder: Path) -> str:
    code, printed, _ = handeye(*FAST, "--replicates", "2", "--out", str(folder))
    assert code == 0
    return printed


def test_table_has_stated_measured_interval_and_verdict(table: str):
    line = next(line for line in table.splitlines() if line.startswith("plant-uncorrected "))
    assert "4.6 cm" in line
    assert "±" in line
    assert line.rstrip().endswith("reproduced")
    line = next(line for line in table.splitlines() if line.startswith("plant-excluded-region"))
    assert " holds " in line
    assert "1.23 %" in table
    assert "2 replicates" in table


def test_table_fits_its_terminal(table: str):
    assert max(map(len, table.splitlines())) <= 80
    _, wide, _ = handeye(*FAST, "--replicates", "1", columns=120)
    assert 80 < max(map(len, wide.splitlines())) <= 120


def test_json_on_standard_output_is_alone():
    code, printed, _ = handeye(*FAST, "--replicates", "2", "--json", "-")
    assert code == 0
    rows = json.loads(printed)
    assert [row["id"] for row in rows] == [c.id for c in select(FAST[:2])]
    assert rows[0]["stated"] == 0.046
    assert rows[0]["low"] < rows[0]["measured"] < rows[0]["high"]
    assert rows[1]["stated"] is None


def test_json_file_comes_with_the_table(tmp_path: Path):
    target = tmp_path / "new" / "rows.json"
    code, printed, _ = handeye("plant-excluded-region", "--json", str(target))
    assert code == 0
    assert "plant-excluded-region" in printed
    (row,) = json.loads(target.read_text(encoding="utf-8"))
    assert row["verdict"] == "reproduced"


def test_a_verdict_is_no_failure(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("handeye.thesis.judge.agrees", lambda *_: False)
    code, printed, _ = handeye(*FAST, "--replicates", "1")
    assert code == 0
    assert "1 reproduced, 1 not reproduced" in printed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("plant-uncorected",), "did you mean plant-uncorrected"),
        (("--replicates", "0"), "--replicates"),
        (("--jobs", "0"), "--jobs"),
        (("--jobs", "many"), "--jobs"),
    ],
)
def test_misuse_ends_with_code_2_and_a_message(arguments: tuple[str, ...], message: str):
    code, printed, said = handeye(*arguments)
    assert code == MISUSE
    assert message in said
    assert printed == ""


def test_a_folder_is_no_json_file_and_nothing_is_run_for_it(tmp_path: Path):
    code, printed, said = handeye("plant-excluded-region", "--json", str(tmp_path))
    assert code == MISUSE
    assert "is a folder" in said
    assert printed == ""


def test_help_names_the_options():
    code, printed, _ = handeye("--help")
    assert code == 0
    for option in ("--replicates", "--jobs", "--json", "--out", "--records"):
        assert option in printed


@pytest.mark.usefixtures("table")
def test_records_manifest_and_page_are_written(folder: Path):
    names = {path.suffix: path.name for path in folder.iterdir()}
    assert names[".json"] == "manifest.json"
    assert names[".html"] == "index.html"
    assert names[".parquet"].startswith("records-")
    assert set(read_records(folder).manifest.experiments) == {"uncorrected", "excluded-region"}


def lines_of(table: str) -> list[str]:
    return [line for line in table.splitlines() if not line.endswith(" s.")]


def test_records_are_judged_again_without_running(table: str, folder: Path, monkeypatch):
    monkeypatch.delattr("handeye.cli.reproduce.measure")
    code, printed, said = handeye("--records", str(folder), *FAST[:2])
    assert code == 0
    assert lines_of(printed) == lines_of(table)
    assert "index.html" in said.replace("\n", "")
    assert list(Path().iterdir()) == []


@pytest.mark.usefixtures("table")
def test_records_can_be_copied_to_another_folder(folder: Path):
    code, _, _ = handeye("--records", str(folder), "--out", "copy")
    assert code == 0
    assert read_records("copy").records.rows == read_records(folder).records.rows


def test_a_named_part_does_not_touch_what_everything_gave():
    code, _, said = handeye("3.8", "fig 3.47")
    assert code == 0
    assert "out/reproduction-part/index.html" in said.replace("\n", "")
    page = Path("out/reproduction-part/index.html").read_text(encoding="utf-8")
    assert page.count("<figure>") == 2
    assert "Figure 3.8." in page
    assert not Path("out/reproduction").exists()


def test_the_same_command_gives_the_same_files():
    for name in ("first", "again"):
        assert handeye(*FAST, "--replicates", "2", "--out", name)[0] == 0
    assert {p.name: p.read_bytes() for p in Path("first").iterdir()} == {
        p.name: p.read_bytes() for p in Path("again").iterdir()
    }


def test_without_the_report_extra_there_are_records_and_a_hint(monkeypatch):
    for name in [name for name in sys.modules if name.startswith("handeye.reports")]:
        monkeypatch.delitem(sys.modules, name)
    for name in ("handeye.thesis.page", "handeye.thesis.docs"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    code, printed, said = handeye("plant-excluded-region", "--out", "here")
    assert code == 0
    assert "reproduced" in printed
    assert "handeye[report]" in said
    assert read_records("here").manifest.experiments
    assert not Path("here/index.html").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("3.17",), "shows no result"),
        (("figure-3.99",), "there is no figure 3.99"),
        (("--records", "nowhere"), "holds no records"),
        (("--records", ".", "--jobs", "2"), "leave out --replicates and --jobs"),
    ],
)
def test_misuse_of_figures_and_records(arguments: tuple[str, ...], message: str):
    code, printed, said = handeye(*arguments)
    assert code == MISUSE
    assert message in said.replace("\n", " ")
    assert printed == ""
