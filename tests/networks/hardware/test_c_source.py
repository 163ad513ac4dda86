"""The C files, compiled with every warning an error, against the chip in Python."""

import ctypes
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.networks.hardware.made import SPACE, trained
from tests.networks.samples import fewer

from handeye.errors import InvalidInput
from handeye.networks import (
    CMAC,
    Cosine,
    FixedPoint,
    FixedVirtualNeuron,
    Gaussian,
    HardwareNetwork,
    NoAdaptation,
    Parabolic,
    VirtualNeuron,
)
from handeye.networks.hardware.c_costs import CCosts
from handeye.networks.hardware.c_source import LOOSE, TIGHT, c_files, write_c

STRICT = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1"]
N = fewer(150, 50)

CASES = [
    (Gaussian(), VirtualNeuron(), FixedPoint(8)),
    (Gaussian(), VirtualNeuron(), FixedPoint(16)),
    (Gaussian(), VirtualNeuron(), FixedPoint(24, rounding="random")),
    (Gaussian(), CMAC(), FixedPoint(12)),
    (Gaussian(), CMAC(), FixedPoint(9, rounding="random")),
    (Gaussian(), FixedVirtualNeuron(0.4), FixedPoint(16)),
    (Gaussian(), NoAdaptation(), FixedPoint(16)),
    (Cosine(), VirtualNeuron(), FixedPoint(14)),
    (Parabolic(), CMAC(), FixedPoint(20)),
    (Gaussian(), VirtualNeuron(), None),
    (Gaussian(), CMAC(), None),
    (Gaussian(), FixedVirtualNeuron(0.4), None),
    (Cosine(), NoAdaptation(), None),
    (Parabolic(), NoAdaptation(), None),
]


def _name(case: Any) -> str:
    *kinds, fixed = case
    words = "double" if fixed is None else f"{fixed.word_length}-{fixed.rounding}"
    return "-".join([*(type(kind).__name__ for kind in kinds), words])


@pytest.fixture(scope="session")
def compiler() -> str:
    found = shutil.which("cc")
    if found is None:
        pytest.skip("no C compiler (cc) on this machine")
    return found


@pytest.fixture(params=CASES, ids=_name)
def chip(request) -> HardwareNetwork:
    response, rule, fixed = request.param
    learner = rule if not isinstance(rule, NoAdaptation) else VirtualNeuron()
    network = trained(25, response=response, adaptation=learner)
    return HardwareNetwork.of(network, fixed, learns=not isinstance(rule, NoAdaptation))


