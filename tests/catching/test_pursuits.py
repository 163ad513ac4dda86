import numpy as np

from handeye.catching.pursuits import DONE, MOVING, WAITING, Pursuits

YES, NO = np.array([True]), np.array([False])


def advance(pursuits, *, understood=True, may_begin=True, v=0.0, d=1.0, t=0.5):
    flags = (YES if flag else NO for flag in (understood, may_begin))
    return bool(pursuits.advance(*flags, np.array([v]), np.array([d]), np.array([t]))[0])


def moving(*, repeated=False):
    pursuits = Pursuits(1, 0.05, 0.03, repeated=repeated)
    assert advance(pursuits)
    assert advance(pursuits, v=1.0, d=0.5)
    return pursuits


def test_a_pursuit_begins_when_it_is_understood_and_may():
    pursuits = Pursuits(1, 0.05, 0.03, repeated=False)
    assert not advance(pursuits, understood=False)
    assert not advance(pursuits, may_begin=False)
    assert not advance(pursuits, t=0.0)
    assert advance(pursuits)
    assert pursuits.state[0] == MOVING


def test_what_may_not_begin_may_go_on():
    assert advance(moving(), v=1.0, may_begin=False)


def test_stopping_at_the_target_completes_a_single_pursuit():
    for v in (0.04, -0.5):  # stands, or has turned back within the tick
        pursuits = moving()
        assert not advance(pursuits, v=v, d=0.02)
        assert pursuits.state[0] == DONE
        assert not advance(pursuits, v=0.0, d=0.5)


def test_stopping_elsewhere_does_not():
    assert advance(moving(), v=0.0, d=0.2)


def test_standing_before_the_first_movement_is_no_completion():
    pursuits = Pursuits(1, 0.05, 0.03, repeated=False)
    assert advance(pursuits, v=0.0, d=0.01)
    assert advance(pursuits, v=0.0, d=0.01)


def test_a_pursuit_is_over_when_its_arrival_is_due():
    assert not advance(moving(), v=1.0, t=0.0)


def test_movement_counts_towards_the_target():
    pursuits = Pursuits(1, 0.05, 0.03, repeated=False)
    assert advance(pursuits, d=-1.0)
    assert advance(pursuits, v=-1.0, d=-0.01)
    assert not advance(pursuits, v=-0.01, d=-0.01)


def test_repeated_pursuits_follow_each_other():
    pursuits = moving(repeated=True)
    assert advance(pursuits, v=0.0, d=0.02)
    assert not advance(pursuits, t=-0.1)
    assert advance(pursuits, d=0.2)


def test_lost_comprehension_breaks_a_pursuit_off_until_it_returns():
    pursuits = moving()
    assert not advance(pursuits, understood=False, v=1.0)
    assert pursuits.state[0] == WAITING
    assert advance(pursuits, v=1.0)
