import numpy as np

from handeye.catching.mentor import advise, arrival


def test_advice_equals_eq_4_5_and_4_6():
    b_xc, t_c = np.array([1.50, 2.0]), np.array([1.10, 1.0])
    a_xs, t_s = np.array([1.43, 2.1]), np.array([1.08, 0.7])
    advice = advise(b_xc, t_c, a_xs, t_s)
    # Short of the crossing: farther; too late: earlier. Too far: back; far too early: later.
    np.testing.assert_allclose(advice.delta_x, [0.07, -0.1])
    np.testing.assert_allclose(advice.delta_t, [-0.08, 0.2])


def test_an_arm_has_arrived_when_it_stays_near_its_last_place():
    time = 0.1 * np.arange(6.0)[:, np.newaxis]
    arm_x = np.array([[0.0], [0.5], [0.96], [1.0], [0.98], [1.0]])
    x, t = arrival(time, arm_x, np.array([0.52]), np.array([0.99]), 0.05)
    np.testing.assert_allclose((x[0], t[0]), (0.99, 0.2))
    passing_by = np.array([[1.0], [0.5], [0.0], [0.5], [1.0], [1.0]])
    assert arrival(time, passing_by, np.array([0.52]), np.array([1.0]), 0.05)[1][0] == 0.4


def test_an_arm_that_moves_to_the_end_arrives_at_the_end():
    time = np.array([[0.0, 0.0], [0.1, 0.1], [np.nan, 0.2]])
    arm_x = np.array([[0.0, 0.0], [0.5, 0.5], [np.nan, 0.9]])
    x, t = arrival(time, arm_x, np.array([0.15, 0.25]), np.array([0.8, 1.2]), 0.05)
    np.testing.assert_array_equal(x, [0.8, 1.2])
    np.testing.assert_array_equal(t, [0.15, 0.25])