def built(compiler: str, folder: Path, *arguments: str) -> None:
    done = subprocess.run(
        [compiler, *STRICT, *arguments, "-lm"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def stepwise(compiler: str, chip: HardwareNetwork, folder: Path, x: Any, targets: Any) -> Any:
    """Outputs of the C code at x before each of x, targets is learned; size of its state."""
    write_c(chip, folder, "net")
    (folder / "size.c").write_text(
        '#include "net.h"\nunsigned long size(void);\n'
        "unsigned long size(void) { return sizeof(net_state); }\n"
    )
    built(compiler, folder, "-shared", "-fPIC", "net.c", "size.c", "-o", "net.so")
    library = ctypes.CDLL(str(folder / "net.so"))
    library.size.restype = ctypes.c_ulong
    predict, learn = (getattr(library, f"net_{verb}", None) for verb in ("predict", "learn"))
    for function in (predict, learn):
        if function is not None:
            function.argtypes = [ctypes.c_void_p] * 3
    state = ctypes.create_string_buffer(library.size())
    library.net_start(state)
    found = np.empty_like(targets)
    for x_i, target, out in zip(x, targets, found, strict=True):
        assert predict is not None
        predict(state, x_i.ctypes.data, out.ctypes.data)
        if learn is not None:
            learn(state, x_i.ctypes.data, target.ctypes.data)
    return found, library.size()


def test_c_is_python_before_and_after_every_lesson(compiler, chip, tmp_path):
    rng = np.random.default_rng(1)
    span = SPACE.high - SPACE.low
    x = SPACE.low - 0.2 * span + 1.4 * span * rng.random((N, 3))
    targets = chip.predict_many(x) + rng.normal(scale=0.4, size=(N, 2))
    design = chip.design
    expected = targets - chip.copy().learn_many(x, targets).error
    if design.fixed is None:
        found, size = stepwise(compiler, chip, tmp_path, x, targets)
        np.testing.assert_allclose(found, expected, atol=TIGHT * np.abs(targets).max())
    else:
        kind = {8: np.int8, 16: np.int16, 32: np.int32}[
            next(bits for bits in (8, 16, 32) if bits >= design.fixed.word_length)
        ]
        words = design.input_words(design.inputs.scaled_inputs(x)).astype(kind)
        found, size = stepwise(
            compiler, chip, tmp_path, words, design.output_words(targets).astype(kind)
        )
        np.testing.assert_array_equal(found, np.rint(expected / design.output_step))
        assert np.ptp(found) > 50
    assert size == CCosts.of(chip).state


def check_of(compiler: str, folder: Path, *options: str) -> tuple[int, str]:
    built(compiler, folder, *options, "network.c", "network_check.c", "-o", "check")
    done = subprocess.run([folder / "check"], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


@pytest.mark.parametrize("fixed", [FixedPoint(16), None], ids=["words", "double"])
def test_the_check_passes_and_notices_a_changed_weight(compiler, fixed, tmp_path):
    chip = HardwareNetwork.of(trained(25), fixed)
    paths = write_c(chip, tmp_path)
    assert [path.name for path in paths] == ["network.h", "network.c", "network_check.c"]
    code, printed = check_of(compiler, tmp_path)
    assert (code, printed) == (0, "network: 32 predictions and lessons as in Python\n")
    if fixed is None:
        assert check_of(compiler, tmp_path, "-DNETWORK_REAL=float")[0] == 0
    text = paths[1].read_text()
    weights = text.index("weights[NETWORK_OUTPUTS][NETWORK_NEURONS] = {")
    number = re.compile(r"-?\d+").search(text, weights)
    assert number is not None
    paths[1].write_text(text[: number.start()] + "1" + text[number.end() :])
    code, printed = check_of(compiler, tmp_path)
    assert code == 1
    assert "differ from Python's" in printed
    assert LOOSE > TIGHT


def test_measures_become_words_and_back_as_in_python(compiler, tmp_path):
    chip = HardwareNetwork.of(trained(25), FixedPoint(16))
    design = chip.design
    write_c(chip, tmp_path, "net")
    built(compiler, tmp_path, "-shared", "-fPIC", "net.c", "-o", "net.so")
    library = ctypes.CDLL(str(tmp_path / "net.so"))
    for name, kinds, result in (
        ("net_input", [ctypes.c_int, ctypes.c_double], ctypes.c_int16),
        ("net_target", [ctypes.c_double], ctypes.c_int16),
        ("net_output", [ctypes.c_int16], ctypes.c_double),
    ):
        getattr(library, name).argtypes, getattr(library, name).restype = kinds, result
    rng = np.random.default_rng(2)
    x = np.vstack([rng.uniform(2.0 * SPACE.low, 2.0 * SPACE.high, (300, 3)), [[1e9, -1e9, 0.0]]])
    words = design.input_words(design.inputs.scaled_inputs(x))
    found = [[library.net_input(i, value) for i, value in enumerate(row)] for row in x]
    np.testing.assert_array_equal(found, words)
    values = rng.normal(scale=3.0, size=300)
    targets = design.output_words(values)
    assert [library.net_target(value) for value in values] == targets.tolist()
    assert [library.net_output(word) for word in targets.tolist()] == (
        targets * design.output_step
    ).tolist()
    built(compiler, tmp_path, "-DNET_NO_DOUBLE", "-c", "net.c")


def test_the_header_tells_what_it_costs():
    chip = HardwareNetwork.of(trained(25), FixedPoint(16))
    header = c_files(chip, "arm")["arm.h"]
    costs = CCosts.of(chip)
    # Centers, gains, first weights in two bytes, shifts in one; tables of 65 entries each.
    assert costs.constants == 25 * (3 + 1 + 2) * 2 + 25 + 2 * 65 * 2
    for line in costs.lines():
        assert line in header
    assert f"{costs.operations.learn['multiply']:,}" in header
    assert "25 neurons" in header
    assert "words of 16 bits" in header
    assert max(map(len, header.splitlines())) <= 100
    assert "np." not in "".join(c_files(chip).values())


@pytest.mark.parametrize("name", ["", "Net", "9net", "a-b", "a b", "ä", "../x"])
def test_a_name_that_c_cannot_have_is_refused(name, tmp_path):
    with pytest.raises(InvalidInput, match="small letters"):
        write_c(HardwareNetwork.of(trained(25)), tmp_path / "new", name)
    assert not (tmp_path / "new").exists()
