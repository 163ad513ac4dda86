"""Resource-allocating networks: online regressors that know nothing of robots.

Every network here and in the packages within is a `Learner`: it predicts, and it learns one sample
at a time.
"""

from handeye.networks.adaptation import CMAC as CMAC
from handeye.networks.adaptation import GradientDescent as GradientDescent
from handeye.networks.adaptation import NoAdaptation as NoAdaptation
from handeye.networks.adaptation import VirtualNeuron as VirtualNeuron
from handeye.networks.grids import fixed_grid as fixed_grid
from handeye.networks.grids import variable_grid as variable_grid
from handeye.networks.hardware import FixedPoint as FixedPoint
from handeye.networks.hardware import FixedVirtualNeuron as FixedVirtualNeuron
from handeye.networks.hardware import HardwareNetwork as HardwareNetwork
from handeye.networks.inputs import InputSpace as InputSpace
from handeye.networks.learner import Learner as Learner
from handeye.networks.network import ResourceAllocatingNetwork as ResourceAllocatingNetwork
from handeye.networks.outcomes import Learned as Learned
from handeye.networks.outcomes import LearnedMany as LearnedMany
from handeye.networks.outcomes import LearningDiverged as LearningDiverged
from handeye.networks.responses import Cosine as Cosine
from handeye.networks.responses import Gaussian as Gaussian
from handeye.networks.responses import Parabolic as Parabolic
from handeye.networks.schedules import Constant as Constant
from handeye.networks.schedules import GaussianDecay as GaussianDecay
from handeye.networks.schedules import Logarithmic as Logarithmic
from handeye.networks.schedules import Power as Power
