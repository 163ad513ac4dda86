"""Kinds of the user's own, and the import that needs an extra. Each in a fresh process."""

import os
import subprocess
import sys

import pytest

KERNEL = """
from handeye._compiled import by_kind, compiled

@by_kind
def area(shape): ...

@compiled
def twice(shape):
    return 2.0 * area(shape)
"""

KINDS = """
from typing import NamedTuple
from kernel import area, twice

class Square(NamedTuple):
    side: float = 3.0

@area.of(Square)
def square_area(shape):
    return {formula}

print(twice(Square()))
"""

NETWORK = """
from typing import NamedTuple
import numpy as np
from handeye.networks import ResourceAllocatingNetwork
from handeye.networks.adaptation import RULES, adapt
from handeye.networks.storage import FileFormatError

class Halve(NamedTuple):
    times: int = 2

{registered}

@adapt.of(Halve)
def halve(rule, response, settings, units, n, x, error, work):
    for _ in range(rule.times):
        for k in range(error.size):
            for j in range(n):
                units.weights[k, j] *= 0.5

network = ResourceAllocatingNetwork(1, 1, adaptation=Halve(times=np.int64(3)), capacity=1)
network.learn([0.0], [8.0])
network.learn([0.0], [0.0])
print(network.weights[0, 0], repr(network.adaptation))
network.save("network")
print(ResourceAllocatingNetwork.load("network").adaptation)
del RULES["Halve"]
try:
    ResourceAllocatingNetwork.load("network")
except FileFormatError as error:
    print("not registered" in str(error))
"""


def run(folder, code, **environment):
    path = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def test_an_edited_kind_is_compiled_anew(tmp_path):
    (tmp_path / "kernel.py").write_text(KERNEL)
    cache = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    for formula, answer in (("shape.side", "6.0"), ("shape.side**2", "18.0")):
        (tmp_path / "kinds.py").write_text(KINDS.format(formula=formula))
        result = run(tmp_path, "import kinds", **cache)
        assert result.stdout.strip() == answer, result.stderr


def test_a_rule_of_ones_own(tmp_path):
    result = run(tmp_path, NETWORK.format(registered='RULES["Halve"] = Halve'))
    expected = ["1.0 Halve(times=3)", "Halve(times=3)", "True"]
    assert result.stdout.splitlines() == expected, result.stderr


def test_a_kind_has_to_be_registered(tmp_path):
    result = run(tmp_path, NETWORK.format(registered=""))
    assert "InvalidInput: adaptation must be one of" in result.stderr


@pytest.mark.parametrize(
    ("imported", "raises"),
    [("handeye.networks", False), ("handeye.networks.regressor", True)],
)
def test_only_the_regressor_needs_scikit_learn(tmp_path, imported, raises):
    code = f"import sys; sys.modules['sklearn'] = None\nimport {imported}"
    result = run(tmp_path, code)
    assert (result.returncode != 0) == raises
    if raises:
        assert "MissingExtra: RANRegressor needs" in result.stderr
        assert "pip install 'handeye[sklearn]'" in result.stderr
