import numpy as np

from handeye.catching.phases import DONE, FAST, MOVING, REST, WAITING, PursuitPhases

YES, NO = np.array([True]), np.array([False])


def advance(phases, *, understood=True, may_begin=True, v=0.0, t=0.5):
    flags = (YES if flag else NO for flag in (understood, may_begin))
    return bool(phases.advance(*flags, np.array([v]), np.array([t]))[0])


def moving(*, repeated=False):
    phases = PursuitPhases(1, 0.05, repeated=repeated)
    assert advance(phases)
    assert advance(phases, v=-1.0)
    return phases


def come_to_rest(phases):
    """Whether it goes on in the last tick that makes the slowness a rest."""
    assert all(advance(phases, v=(-1) ** i * 0.04) for i in range(REST - 1))
    return advance(phases, v=0.0)


def test_a_pursuit_begins_when_it_is_understood_and_may():
    phases = PursuitPhases(1, 0.05, repeated=False)
    assert not advance(phases, understood=False)
    assert not advance(phases, may_begin=False)
    assert not advance(phases, t=0.0)
    assert advance(phases)
    assert phases.phase[0] == MOVING


def test_what_may_not_begin_may_go_on():
    assert advance(moving(), v=1.0, may_begin=False)


def test_coming_to_rest_completes_a_single_pursuit():
    phases = moving()
    assert not come_to_rest(phases)
    assert phases.phase[0] == DONE
    assert not advance(phases, v=0.0)


def test_turning_round_is_no_rest():
    phases = moving()
    for v in (0.5, *[0.01] * (REST - 1), -0.5, *[0.0] * (REST - 1)):
        assert advance(phases, v=v)


def test_standing_before_the_first_movement_is_no_completion():
    phases = PursuitPhases(1, 0.05, repeated=False)
    assert all(advance(phases, v=0.0) for _ in range(3 * REST))


def test_creeping_is_no_pursuit_that_could_come_to_rest():
    phases = PursuitPhases(1, 0.05, repeated=False)
    assert advance(phases)
    assert all(advance(phases, v=v) for v in (FAST * 0.049, *[0.0] * (2 * REST)))
    assert advance(phases, v=FAST * 0.051)
    assert not come_to_rest(phases)


def test_a_pursuit_is_over_when_its_arrival_is_due():
    phases = moving()
    assert not advance(phases, v=1.0, t=0.0)
    assert not advance(phases, v=1.0, t=0.5)


def test_repeated_pursuits_follow_each_other():
    phases = moving(repeated=True)
    assert come_to_rest(phases)
    assert not advance(phases, t=-0.1)
    assert advance(phases)


def test_lost_comprehension_breaks_a_pursuit_off_until_it_returns():
    phases = moving()
    assert not advance(phases, understood=False, v=1.0)
    assert phases.phase[0] == WAITING
    assert advance(phases, v=1.0)


def test_a_pursuit_that_begins_again_has_not_been_fast_yet():
    phases = moving()
    advance(phases, understood=False, v=1.0)
    assert all(advance(phases, v=0.0) for _ in range(3 * REST))
