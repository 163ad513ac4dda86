"""FIGAROH on a case of `speed.py`, in a Python that has it: `speed_figaroh.py FOLDER`.

All geometric parameters ("full_params") that it finds to be independent, with base and marker
unknown, by its own closed form, choice of parameters and solver. Timed are choice and solution.
"""

# Its packages live in a Python of their own.
# pyright: reportMissingImports=false

import json
import re
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from figaroh.calibration.base_calibration import BaseCalibration
from figaroh.calibration.calibration_tools import calc_updated_fkm
from figaroh.tools.load_robot import load_robot


class Calibration(BaseCalibration):
    """Positions of one marker, both frames unknown."""

    def __init__(self, robot: Any, config: str) -> None:
        super().__init__(robot, config)
        self.calib_config["known_baseframe"] = False
        self.calib_config["known_tipframe"] = False

    def cost_function(self, var: np.ndarray) -> np.ndarray:
        """Measured minus predicted [m]."""
        return self.PEE_measured - calc_updated_fkm(
            self.model, self.data, var, self.q_measured, self.calib_config
        )


def config_of(about: dict[str, Any], folder: Path, n: int) -> dict[str, Any]:
    """What FIGAROH wants to be told."""
    seen = {"name": "marker", "measurable_dof": [True] * 3 + [False] * 3}
    calibration = {
        "enabled": True,
        "parameters": {"calibration_level": "full_params"},
        "kinematics": {"base_frame": "universe", "tool_frame": about["tip"]},
        "measurements": {"markers": [seen]},
        "data": {"source_file": str(folder / "case.csv"), "number_of_samples": n},
    }
    joints = {"active_joints": about["joint_names"]}
    robot = {"name": "arm", "properties": {"joints": joints}}
    return {"schema_version": 1, "robot": robot, "tasks": {"calibration": calibration}}


def main(folder: Path) -> None:
    """Fit as often as was asked, and write times and predictions."""
    about: Any = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    urdf = (folder / "arm.urdf").read_text(encoding="utf-8")
    # It would look for the meshes.
    for tag in ("visual", "collision"):
        urdf = re.sub(rf"<{tag}\b.*?</{tag}>", "", urdf, flags=re.DOTALL)
    (folder / "bare.urdf").write_text(urdf, encoding="utf-8")
    table = np.hstack([about["positions"], about["joints"]])
    heads = ",".join(["x1", "y1", "z1", *about["joint_names"]])
    np.savetxt(folder / "case.csv", table, delimiter=",", header=heads, comments="")
    config = folder / "config.yaml"
    told = config_of(about, folder, len(table))
    config.write_text(yaml.safe_dump(told), encoding="utf-8")
    seconds, unknowns, predicted = [], 0, np.empty(0)
    for _ in range(about["repeats"]):
        fit = Calibration(load_robot(str(folder / "bare.urdf")), str(config))
        fit.load_data_set()
        began = time.process_time()
        fit.create_param_list()
        result, _ = fit.solve_optimisation()
        seconds.append(time.process_time() - began)
        unknowns = len(result.x)
        q = np.tile(fit.calib_config["q0"], (len(about["judged"]), 1))
        q[:, fit.calib_config["config_idx"]] = about["judged"]
        there = {**fit.calib_config, "NbSample": len(q)}
        flat = calc_updated_fkm(fit.model, fit.data, result.x, q, there)
        predicted = np.reshape(flat, (3, -1)).T
    done = {"seconds": seconds, "unknowns": unknowns, "predicted": predicted.tolist()}
    (folder / "done.json").write_text(json.dumps(done), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
