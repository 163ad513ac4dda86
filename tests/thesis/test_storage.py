import json
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import FileFormatError, MissingExtra
from handeye.randomness import stream
from handeye.thesis.experiment import Curve, Effort, Experiment, Quantities
from handeye.thesis.experiments import EXPERIMENTS
from handeye.thesis.manifest import Manifest, describe
from handeye.thesis.records import Record, Records
from handeye.thesis.runner import run
from handeye.thesis.storage import digest, read_records, write_records


def draw(scale: float, replicate: int, effort: Effort) -> Quantities:
    rng = stream("test: storage", replicate)
    n = effort.of(4)
    return {"value": scale * rng.random(), "walk": Curve(np.arange(n) / 3.0, rng.random(n))}


DRAW = Experiment("draw", {"one": 1.0, "two": 2.0}, draw, replicates=3)
FIXED = Experiment("fixed", {"only": 1.0}, draw, deterministic=True)
MANIFEST = Manifest.of([DRAW, FIXED], 3)


def drawn() -> Records:
    return run([DRAW, FIXED], replicates=3, jobs=1)


@pytest.fixture
def without_pyarrow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)


def test_records_and_manifest_are_read_back_exactly(tmp_path: Path):
    table = write_records(tmp_path, drawn(), MANIFEST)
    assert table.suffix == ".parquet"
    stored = read_records(tmp_path)
    assert stored.records.rows == drawn().rows
    assert stored.manifest == MANIFEST


@pytest.mark.usefixtures("without_pyarrow")
def test_a_csv_table_holds_the_same(tmp_path: Path):
    table = write_records(tmp_path, drawn(), MANIFEST)
    assert table.suffix == ".csv"
    assert read_records(tmp_path).records.rows == drawn().rows


numbers = st.floats(allow_nan=False)
rows = st.builds(
    Record,
    st.text("ab-,\n\"'é", min_size=1, max_size=4),
    st.just("setting"),
    st.integers(0, 99),
    st.sampled_from(["error", "neurons"]),
    st.none() | numbers,
    numbers,
)


@given(st.lists(rows, max_size=6), st.booleans())
def test_any_numbers_and_names_survive(tmp_path_factory, made: list[Record], as_csv: bool):
    folder = tmp_path_factory.mktemp("records")
    with pytest.MonkeyPatch.context() as patch:
        if as_csv:
            patch.setitem(sys.modules, "pyarrow", None)
        write_records(folder, Records(made), MANIFEST)
        assert read_records(folder).records.rows == tuple(made)


@pytest.mark.parametrize("as_csv", [False, True])
def test_what_is_not_a_number_survives(tmp_path: Path, monkeypatch, as_csv: bool):
    if as_csv:
        monkeypatch.setitem(sys.modules, "pyarrow", None)
    values = (np.nan, -np.nan, np.inf, -np.inf, -0.0)
    made = Records(Record("e", "s", i, "q", None, value) for i, value in enumerate(values))
    write_records(tmp_path, made, MANIFEST)
    back = read_records(tmp_path).records.values("e/s/q")
    np.testing.assert_array_equal(back, values)
    assert np.signbit(back[-1])


def test_the_same_seeds_give_the_same_records(tmp_path: Path):
    for name in ("first", "again"):
        write_records(tmp_path / name, drawn(), Manifest.of([DRAW, FIXED], 3))
    first, again = (tmp_path / name / "manifest.json" for name in ("first", "again"))
    assert first.read_bytes() == again.read_bytes()
    first, again = (read_records(tmp_path / name).records.rows for name in ("first", "again"))
    assert first == again


def test_a_thesis_experiment_gives_the_same_records_again():
    chosen = [EXPERIMENTS[name] for name in ("uncorrected", "noise-floor", "distortions")]
    first, again = (
        run(chosen, replicates=2, jobs=1, effort=Effort(0.01)) for _ in range(2)
    )  # fmt: skip
    assert digest(first) == digest(again)
    assert digest(first) != digest(run(chosen, replicates=1, jobs=1, effort=Effort(0.01)))


def test_newer_records_replace_older_ones(tmp_path: Path):
    older = write_records(tmp_path, Records(drawn().rows[:3]), MANIFEST)
    other = tmp_path / "notes.csv"
    other.write_text("mine")
    newer = write_records(tmp_path, drawn(), MANIFEST)
    assert not older.exists()
    assert {path.name for path in tmp_path.iterdir()} == {
        newer.name, "manifest.json", "notes.csv",
    }  # fmt: skip


def test_a_crash_while_writing_leaves_the_older_records(tmp_path: Path, monkeypatch):
    write_records(tmp_path, drawn(), MANIFEST)

    def refuse(path: Path, content: bytes) -> None:
        if path.name == "manifest.json":
            raise OSError("no space left")
        path.write_bytes(content)

    monkeypatch.setattr("handeye.thesis.storage.replace_file", refuse)
    with pytest.raises(OSError, match="no space"):
        write_records(tmp_path, Records(drawn().rows[:3]), MANIFEST)
    assert read_records(tmp_path).records.rows == drawn().rows


