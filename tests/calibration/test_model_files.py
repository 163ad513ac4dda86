"""Stored models: the same calibrator again, or an error that names the file."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.calibration.cases import CASES, KINDS, sightings

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined, DataSheet
from handeye.calibration.models import PlanarMap, PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.session import learn_from_log
from handeye.calibration.storage import checkpoints, load_model, save_model
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import read_tensors, write_tensors
from handeye.networks import ResourceAllocatingNetwork
from handeye.robots.planar import TwoLinkArm
from handeye.thesis.plants import NOMINAL, NORMAL


def load(path) -> Any:
    return load_model(path).calibrator


def storable(case):
    return not isinstance(case.model, PlacedArm) or not isinstance(case.model.arm, TwoLinkArm)


EVERY_CASE = pytest.mark.parametrize("case", [c for c in CASES if storable(c)], ids=str)
EVERY_KIND = pytest.mark.parametrize("kind", KINDS)


def assert_alike(one, other, seen):
    """Bit by bit the same commands and errors, now and after learning more."""
    np.testing.assert_array_equal(one.command(seen.target), other.command(seen.target))
    for a, b in zip(one.observe_many(seen), other.observe_many(seen), strict=True):
        np.testing.assert_array_equal(a, b)
    np.testing.assert_array_equal(one.command(seen.target), other.command(seen.target))


@EVERY_CASE
@EVERY_KIND
def test_a_loaded_calibrator_commands_and_learns_on_alike(kind, case, tmp_path):
    calibrator = kind(case.model)
    calibrator.observe_many(case.seen[:30])
    path = tmp_path / "new folder" / "run.model.safetensors"
    save_model(path, calibrator, 30)
    assert load_model(path).observed == 30
    loaded = load(path)
    assert type(loaded) is kind
    assert type(loaded.model) is type(case.model)
    assert loaded.model.resolution == case.model.resolution
    np.testing.assert_array_equal(loaded.model.space.low, case.model.space.low)
    np.testing.assert_array_equal(loaded.model.space.high, case.model.space.high)
    assert_alike(loaded, calibrator, case.seen[30:])


def test_every_number_of_a_planar_robot_is_kept(tmp_path):
    head = replace(NORMAL.head, range_scale=1.0 / 3.0, baseline=0.1, pixel_pitch=1e-5 / 7.0)
    for model in (
        PlanarModel(replace(NORMAL, head=head), resolution=0.1 + 0.2),
        PlanarModel(NOMINAL, foveate=True),
        PlanarMap(NORMAL, resolution=0.02),
    ):
        save_model(tmp_path / "model", Nominal(model), 0)
        assert load(tmp_path / "model").model == model


def test_the_network_is_kept_with_its_kinds_and_settings(tmp_path):
    model = PlanarModel(NOMINAL)
    network = ResourceAllocatingNetwork(
        5, 2, inputs=model.space, capacity=9, half_max_fraction=0.7, error_threshold=0.02
    )
    learner = NetworkCorrection(model, network)
    learner.observe_many(sightings(n=20))
    save_model(tmp_path / "model", learner, 20)
    loaded = load(tmp_path / "model").network
    assert repr(loaded) == repr(network)
    assert loaded.settings == network.settings


class OtherCalibrator:
    """Not one of ours."""


def test_what_cannot_be_stored_is_refused_and_writes_nothing(tmp_path):
    path = tmp_path / "model"
    two_links = next(case for case in CASES if not storable(case))
    refused: list[Any] = [OtherCalibrator(), Nominal(two_links.model)]
    for calibrator in refused:
        with pytest.raises(InvalidInput, match="cannot be stored"):
            save_model(path, calibrator, 0)
    assert not path.exists()


@pytest.fixture
def model_file(tmp_path):
    learner = NetworkCorrection(PlanarModel(NOMINAL))
    learner.observe_many(sightings(n=12))
    path = tmp_path / "run.model"
    save_model(path, learner, 12)
    return path


def test_a_changed_bit_anywhere_is_noticed_or_harmless(model_file):
    content = model_file.read_bytes()
    original, seen = load_model(model_file), sightings(n=5, replicate=1)
    expected = original.calibrator.command(seen.target)
    for at in np.random.default_rng(0).integers(0, len(content), 150).tolist():
        damaged = bytearray(content)
        damaged[at] ^= 1 << (at % 8)
        model_file.write_bytes(damaged)
        try:
            stored = load_model(model_file)
        except FileFormatError:
            continue
        assert stored.observed == original.observed
        np.testing.assert_array_equal(stored.calibrator.command(seen.target), expected)


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.999])
def test_a_file_cut_short_is_refused(model_file, share):
    content = model_file.read_bytes()
    model_file.write_bytes(content[: int(share * len(content))])
    with pytest.raises(FileFormatError, match=r"run\.model: damaged"):
        load_model(model_file)


def test_foreign_missing_and_newer_files_are_refused(model_file, tmp_path):
    with pytest.raises(FileFormatError, match="nothing: no such file"):
        load_model(tmp_path / "nothing")
    with pytest.raises(FileFormatError, match="no such file"):
        load_model(tmp_path)
    (tmp_path / "text").write_text("alpha_rad,beta_rad\n0,1\n")
    with pytest.raises(FileFormatError, match="text: damaged, or not a calibrated handeye model"):
        load_model(tmp_path / "text")
    ResourceAllocatingNetwork(5, 2).save(tmp_path / "network")
    with pytest.raises(FileFormatError, match="network: not a calibrated handeye model"):
        load_model(tmp_path / "network")
    arrays, header = read_tensors(model_file, "handeye.model", 1, "a model")
    write_tensors(model_file, "handeye.model", 2, arrays, header)
    with pytest.raises(FileFormatError, match=r"run\.model: written in format 2 .* update handeye"):
        load_model(model_file)


@pytest.mark.parametrize(
    "change",
    [
        {"model": "Telepathy"}, {"calibrator": "Telepathy", "network": None}, {"resolution": "x"},
        {"nominal": {}}, {"nominal": []}, {"nominal": None}, {"observed": None},
        {"observed": float("inf")}, {"network": {}}, {"network": []}, {"foveate": True},
        {"model": "PlanarMap"}, {"model": "PlacedArm"},
    ],
    ids=str,
)  # fmt: skip
def test_parts_that_do_not_fit_together_are_refused(model_file, change):
    arrays, header = read_tensors(model_file, "handeye.model", 1, "a model")
    write_tensors(model_file, "handeye.model", 1, arrays, header | change)
    with pytest.raises(FileFormatError, match=r"run\.model: damaged"):
        load_model(model_file)


@pytest.mark.parametrize(
    ("part", "wrong"),
    [
        ("arm", {"a": -1.0, "b": 1.0}),
        ("arm", {"c": 1.0}),
        ("head", {"baseline": 0.0}),
        ("v_x", "x"),
    ],
    ids=str,
)
def test_a_robot_that_cannot_be_is_refused(model_file, part, wrong):
    arrays, header = read_tensors(model_file, "handeye.model", 1, "a model")
    header["nominal"][part] = wrong
    write_tensors(model_file, "handeye.model", 1, arrays, header)
    with pytest.raises(FileFormatError, match=r"run\.model: damaged"):
        load_model(model_file)


def test_a_network_of_another_robot_is_refused(model_file):
    arrays, header = read_tensors(model_file, "handeye.model", 1, "a model")
    del arrays["network.weights"]
    write_tensors(model_file, "handeye.model", 1, arrays, header)
    with pytest.raises(FileFormatError, match=r"run\.model: damaged"):
        load_model(model_file)


@pytest.mark.parametrize("step", ["os.fsync", "pathlib.Path.replace"])
def test_a_crash_while_saving_keeps_the_old_file(model_file, monkeypatch, step):
    def crash(*_):
        raise KeyboardInterrupt

    old = model_file.read_bytes()
    monkeypatch.setattr(step, crash)
    with pytest.raises(KeyboardInterrupt):
        save_model(model_file, Nominal(PlanarModel(NOMINAL)), 99)
    monkeypatch.undo()
    assert model_file.read_bytes() == old
    assert [p.name for p in model_file.parent.iterdir()] == [model_file.name]


def test_a_saved_file_is_replaced_and_nothing_else_is_left(model_file):
    save_model(model_file, Nominal(PlanarModel(NOMINAL)), 99)
    assert load_model(model_file).observed == 99
    assert [p.name for p in model_file.parent.iterdir()] == [model_file.name]


def test_checkpoints_are_saved_whenever_enough_was_learned(tmp_path):
    path, learner, seen = (
        tmp_path / "run.model",
        NetworkCorrection(PlanarModel(NOMINAL)),
        sightings(),
    )
    keep, observed = checkpoints(path, learner, every=20), []

    def after_each(done):
        keep(done)
        observed.append(load_model(path).observed if path.exists() else None)

    learn_from_log(learner, seen, every=8, after_each=after_each)
    assert observed == [None, None, 24, 24, 24, 48, 48, 48]
    resumed = load_model(path)
    resumed.calibrator.observe_many(seen[48:])
    np.testing.assert_array_equal(
        resumed.calibrator.command(seen.target), learner.command(seen.target)
    )


def test_a_stored_combined_calibrator_learns_on_alike(tmp_path):
    seen = sightings(n=60)
    calibrator = Combined(PlanarModel(NOMINAL), DataSheet(link=0.03))
    calibrator.observe_many(seen[:40])
    save_model(tmp_path / "model", calibrator, 40)
    loaded = load(tmp_path / "model")
    assert loaded.sheet == calibrator.sheet
    assert loaded.health() == calibrator.health()
    assert_alike(loaded, calibrator, seen[40:])
