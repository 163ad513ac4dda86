"""Networks that remember: Albus's CMAC, sigma-pi units, and a Hopfield memory (appendix A)."""

from handeye.networks.memories.albus import AlbusCMAC as AlbusCMAC
from handeye.networks.memories.hopfield import HopfieldMemory as HopfieldMemory
from handeye.networks.memories.hopfield import Recall as Recall
from handeye.networks.memories.sigma_pi import SigmaPi as SigmaPi
from handeye.networks.memories.sigma_pi import monomials as monomials
