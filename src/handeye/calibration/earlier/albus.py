"""Albus's CMAC in the place of the resource-allocating network."""

from handeye.arrays import scalar
from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.models import PlanarModel
from handeye.networks.inputs import InputSpace
from handeye.networks.memories import AlbusCMAC
from handeye.observations import StereoObservation, StereoTarget


def albus_correction(
    model: PlanarModel,
    *,
    fields: float = 1.5,
    layers: int = 64,
    slots: int = 65_536,
    rate: float = 0.3,
) -> NetworkCorrection[StereoObservation, StereoTarget]:
    """A correction of nominal kinematics, learned by Albus's CMAC (section A.6.4).

    Every input of the model spans `fields` receptive fields. Layers are displaced by 1, 3, 5, ...
    quanta along the inputs, which spreads their corners over the space better than a diagonal. The
    other arguments are those of AlbusCMAC.

    Raises:
        InvalidInput: a setting out of range.
    """
    space = model.space
    width = 1.0 / scalar(fields, "fields", above=0.0)
    cmac = AlbusCMAC(
        space.n_inputs,
        model.n_outputs,
        inputs=InputSpace.box(space.low, space.high, unit=True),
        field=width,
        layers=layers,
        slots=slots,
        rate=rate,
        displacements=range(1, 2 * space.n_inputs, 2),
    )
    return NetworkCorrection(model, cmac)
