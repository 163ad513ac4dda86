"""Files that are the old one or the complete new one, and tensors with a header."""

import json
import stat

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from safetensors import safe_open
from safetensors.numpy import save_file

from handeye.errors import FileFormatError
from handeye.io.files import replace_file
from handeye.io.tensors import read_tensors, write_tensors

ARRAYS = {"b": np.arange(6.0).reshape(2, 3).T, "a": np.array([np.pi]), "none": np.zeros((0, 2))}
HEADER = {"name": "Größe", "list": [1, 2.5, None], "nested": {"yes": True}}


def read(path):
    return read_tensors(path, "kind", 3, "a file of this kind")


def test_folders_are_made_and_old_content_is_replaced(tmp_path):
    path = tmp_path / "a" / "b" / "file"
    for content in (b"first", b"", b"second"):
        replace_file(path, content)
        assert path.read_bytes() == content
    assert [p.name for p in path.parent.iterdir()] == ["file"]


def test_a_new_file_has_the_rights_of_any_other(tmp_path):
    (tmp_path / "other").write_bytes(b"")
    replace_file(tmp_path / "file", b"")
    modes = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("file", "other")]
    assert modes[0] == modes[1]


@pytest.mark.parametrize("step", ["os.fsync", "pathlib.Path.chmod", "pathlib.Path.replace"])
def test_a_crash_at_any_step_leaves_the_old_file_alone(tmp_path, monkeypatch, step):
    path = tmp_path / "file"
    replace_file(path, b"old")

    def crash(*_):
        raise OSError("no space left")

    monkeypatch.setattr(step, crash)
    with pytest.raises(OSError, match="no space left"):
        replace_file(path, b"new")
    monkeypatch.undo()
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


@given(
    header=st.dictionaries(
        st.text(), st.none() | st.integers() | st.floats(allow_nan=False) | st.text(), max_size=3
    ),
    values=st.lists(st.floats(), max_size=4),
)
def test_what_is_written_is_read_to_the_last_bit(header, values, tmp_path_factory):
    path = tmp_path_factory.mktemp("tensors") / "file"
    write_tensors(path, "kind", 3, {**ARRAYS, "values": np.array(values)}, header)
    arrays, found = read(path)
    assert found == header
    assert arrays["values"].tobytes() == np.array(values).tobytes()
    for name, array in ARRAYS.items():
        np.testing.assert_array_equal(arrays[name], array)


def test_older_versions_are_read_and_newer_refused(tmp_path):
    path = tmp_path / "file"
    write_tensors(path, "kind", 2, ARRAYS, HEADER)
    assert read(path)[1] == HEADER
    write_tensors(path, "kind", 4, ARRAYS, HEADER)
    with pytest.raises(FileFormatError, match=r"file: written in format 4 .*up to 3.* update"):
        read(path)


def test_other_kinds_and_other_files_are_refused(tmp_path):
    path = tmp_path / "file"
    write_tensors(path, "other", 3, ARRAYS, HEADER)
    with pytest.raises(FileFormatError, match="file: not a file of this kind"):
        read(path)
    save_file({"a": np.zeros(2)}, path)
    with pytest.raises(FileFormatError, match="file: not a file of this kind"):
        read(path)
    path.write_bytes(b"PK\x03\x04")
    with pytest.raises(FileFormatError, match="file: damaged, or not a file of this kind"):
        read(path)


@pytest.mark.parametrize(
    "change",
    [
        {"header": "{"}, {"header": "{}"}, {"header": None}, {"version": "x"}, {"version": None},
        {"sha256": "0"}, {"sha256": None},
    ],
    ids=str,
)  # fmt: skip
def test_metadata_that_is_not_as_written_is_refused(tmp_path, change):
    path = tmp_path / "file"
    write_tensors(path, "kind", 3, ARRAYS, HEADER)
    with safe_open(path, framework="numpy") as stored:
        metadata = {k: v for k, v in (stored.metadata() | change).items() if v is not None}
        names = list(stored.keys())
        save_file({name: stored.get_tensor(name) for name in names}, path, metadata)
    with pytest.raises(FileFormatError, match="file: damaged"):
        read(path)


def test_the_header_is_plain_json(tmp_path):
    write_tensors(tmp_path / "file", "kind", 3, {}, HEADER)
    with safe_open(tmp_path / "file", framework="numpy") as stored:
        assert json.loads(stored.metadata()["header"]) == HEADER
