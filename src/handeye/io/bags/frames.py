"""Which sighting is meant, and how transforms are put together."""

from collections import deque
from collections.abc import Iterable, Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from handeye.errors import LogError
from handeye.io.bags.report import BagOptions
from handeye.io.bags.tracks import Sightings, Stream, Track

_MOST_SHOWN = 20
Pair = tuple[str, str]
"""A frame and what is seen in it, or the parent and child of a transform."""


def choose(file: str, topic: str, seen: Sightings, options: BagOptions) -> tuple[Pair, Track]:
    """The frame and marker that `options` name, or the only ones there are, and their sightings.

    Raises:
        LogError: where there is none, or more than one, listing all.
    """
    fitting = {pair: s for pair, s in seen.streams.items() if _fits(pair, options)}
    if len(fitting) == 1:
        [(pair, stream)] = fitting.items()
        return pair, Track.of(stream)
    start = f"{file}: {topic}"
    if not seen.streams:
        raise LogError(f"{start} has no sighting that can be used")
    if not fitting:
        raise LogError(f"{start} has nothing{_asked(options)}; it has\n{listed(seen.streams)}")
    raise LogError(
        f"{start} has sightings of several things{_asked(options)}; say which with --frame FRAME "
        f"and --marker MARKER (in Python: frame=, marker=):\n{listed(fitting)}"
    )


def compose(file: str, topic: str, seen: Sightings, options: BagOptions) -> tuple[Pair, Track]:
    """The poses of one frame of a tree of transforms in another.

    The way from frame to marker may have any number of fixed transforms, but one that moves: two
    would be two measurements, or the arm's own kinematics. A transform that is sent again and
    again with the same values counts as fixed where the way has others.

    Raises:
        LogError: where it is not clear which frames are meant, listing the moving ones, or where
            the way between them is none of these.
    """
    frame, marker = options.frame, options.marker
    if frame is None or marker is None:
        direct = {p: s for p, s in seen.streams.items() if _fits(p, options)}
        moving = {pair: s for pair, s in direct.items() if not _constant(s)} or direct
        if len(moving) != 1:
            raise LogError(
                f"{file}: {topic} has {len(moving)} moving transforms{_asked(options)}; say "
                "with --frame PARENT --marker CHILD (in Python: frame=, marker=) which is the "
                f"sensor's frame and which the marker's:\n{listed(moving or seen.streams)}"
            )
        [(frame, marker)] = moving
    way = _way(frame, marker, [*seen.streams, *seen.fixed])
    if way is None:
        raise LogError(
            f"{file}: no transforms of {topic} lead from {frame} to {marker}; choose frames from\n"
            f"{listed(seen.streams)}"
        )
    measured = [step for step in way if _stored(step) in seen.streams]
    if len(measured) > 1:
        measured = [s for s in measured if not _constant(seen.streams[_stored(s)])]
    if len(measured) != 1:
        moves = ", ".join(f"{a} to {b}" for a, b, _ in measured) or "none"
        raise LogError(
            f"{file}: between {frame} and {marker} one transform must be measured and all others "
            f"fixed, but there move: {moves}; choose the frames next to the sensor's measurement "
            "with --frame and --marker"
        )
    return (frame, marker), _along(way, measured[0], seen)


def listed(streams: Mapping[Pair, Stream]) -> str:
    """One line for each frame and marker, the most frequent first."""
    ranked = sorted(streams.items(), key=lambda item: (-len(item[1]), item[0]))
    lines = [
        f"  --frame {frame}" + (f" --marker {marker}" if marker else "") + f"  ({len(s)} times)"
        for (frame, marker), s in ranked[:_MOST_SHOWN]
    ]
    more = len(ranked) - _MOST_SHOWN
    return "\n".join(lines + ([f"  and {more} more"] if more > 0 else []))


_Step = tuple[str, str, bool]  # from, to, and whether the stored transform goes that way


def _way(start: str, end: str, pairs: Iterable[Pair]) -> list[_Step] | None:
    """The shortest way through the tree, or None."""
    steps: dict[str, list[_Step]] = {}
    for parent, child in pairs:
        steps.setdefault(parent, []).append((parent, child, True))
        steps.setdefault(child, []).append((child, parent, False))
    came: dict[str, _Step | None] = {start: None}
    waiting = deque([start])
    while waiting and end not in came:
        for step in steps.get(waiting.popleft(), ()):
            if step[1] not in came:
                came[step[1]] = step
                waiting.append(step[1])
    if end not in came:
        return None
    way: list[_Step] = []
    step = came[end]
    while step is not None:
        way.append(step)
        step = came[step[0]]
    return way[::-1]


def _stored(step: _Step) -> Pair:
    origin, target, forward = step
    return (origin, target) if forward else (target, origin)


def _along(way: list[_Step], measured: _Step, seen: Sightings) -> Track:
    """The product of all transforms of a way, at every stamp of the measured one."""
    track = Track.of(seen.streams[_stored(measured)])
    turn, place = Rotation.identity(len(track.stamps)), np.zeros((len(track.stamps), 3))
    for step in way:
        pair = _stored(step)
        if step == measured:
            values = track.values
        elif pair in seen.fixed:
            values = np.array([seen.fixed[pair]])
        else:
            values = np.array([seen.streams[pair].values[:7]])
        next_turn = Rotation.from_quat(values[:, 3:], scalar_first=True)
        next_place = values[:, :3]
        if not step[2]:
            next_turn = next_turn.inv()
            next_place = -next_turn.apply(next_place)
        place = place + turn.apply(next_place)
        turn = turn * next_turn
    wxyz = turn.as_quat(canonical=True, scalar_first=True)
    return track._replace(values=np.hstack([place, wxyz]))


def _constant(stream: Stream) -> bool:
    values = np.array(stream.values).reshape(-1, stream.width)
    return bool(np.all(values == values[0]))


def _fits(pair: Pair, options: BagOptions) -> bool:
    wanted = zip((options.frame, options.marker), pair, strict=True)
    return all(want is None or want.lstrip("/") == have for want, have in wanted)


def _asked(options: BagOptions) -> str:
    where = "" if options.frame is None else f" in frame {options.frame}"
    what = "" if options.marker is None else f" of marker {options.marker}"
    return f"{what}{where}"
