"""Networks that learn by second-order steps: less error for more work."""

from handeye.networks.recursive.kalman import KalmanNetwork as KalmanNetwork
from handeye.networks.recursive.network import RecursiveNetwork as RecursiveNetwork