def change_manifest(folder: Path, **changes: object) -> None:
    path = folder / "manifest.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


def test_a_folder_without_records_says_how_to_get_some(tmp_path: Path):
    with pytest.raises(FileFormatError, match=r"holds no records.*handeye reproduce --out"):
        read_records(tmp_path)


@pytest.mark.parametrize("text", ["", "[]", "{}", "nonsense", '{"format": "handeye.records"}'])
def test_a_manifest_that_is_something_else(tmp_path: Path, text: str):
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(FileFormatError, match=r"manifest\.json: damaged, or not"):
        read_records(tmp_path)


def test_a_foreign_manifest(tmp_path: Path):
    (tmp_path / "manifest.json").write_text('{"format": "another program"}')
    with pytest.raises(FileFormatError, match="is not the manifest of stored records"):
        read_records(tmp_path)


def test_records_of_a_newer_version(tmp_path: Path):
    write_records(tmp_path, drawn(), MANIFEST)
    change_manifest(tmp_path, version=2)
    with pytest.raises(FileFormatError, match=r"format 2 by a newer handeye .*: update handeye"):
        read_records(tmp_path)


def test_a_table_that_is_gone_or_cut_short(tmp_path: Path):
    table = write_records(tmp_path, drawn(), MANIFEST)
    table.write_bytes(table.read_bytes()[:-9])
    with pytest.raises(FileFormatError, match="is not there, or not the table"):
        read_records(tmp_path)
    table.unlink()
    with pytest.raises(FileFormatError, match="is not there, or not the table"):
        read_records(tmp_path)


@pytest.mark.usefixtures("without_pyarrow")
def test_a_changed_number_is_noticed(tmp_path: Path):
    table = write_records(tmp_path, drawn(), MANIFEST)
    lines = table.read_text().splitlines()
    lines[1] = lines[1][:-1] + ("1" if lines[1][-1] != "1" else "2")
    table.write_text("\n".join(lines))
    with pytest.raises(FileFormatError, match="damaged, what is in it is not what was written"):
        read_records(tmp_path)
    table.write_text("other,columns\n1,2\n")
    with pytest.raises(FileFormatError, match="not the table"):
        read_records(tmp_path)


def test_a_manifest_cannot_name_a_table_elsewhere(tmp_path: Path):
    table = write_records(tmp_path / "there", drawn(), MANIFEST)
    write_records(tmp_path / "here", drawn(), MANIFEST)
    (tmp_path / "here" / table.name).unlink()
    change_manifest(tmp_path / "here", table=f"../there/{table.name}")
    with pytest.raises(FileFormatError, match="is not there"):
        read_records(tmp_path / "here")


def test_parquet_without_its_extra_says_what_to_install(tmp_path: Path, monkeypatch):
    write_records(tmp_path, drawn(), MANIFEST)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MissingExtra, match=r"handeye\[parquet\]"):
        read_records(tmp_path)


def test_every_setting_is_told_by_what_it_says_and_not_by_where_it_lies():
    texts = {
        describe(setting)
        for experiment in EXPERIMENTS.values()
        for setting in experiment.settings.values()
    }
    assert not [text for text in texts if " at 0x" in text]
    assert any("half_max_fraction=0.8" in text for text in texts)


def test_settings_as_text():
    assert describe((1, 0.5, None, "x", [True])) == "(1, 0.5, None, 'x', [True])"
    assert describe({"a": np.float64(2.0)}) == "{'a': 2.0}"
    assert describe(np.array([1.0, 2.0])) == "[1.0, 2.0]"
    assert describe(Effort(0.5)) == "Effort(fraction=0.5)"
    assert describe(Record("e", "s", 0, "q", None, 1.0)).startswith("Record(experiment='e'")
    assert describe(draw).endswith("test_storage.draw")
    assert describe(Effort).endswith("experiment.Effort")
    assert describe(partial(draw, 1.0, effort=Effort())).endswith(
        "draw(1.0, effort=Effort(fraction=1.0))"
    )
    assert describe(object()) == "object"


def test_a_manifest_tells_the_run():
    manifest = Manifest.of([DRAW, FIXED], 7, Effort(0.5))
    assert set(manifest.versions) == {"handeye", "python", "numpy", "scipy", "numba"}
    assert manifest.experiments["draw"].replicates == 7
    assert manifest.experiments["fixed"].replicates == 1
    assert manifest.experiments["draw"].settings == {"one": "1.0", "two": "2.0"}
    assert manifest.deterministic(["fixed"])
    assert not manifest.deterministic(["fixed", "draw"])
    assert Manifest.from_json(json.loads(json.dumps(manifest.to_json()))) == manifest
    assert replace(manifest, effort=1.0) != manifest
