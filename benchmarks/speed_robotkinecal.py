"""robotkinecal on a case of `speed.py`, in a Python that has it: `speed_robotkinecal.py FOLDER`.

Its method works on screws, so the chain is given as these, in the frame of the sensor: base, joints
and marker are all free then, four numbers for each joint and three for the marker.
"""

# Its packages live in a Python of their own.
# pyright: reportMissingImports=false

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from roboticstoolbox import PoERevolute, PoERobot
from robotkinecal import SerialRobotKineCal
from spatialmath import SE3


def main(folder: Path) -> None:
    """Fit as often as was asked, and write times and predictions."""
    about: Any = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    seconds, unknowns, predicted = [], 0, np.empty(0)
    for _ in range(about["repeats"]):
        np.random.seed(0)  # noqa: NPY002  (it draws directions from the global generator)
        axes = [PoERevolute(s[3:], np.cross(s[3:], s[:3])) for s in np.array(about["screws"])]
        fit = SerialRobotKineCal(PoERobot(axes, SE3(np.array(about["rest"]))))
        # It takes the fixed links that roboticstoolbox puts before and after for joints.
        fit.joint_screw_axis = list(np.array(about["screws"]))
        fit.N_JOINTS = len(about["screws"])
        began = time.process_time()
        fit.set_observations(list(np.array(about["joints"])), list(np.array(about["positions"])))
        fit.solve()
        seconds.append(time.process_time() - began)
        unknowns = int(fit.N_PARAMS)
        ways = [fit.forward_kinematics(fit.N_JOINTS + 1, q) for q in about["judged"]]
        predicted = np.array([way.t for way in ways])
    done = {"seconds": seconds, "unknowns": unknowns, "predicted": predicted.tolist()}
    (folder / "done.json").write_text(json.dumps(done), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
