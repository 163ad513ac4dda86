"""How the combined calibrator learns: what it considers possible, and how careful it is."""

from dataclasses import dataclass

from handeye.arrays import count, scalar
from handeye.errors import InvalidInput


@dataclass(frozen=True)
class Hypothesis:
    """One way in which a robot may differ from its nominal model.

    words   what it says
    curved  whether the learned functions differ from zero at all
    walk    how far a drifting parameter moves from one observation to the next, a standard
            deviation as a share of its tolerance
    memory  observations after which old ones count less: 1/e of them are left
    """

    words: str
    curved: bool = True
    walk: float = 0.0
    memory: float = 100_000.0

    def __post_init__(self) -> None:
        if not 0.0 <= scalar(self.walk, "walk") < 0.5:
            raise InvalidInput(f"walk must be at least 0 and below 0.5, got {self.walk}")
        scalar(self.memory, "memory", least=1000.0)


HYPOTHESES = (
    Hypothesis("as drawn but for its parameters", curved=False),
    Hypothesis("steady, with error curves"),
    Hypothesis("drifting, with error curves", walk=0.005, memory=10_000.0),
)


@dataclass(frozen=True)
class Settings:
    """The same for every robot and every stream.

    hypotheses   what may be so; observations decide, and what all say is averaged
    window       observations that can still be reconsidered
    gate         an observation less likely than this under every hypothesis is not believed
    odds         a change must explain a run of surprises so many times better than outliers do
    envelope     corrected commands bring the hand at most this far from nominal ones [m]
    recent       observations over which the guard compares corrected and nominal commands
    chance       mean over standard error beyond which a comparison is not chance
    patience     observations before it is judged what the model leaves unexplained
    capacity     neurons of the network for what remains; 0 for none

    Raises InvalidInput for settings that make no sense.
    """

    hypotheses: tuple[Hypothesis, ...] = HYPOTHESES
    window: int = 64
    gate: float = 1e-4
    odds: float = 1e5
    envelope: float = 2.0
    recent: int = 30
    chance: float = 3.0
    patience: int = 32
    capacity: int = 200

    def __post_init__(self) -> None:
        if not self.hypotheses or not any(h.curved for h in self.hypotheses):
            raise InvalidInput("at least one hypothesis must have curves")
        count(self.window, "window", least=8)
        if not 0.0 < scalar(self.gate, "gate") < 0.1:
            raise InvalidInput(f"gate must be a probability between 0 and 0.1, got {self.gate}")
        scalar(self.odds, "odds", above=1.0)
        scalar(self.envelope, "envelope", above=0.0)
        count(self.recent, "recent", least=10)
        scalar(self.chance, "chance", above=0.0)
        count(self.patience, "patience", least=4)
        count(self.capacity, "capacity", least=0)
