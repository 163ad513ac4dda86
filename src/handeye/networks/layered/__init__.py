"""Networks of neurons in layers, taught by back error propagation (appendix A)."""

from handeye.networks.layered.activations import Linear as Linear
from handeye.networks.layered.activations import Sigmoid as Sigmoid
from handeye.networks.layered.activations import Tanh as Tanh
from handeye.networks.layered.inverse import Commanded as Commanded
from handeye.networks.layered.inverse import InverseLearner as InverseLearner
from handeye.networks.layered.inverse import measured_slopes as measured_slopes
from handeye.networks.layered.network import LayeredNetwork as LayeredNetwork
from handeye.networks.layered.pairs import Pairs as Pairs
from handeye.networks.layered.pairs import fourier_network as fourier_network
from handeye.networks.layered.pairs import gaussian_network as gaussian_network
from handeye.networks.layered.pairs import pair as pair
from handeye.networks.layered.pairs import paired_network as paired_network
