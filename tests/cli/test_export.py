"""`handeye export`: what it writes, what it prints, and what it refuses."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from tests.cli.running import done, refused

from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.models import PlanarModel
from handeye.calibration.storage import save_model
from handeye.networks import (
    FixedPoint,
    GradientDescent,
    HardwareNetwork,
    NoAdaptation,
    ResourceAllocatingNetwork,
)
from handeye.networks.hardware.c_source import c_files
from handeye.thesis.plants import NOMINAL


def network(**kinds) -> ResourceAllocatingNetwork:
    made = ResourceAllocatingNetwork(2, 1, capacity=12, **kinds)
    x = np.random.default_rng(0).random((60, 2))
    made.learn_many(x, x[:, :1] * x[:, 1:])
    return made


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    network().save(tmp_path / "network.safetensors")
    return tmp_path / "network.safetensors"


def texts(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in sorted(folder.iterdir())}


def test_a_network_becomes_files_that_say_what_they_cost(stored: Path, tmp_path: Path):
    printed = done("export", stored, "--c", tmp_path / "c").stdout
    expected = c_files(HardwareNetwork.of(network(), FixedPoint(16)))
    assert texts(tmp_path / "c") == dict(sorted(expected.items()))
    assert "12 neurons" in printed
    row = next(line for line in printed.splitlines() if "divide" in line)
    assert [cell.strip() for cell in row.split("│")[1:4]] == ["divide", "0", "1"]
    bytes_of = printed.split(" bytes of constants")[0].rpartition(" ")[2]
    assert f"{bytes_of} bytes of constants" in expected["network.h"]


@pytest.mark.parametrize(
    ("options", "fixed", "learns"),
    [
        (["--word-length", 9], FixedPoint(9), True),
        (["--random-rounding"], FixedPoint(16, rounding="random"), True),
        (["--float"], None, True),
        (["--frozen"], FixedPoint(16), False),
    ],
    ids=lambda value: value[0][2:] if isinstance(value, list) else "",
)
def test_options_choose_the_arithmetic(stored: Path, tmp_path: Path, options, fixed, learns):
    printed = done("export", stored, "--c", tmp_path / "c", "--name", "arm", *options).stdout
    chip = HardwareNetwork.of(network(), fixed, learns=learns)
    assert texts(tmp_path / "c") == dict(sorted(c_files(chip, "arm").items()))
    assert ("learn, at most" in printed) is learns


def test_the_network_of_a_calibrated_model_is_exported(tmp_path: Path):
    calibrator = NetworkCorrection(PlanarModel(NOMINAL))
    x = np.random.default_rng(1).uniform(-1.0, 1.0, (30, 5))
    calibrator.network.learn_many(x, 0.1 * x[:, :2])
    save_model(tmp_path / "model", calibrator, 30)
    done("export", tmp_path / "model", "--c", tmp_path / "c")
    assert texts(tmp_path / "c") == dict(
        sorted(c_files(HardwareNetwork.of(calibrator.network)).items())
    )


def test_a_stored_chip_is_exported_as_it_has_become(tmp_path: Path):
    chip = HardwareNetwork.of(network(), FixedPoint(12, rounding="random"))
    chip.learn([0.3, 0.4], [0.9])
    chip.save(tmp_path / "chip")
    done("export", tmp_path / "chip", "--c", tmp_path / "c")
    assert texts(tmp_path / "c") == dict(sorted(c_files(chip).items()))
    assert "without options" in refused("export", tmp_path / "chip", "--c", tmp_path, "--float")


def test_what_it_writes_compiles_and_agrees(stored: Path, tmp_path: Path):
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler (cc) on this machine")
    done("export", stored, "--c", tmp_path / "c")
    strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    sources = ["network.c", "network_check.c"]
    subprocess.run([compiler, *strict, *sources, "-o", "check"], cwd=tmp_path / "c", check=True)
    subprocess.run([tmp_path / "c" / "check"], check=True, capture_output=True)


def test_what_cannot_be_exported_is_named_with_what_can(stored: Path, tmp_path: Path):
    to = ("--c", tmp_path / "c")
    save_model(tmp_path / "model", Nominal(PlanarModel(NOMINAL)), 0)
    said = refused("export", tmp_path / "model", *to)
    assert "holds a Nominal, which is no network" in said
    assert "handeye calibrate --method network" in said
    network(adaptation=GradientDescent()).save(tmp_path / "descent")
    assert "Or give --frozen" in refused("export", tmp_path / "descent", *to)
    assert done("export", tmp_path / "descent", *to, "--frozen")
    ResourceAllocatingNetwork(2, 1, adaptation=NoAdaptation()).save(tmp_path / "empty")
    said = refused("export", tmp_path / "empty", *to)
    assert "let it learn first" in said
    assert "--frozen" not in said
    assert "no such file" in refused("export", tmp_path / "nothing", *to)
    (tmp_path / "log.csv").write_text("alpha_rad,beta_rad\n1,2\n")
    assert "not stored by handeye" in refused("export", tmp_path / "log.csv", *to)
    assert "--word-length" in refused("export", stored, *to, "--float", "--word-length", 12)
    assert "8" in refused("export", stored, *to, "--word-length", 7)
    assert "small letters" in refused("export", stored, *to, "--name", "My Net")
