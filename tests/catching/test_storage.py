import numpy as np
import pytest
from tests.catching.trained import SETTINGS, WORLD, copied, throws, trained

from handeye.catching import practice
from handeye.catching.learner import Learner
from handeye.errors import FileFormatError
from handeye.networks import ResourceAllocatingNetwork


@pytest.mark.parametrize("name", SETTINGS)
def test_a_loaded_learner_goes_on_exactly_as_the_saved_one(name, tmp_path):
    straight = copied(trained(name, 20, 10), tmp_path)
    resumed = copied(trained(name, 20, 10), tmp_path)
    practice.train(straight, WORLD, 300, pursuits=25, tosses=12, mentored=3)
    practice.train(resumed, WORLD, 300, pursuits=25, tosses=12, mentored=1)
    resumed = copied(resumed, tmp_path)
    practice.train(resumed, WORLD, 300, pursuits=25, tosses=12, mentored=3)
    assert resumed.settings == straight.settings
    assert (resumed.pursuits, resumed.tosses, resumed.mentored) == ([25, 25], [12, 12], 3)
    one, other = (practice.test(learner, WORLD, throws(6)) for learner in (straight, resumed))
    np.testing.assert_array_equal(one.voltage, other.voltage)


def test_damaged_and_foreign_files_are_refused(tmp_path):
    path = tmp_path / "learner.safetensors"
    trained("thesis", 20, 10).save(path)
    content = bytearray(path.read_bytes())
    content[-9] ^= 1
    path.write_bytes(content)
    with pytest.raises(FileFormatError, match="damaged"):
        Learner.load(path)
    path.write_bytes(content[:100])
    with pytest.raises(FileFormatError):
        Learner.load(path)
    ResourceAllocatingNetwork(1, 1).save(path)
    with pytest.raises(FileFormatError, match="not a learner"):
        Learner.load(path)
    with pytest.raises(FileFormatError, match="no such file"):
        Learner.load(tmp_path / "nothing")
