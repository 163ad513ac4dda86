"""Networks as a chip runs them (appendix B): phases, fixed point, counted operations, C."""

from handeye.networks.hardware.chip import HardwareNetwork as HardwareNetwork
from handeye.networks.hardware.fixed_width import FixedVirtualNeuron as FixedVirtualNeuron
from handeye.networks.hardware.formats import FixedPoint as FixedPoint
