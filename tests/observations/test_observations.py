"""One observation or N of them, checked when made."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.errors import InvalidInput
from handeye.observations import PointObservation, PointTarget, StereoObservation, StereoTarget

KINDS = {
    StereoTarget: {"pointing": (), "range": (), "eccentricity": (), "elbow": ()},
    StereoObservation: {
        "time": (), "joints": (2,), "pointing": (), "range": (), "eccentricity": (),
    },
    PointTarget: {"position": (3,), "posture": (6,)},
    PointObservation: {
        "time": (), "joints": (6,), "position": (3,), "orientation": (4,), "position_std": (3,),
    },
}  # fmt: skip
EACH = pytest.mark.parametrize("kind", KINDS)


def values(kind, lead=(), seed=0):
    rng = np.random.default_rng(seed)
    made = {name: rng.normal(size=(*lead, *shape)) for name, shape in KINDS[kind].items()}
    if "elbow" in made:
        made["elbow"] = np.sign(made["elbow"])
    return made


@EACH
def test_fields_are_the_ones_described_here(kind):
    assert [f.name for f in fields(kind)] == list(KINDS[kind])


@EACH
@given(n=st.integers(0, 5), index=st.integers(0, 4))
def test_picking_and_iterating_are_those_of_arrays(kind, n, index):
    made = values(kind, (n,))
    many = kind(**made)
    assert len(many) == n
    assert len(list(many)) == n
    for name, array in made.items():
        np.testing.assert_array_equal(getattr(many, name), array)
        np.testing.assert_array_equal(getattr(many[1:3], name), array[1:3])
        np.testing.assert_array_equal(getattr(many[::-1], name), array[::-1])
    if index < n:
        for name, array in made.items():
            np.testing.assert_array_equal(getattr(many[index], name), array[index])
            np.testing.assert_array_equal(getattr(many[[index]], name), array[[index]])
    else:
        with pytest.raises(IndexError):
            many[index]


@EACH
def test_one_has_no_length_and_can_be_made_a_batch_of_one(kind):
    one = kind(**values(kind))
    with pytest.raises(TypeError, match=f"a single {kind.__name__} has no length"):
        len(one)
    with pytest.raises(TypeError):
        iter(one)
    assert len(one[np.newaxis]) == 1


@EACH
@given(data=st.data())
def test_every_field_is_checked(kind, data):
    lead = data.draw(st.sampled_from([(), (3,)]))
    made = values(kind, lead)
    name = data.draw(st.sampled_from(sorted(made)))
    shape = made[name].shape
    wrong = data.draw(
        st.sampled_from([
            np.full(shape, np.nan), np.full(shape, np.inf), np.full(shape, "1"),
            np.full(shape, 1j), np.ones((2, *shape)), np.ones((1, 1, *shape)),
        ])
    )  # fmt: skip
    with pytest.raises(InvalidInput):
        kind(**(made | {name: wrong}))


@EACH
@pytest.mark.parametrize("lead", [(), (3,)])
def test_widths_of_vectors_that_have_one_are_checked(kind, lead):
    for name, shape in KINDS[kind].items():
        if shape in {(2,), (3,), (4,)}:
            for width in (shape[0] - 1, shape[0] + 1):
                wrong = {name: np.zeros((*lead, width))}
                with pytest.raises(InvalidInput, match=f"{name} must have shape"):
                    kind(**(values(kind, lead) | wrong))


@EACH
def test_lengths_must_agree(kind):
    name, *_ = KINDS[kind]
    with pytest.raises(InvalidInput, match=f"differ in number: {name} 4, .* 3"):
        kind(**(values(kind, (3,)) | {name: values(kind, (4,))[name]}))
    with pytest.raises(InvalidInput, match=f"differ in number: {name} one, .* 3"):
        kind(**(values(kind, (3,)) | {name: values(kind)[name]}))


@EACH
def test_there_is_at_most_one_leading_axis(kind):
    with pytest.raises(InvalidInput, match="must have shape"):
        kind(**values(kind, (2, 3)))


@EACH
def test_only_what_is_optional_may_be_absent(kind):
    for field in fields(kind):
        absent = values(kind, (3,)) | {field.name: None}
        if field.name in {"orientation", "position_std"}:
            assert getattr(kind(**absent)[1:], field.name) is None
        else:
            with pytest.raises(InvalidInput, match=f"{field.name} must be real numbers"):
                kind(**absent)


@EACH
def test_fields_cannot_be_set(kind):
    one = kind(**values(kind))
    with pytest.raises(AttributeError):
        one.elbow = 1.0


@pytest.mark.parametrize("elbow", [0.0, 2.0, -1.5])
def test_an_elbow_is_a_sign(elbow):
    with pytest.raises(InvalidInput, match="elbow must be 1 or -1"):
        StereoTarget(**(values(StereoTarget) | {"elbow": elbow}))


def test_a_planar_sighting_as_a_target_keeps_the_elbow_of_the_arm():
    seen = StereoObservation(**values(StereoObservation, (7,)))
    seen.joints[:3, 1] = [0.0, -0.0, -1e-300]
    target = seen.target
    np.testing.assert_array_equal(target.elbow[:3], [1.0, 1.0, -1.0])
    np.testing.assert_array_equal(target.elbow[3:], np.sign(seen.joints[3:, 1]))
    for name in ("pointing", "range", "eccentricity"):
        np.testing.assert_array_equal(getattr(target, name), getattr(seen, name))


def test_a_sighting_in_space_as_a_target_keeps_the_posture():
    seen = PointObservation(**values(PointObservation, (7,)))
    np.testing.assert_array_equal(seen.target.position, seen.position)
    np.testing.assert_array_equal(seen.target.posture, seen.joints)
