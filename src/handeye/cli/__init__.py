"""The command line: `handeye COMMAND`."""

import os

# Before NumPy is loaded: matrices are small here, and threads of the linear algebra that wait for
# each other on a busy machine took minutes where one takes seconds.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from handeye.cli.app import app as app
from handeye.cli.app import main as main
