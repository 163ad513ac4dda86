"""What is counted, against counts by hand, and the claims of appendix B about them."""

import ast
import inspect

import numpy as np
import pytest
from tests.networks.hardware.made import SPACE, trained

from handeye.networks import CMAC, FixedPoint, FixedVirtualNeuron, HardwareNetwork, VirtualNeuron
from handeye.networks.adaptation import NoAdaptation
from handeye.networks.hardware import fixed, phases, trials
from handeye.networks.hardware.costs import (
    count_trial,
    most_operations,
    phases_in_a_row,
    words_per_neuron,
)
from handeye.networks.hardware.operations import DIVIDE, KINDS
from handeye.networks.hardware.phases import PHASES

N, D, M = 40, 3, 2
X, FAR = np.array([0.2, 0.4, -0.3]), np.array([3.0, 3.0])


def counted(rule, arithmetic=None):
    chip = HardwareNetwork.of(trained(N, adaptation=rule), arithmetic)
    table = count_trial(chip, X, FAR)
    rows = {
        phase: {kind: int(n) for kind, n in zip(KINDS, row, strict=True) if n}
        for phase, row in zip(PHASES, table, strict=True)
    }
    z = np.sum(((trained(N, adaptation=rule).centers - X) / SPACE.scales) ** 2, axis=1)
    o = 2.0 ** (-z * HardwareNetwork.of(trained(N, adaptation=rule), None).cells.gains)
    return rows, int(np.sum(o > rule.on_threshold))


def test_counts_in_double_precision_are_those_of_the_formulas():
    rows, active = counted(VirtualNeuron())
    assert rows["distances"] == {"multiply": N * D, "add": 2 * N * D}
    assert rows["responses"] == {"multiply": N, "look up": N}
    assert rows["outputs"] == {"multiply": N * M, "add": N * M}
    assert rows["errors"] == {"multiply": M, "add": 2 * M, "compare": 1}
    assert rows["gates"] == {"compare": N}
    assert rows["nearest"] == {"compare": active - 1}
    assert rows["virtual width"] == {"divide": 1}
    assert rows["virtual responses"] == {"multiply": active, "look up": active}
    assert rows["overlap"] == {"multiply": active, "add": active}
    assert rows["quotient"] == {"divide": 1}
    assert rows["changes"] == {"multiply": M + M * active, "add": M * active}


def test_cmac_sums_responses_and_changes_all_weights_alike():
    rows, active = counted(CMAC(), FixedPoint(16))
    assert rows["overlap"] == {"add": active}
    # Of a change: the common part, rounded and saturated once, and a saturating sum for each.
    assert rows["changes"] == {
        "multiply": M, "add": M * active, "compare": M + M * active, "shift": 2 * M,
    }  # fmt: skip
    for phase in ("nearest", "virtual width", "virtual responses"):
        assert rows[phase] == {}


@pytest.mark.parametrize("word_length", [8, 24])
def test_in_fixed_point_a_trial_has_one_division_and_the_feedback_none(word_length):
    for rule in (VirtualNeuron(), CMAC(), FixedVirtualNeuron(0.4)):
        rows, _ = counted(rule, FixedPoint(word_length))
        assert {phase: row["divide"] for phase, row in rows.items() if "divide" in row} == {
            "quotient": 1
        }
    rows, _ = counted(VirtualNeuron(), FixedPoint(word_length))
    # Successive approximation: as many trials as a gain has bits, and the product with 1 / h^2.
    assert rows["virtual width"]["multiply"] == word_length - 1 + 1
    assert rows["virtual width"]["compare"] == word_length - 1 + 1


def operators(module):
    """Every operator of a module's functions with its line."""
    for node in ast.walk(ast.parse(inspect.getsource(module))):
        if isinstance(node, ast.BinOp | ast.AugAssign):
            yield node


@pytest.mark.parametrize("module", [fixed, phases, trials])
def test_nothing_is_computed_past_the_counters(module):
    """No quotients at all; products and sums only of constants, which cost a chip nothing."""
    for node in operators(module):
        text = ast.unparse(node)
        assert not isinstance(node.op, ast.Div | ast.FloorDiv | ast.Mod | ast.Pow), text
        if isinstance(node.op, ast.Mult):
            assert isinstance(node, ast.BinOp), text
            assert isinstance(node.left, ast.Constant), text


def test_learning_what_is_right_costs_a_comparison():
    chip = HardwareNetwork.of(trained(N), FixedPoint(16))
    table = count_trial(chip, X, chip.predict(X))
    assert table[PHASES.index("errors")].sum() > 0
    assert table[PHASES.index("gates") :].sum() == 0


def test_counting_changes_nothing():
    chip = HardwareNetwork.of(trained(N), FixedPoint(16))
    before = chip.weights
    count_trial(chip, X, FAR)
    most_operations(chip)
    np.testing.assert_array_equal(chip.weights, before)


@pytest.mark.parametrize("taught", [VirtualNeuron(), CMAC(), FixedVirtualNeuron(0.4)])
def test_no_trial_costs_more_than_the_most(taught):
    chip = HardwareNetwork.of(trained(N, adaptation=taught), FixedPoint(12))
    predict, learn = most_operations(chip)
    rng = np.random.default_rng(0)
    for x in rng.uniform(SPACE.low, SPACE.high, (20, 3)):
        table = count_trial(chip, x, FAR)
        np.testing.assert_array_equal(table[:3].sum(axis=0), list(predict.values()))
        assert np.all(table.sum(axis=0) <= list(learn.values()))
    assert learn[KINDS[DIVIDE]] == 1


def test_the_most_is_counted_however_narrow_the_virtual_neuron_is():
    most = [
        most_operations(HardwareNetwork.of(trained(N, adaptation=rule), FixedPoint(12))).learn
        for rule in (FixedVirtualNeuron(0.4), FixedVirtualNeuron(1e-6))
    ]
    assert most[0] == most[1]


def test_pairs_shorten_the_chain_and_save_words():
    """Appendix B: pairs work more in parallel and store neither response nor width."""
    rules = (VirtualNeuron, FixedVirtualNeuron, CMAC, NoAdaptation)
    paired = [phases_in_a_row(rule, paired=True) for rule in rules]
    single = [phases_in_a_row(rule, paired=False) for rule in rules]
    assert paired == [9, 7, 6, 3]
    assert single == [11, 9, 6, 3]
    assert words_per_neuron(D, M, VirtualNeuron, paired=True) == D + 1 + M
    assert words_per_neuron(D, M, VirtualNeuron, paired=False) == D + 1 + M + 2
    assert words_per_neuron(D, M, CMAC, paired=False) == D + 1 + M


def test_cmac_is_the_cheapest_and_one_width_cheaper_than_the_nearest():
    costs = [
        sum(
            most_operations(
                HardwareNetwork.of(trained(N, adaptation=r), FixedPoint(16))
            ).learn.values()
        )
        for r in (CMAC(), FixedVirtualNeuron(0.4), VirtualNeuron())
    ]
    assert costs == sorted(costs)
    assert costs[0] < 0.8 * costs[1] < 0.8 * costs[2]
