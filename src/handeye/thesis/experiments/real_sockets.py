"""Can an arm be calibrated without any camera, by a ball that it puts into the same sockets?"""

from handeye.thesis.experiment import Experiment
from handeye.thesis.sockets import DATA, Sockets, left_out

REAL_SOCKETS = Experiment(
    id="real-sockets",
    settings={
        "panda-6": Sockets("panda_6", "panda.urdf"),
        "kuka-14": Sockets("kuka_14", "iiwa14.urdf"),
    },
    measure=left_out,
    deterministic=True,
    needs=DATA,
)
