"""A calibrated model as one file: the nominal robot, its frames, and what was learned."""

from dataclasses import asdict, dataclass
from os import PathLike
from typing import Any

from handeye.arrays import Array
from handeye.calibration.arm import ArmEstimator, ArmSheet
from handeye.calibration.calibrators import NetworkCorrection, Nominal
from handeye.calibration.combined import Combined
from handeye.calibration.combined.storage import combined_from_arrays, combined_to_arrays
from handeye.calibration.estimation.parameter_estimator import ParameterEstimator
from handeye.calibration.estimation.storage import estimator_from_arrays, estimator_to_arrays
from handeye.calibration.models import PlanarMap, PlanarModel
from handeye.calibration.placed_arm import PlacedArm
from handeye.calibration.placement import Placement
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.session import AfterEach, AnyCalibrator
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import Header, read_tensors, write_tensors
from handeye.networks.checked import CheckedLearner
from handeye.networks.storage import from_arrays, to_arrays
from handeye.robots.encoder import AxisEncoder
from handeye.robots.planar import TwoLinkArm
from handeye.robots.urdf import UrdfArm
from handeye.sensors.stereo import StereoHead

FORMAT = "handeye.model"
VERSION = 1

Parts = tuple[dict[str, Array], Header]


@dataclass(frozen=True)
class StoredModel:
    """A calibrator as it was saved, after so many observations."""

    calibrator: AnyCalibrator
    observed: int


def save_model(path: str | PathLike[str], calibrator: AnyCalibrator, observed: int) -> None:
    """Write a calibrator; an old file is replaced once the new one is complete.

    Raises:
        InvalidInput: a calibrator or a model of another kind, an arm that is not from a URDF, or a
            correction by a learner that only a file of its own can hold.
    """
    if not isinstance(
        calibrator, Nominal | NetworkCorrection | ParameterEstimator | ArmEstimator | Combined
    ):
        raise InvalidInput(f"a {type(calibrator).__name__} cannot be stored yet")
    arrays, header = _model_parts(calibrator.model)
    header |= {"calibrator": type(calibrator).__name__, "observed": observed}
    if isinstance(calibrator, NetworkCorrection):
        network, header["network"] = to_arrays(calibrator.network)
        arrays |= {f"network.{name}": array for name, array in network.items()}
    if isinstance(calibrator, ParameterEstimator):
        learned, header["estimator"] = estimator_to_arrays(calibrator)
        arrays |= {f"estimator.{name}": array for name, array in learned.items()}
    if isinstance(calibrator, ArmEstimator):
        arrays |= {"fit.seen": calibrator.seen, "fit.x": calibrator.x}
        header["sheet"] = asdict(calibrator.sheet)
    if isinstance(calibrator, Combined):
        learned, header["combined"] = combined_to_arrays(calibrator)
        arrays |= {f"combined.{name}": array for name, array in learned.items()}
    write_tensors(path, FORMAT, VERSION, arrays, header)


def load_model(path: str | PathLike[str]) -> StoredModel:
    """Read what `save_model` wrote.

    Raises:
        FileFormatError: no such file, damaged, foreign, or from a newer version.
        MissingExtra: a model of a URDF arm without pinocchio.
    """
    arrays, header = read_tensors(path, FORMAT, VERSION, "a calibrated handeye model")
    try:
        model = _model_from(arrays, header)
        return StoredModel(_calibrator(model, arrays, header), int(header["observed"]))
    except (
        AttributeError, FileFormatError, LookupError, OverflowError, TypeError, ValueError,
    ) as error:  # fmt: skip
        raise FileFormatError(
            f"{path}: damaged, its parts do not fit together ({error})"
        ) from error


def _calibrator(model: Any, arrays: dict[str, Array], header: Header) -> AnyCalibrator:
    match header["calibrator"]:
        case "Nominal":
            return Nominal(model)
        case "ParameterEstimator":
            return estimator_from_arrays(model, _part("estimator.", arrays), header["estimator"])
        case "ArmEstimator":
            fitted = ArmEstimator(model, ArmSheet.restored(header["sheet"]))
            fitted.restore(arrays["fit.seen"], arrays["fit.x"])
            return fitted
        case "Combined":
            return combined_from_arrays(model, _part("combined.", arrays), header["combined"])
        case "NetworkCorrection":
            network = from_arrays(_part("network.", arrays), header["network"], CheckedLearner)
            return NetworkCorrection(model, network)
        case other:
            raise FileFormatError(f"it holds an unknown calibrator, {other!r}")


def _part(prefix: str, arrays: dict[str, Array]) -> dict[str, Array]:
    return {n[len(prefix) :]: array for n, array in arrays.items() if n.startswith(prefix)}


def checkpoints(path: str | PathLike[str], calibrator: AnyCalibrator, every: int) -> AfterEach:
    """An `after_each` that saves the calibrator whenever `every` more observations are learned."""
    saved = 0

    def after_each(done: int) -> None:
        nonlocal saved
        if done - saved >= every:
            save_model(path, calibrator, done)
            saved = done

    return after_each


def _model_parts(model: Any) -> Parts:
    match model:
        case PlanarModel():
            header = {"foveate": model.foveate, "nominal": asdict(model.nominal)}
            arrays: dict[str, Array] = {}
        case PlanarMap():
            header, arrays = {"nominal": asdict(model.nominal)}, {}
        case PlacedArm(arm=UrdfArm() as arm):
            header = {"urdf": arm.urdf, "tip": arm.tip, "name": arm.name, "eye": arm.eye}
            arrays = {
                "T_sensor_base": model.placement.T_sensor_base,
                "T_flange_marker": model.placement.T_flange_marker,
                "low": model.low,
                "high": model.high,
            }
            header |= {"turn_std": model.turn_std, "noise": model.noise}
        case _:
            raise InvalidInput(f"a model of {model!r} cannot be stored")
    return arrays, {"model": type(model).__name__, "resolution": model.resolution, **header}


def _model_from(arrays: dict[str, Array], header: Header) -> Any:
    resolution = float(header["resolution"])
    match header["model"]:
        case "PlanarModel":
            return PlanarModel(_plant(header["nominal"]), bool(header["foveate"]), resolution)
        case "PlanarMap":
            return PlanarMap(_plant(header["nominal"]), resolution)
        case "PlacedArm":
            # Files of before a sensor could be on any link know of no eye.
            arm = UrdfArm.from_text(
                header["urdf"], header["tip"], header["name"], header.get("eye")
            )
            placement = Placement(arrays["T_sensor_base"], arrays["T_flange_marker"])
            # Files of before arms were learned with orientations know neither.
            return PlacedArm(
                arm, placement, arrays["low"], arrays["high"], resolution,
                header.get("turn_std"), header.get("noise", 0.0),
            )  # fmt: skip
        case other:
            raise FileFormatError(f"it holds an unknown model, {other!r}")


def _plant(parts: dict[str, Any]) -> PlanarPlant:
    """The plant of `dataclasses.asdict`."""
    encoders = {axis: AxisEncoder(**parts[axis]) for axis in ("alpha", "beta", "gamma")}
    return PlanarPlant(
        arm=TwoLinkArm(**parts["arm"]),
        v_x=float(parts["v_x"]),
        v_y=float(parts["v_y"]),
        head=StereoHead(**parts["head"]),
        **encoders,
    )
