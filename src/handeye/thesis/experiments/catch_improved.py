"""How well does the improved learner catch after little practice, told no identities?

And how smoothly, with networks that emit voltages or that trigger the profile generator (section
5.1.2, conclusion 3)?
"""

from dataclasses import dataclass, replace

from handeye.catching.learner import Learner
from handeye.catching.practice import train
from handeye.catching.settings import IMPROVED, SMOOTH, THESIS, CatcherSettings
from handeye.catching.world import World
from handeye.thesis.catching import BALLS, over, performance, throws_for
from handeye.thesis.experiment import Effort, Experiment, Quantities


@dataclass(frozen=True)
class Course:
    """Practice of a learner: pursuits of each arm, tosses of each ball, throws with a mentor."""

    settings: CatcherSettings = IMPROVED
    pursuits: int = 300
    tosses: int = 100
    mentored: int = 50


def combinations(setting: Course, replicate: int, effort: Effort) -> Quantities:
    """What `performance` measures of each ball and arm, as `<ball>_ball_<arm>_arm_<quantity>`.

    mean_caught, mean_roughness
                              of fresh throws, over the four
    """
    world, learner = World(), Learner(setting.settings)
    train(
        learner, world, replicate, pursuits=effort.of(setting.pursuits),
        tosses=effort.of(setting.tosses), mentored=effort.of(setting.mentored),
    )  # fmt: skip
    found = {
        f"{ball}_ball_{arm}_arm": performance(
            world, throws_for(BALLS[ball], BALLS[arm], replicate, effort), learner.catcher()
        )
        for ball in BALLS
        for arm in BALLS
    }
    measured = {f"{pair}_{key}": x for pair, one in found.items() for key, x in one.items()}
    means = {
        f"mean_{name}": over(measured, [f"{pair}_{name}" for pair in found])
        for name in ("caught", "roughness")
    }
    return {**measured, **means}


CATCH_IMPROVED = Experiment(
    id="catch-improved",
    settings={"improved": Course(), "smooth": Course(SMOOTH)},
    measure=combinations,
    replicates=10,
)

CHANGES: dict[str, tuple[str, ...]] = {
    "replayed samples and wide neurons": (
        "arm_state", "motor_command", "ball_recognition", "ball_state", "ball_crossing",
    ),
    "its own comparators": ("ball_comparator", "arm_comparator", "arm_threshold"),
    "gentle practice": ("gentle", "least_amplitude"),
    "repeated pursuits": ("repeated", "reach"),
    "trying every identity": ("try_all",),
    "shaking the arm first": ("excitation",),
    "leaving out the mentor": ("largest_correction", "catch_correction"),
}  # fmt: skip
"""What differs between the improved and the thesis's learner, and the settings that do it."""


def without(change: str) -> CatcherSettings:
    """The improved learner with one change taken back."""
    return replace(IMPROVED, **{name: getattr(THESIS, name) for name in CHANGES[change]})


CATCH_CHANGES = Experiment(
    id="catch-changes",
    settings={
        "all": Course(),
        **{change.replace(" ", "-"): Course(without(change)) for change in CHANGES},
        "none": Course(THESIS),
    },
    measure=combinations,
    replicates=10,
)
