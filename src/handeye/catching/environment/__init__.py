"""Catching as a task for reinforcement learning: `handeye/Catch-v0`; needs the extra "gym".

Importing this package registers the environment with Gymnasium. Either import it before
`gymnasium.make("handeye/Catch-v0")` and `gymnasium.make_vec`, or name it there:
`gymnasium.make("handeye.catching.environment:handeye/Catch-v0")`.
"""

from handeye.errors import MissingExtra

try:
    import gymnasium
    from PIL import Image as _Image  # noqa: F401  # pyright: ignore[reportUnusedImport]
except ImportError as absent:
    raise MissingExtra("The reinforcement learning environment", "gym") from absent

from handeye.catching.environment.single import CatchEnv as CatchEnv
from handeye.catching.environment.task import CatchTask as CatchTask
from handeye.catching.environment.vector import CatchVectorEnv as CatchVectorEnv

ID = "handeye/Catch-v0"
LONGEST = 120
"""Ticks after which an episode is truncated: 3 s, where a throw takes 1.3 s and a rebound more."""

if ID not in gymnasium.registry:
    gymnasium.register(  # pyright: ignore[reportUnknownMemberType]
        ID,
        entry_point="handeye.catching.environment:CatchEnv",
        vector_entry_point="handeye.catching.environment:CatchVectorEnv",
        max_episode_steps=LONGEST,
    )
