"""Networks that learn by recursive least squares: error and cost of the second order."""

from handeye.networks.recursive.network import RecursiveNetwork as RecursiveNetwork
