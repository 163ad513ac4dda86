"""The command line: `handeye COMMAND`."""

from handeye.cli.app import app as app
from handeye.cli.app import main as main
