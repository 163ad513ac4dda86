"""Figures that show how something is built, and no result."""

from handeye.thesis.figures.figure import NotDrawn

_LAYOUT = "a drawing of the robot; its geometry is `handeye.calibration.plant`"
_BLOCKS = "a block diagram; the blocks are the calls of `handeye.calibration.calibrators`"
_PID = "a block diagram; the controller is `handeye.catching.pid`"

DRAWINGS = [
    NotDrawn("3.1", "Layout of arm, eye and base", _LAYOUT),
    NotDrawn(
        "3.2",
        "Processing of stereo images, with its errors",
        "a block diagram; its equations are `StereoHead.measure`",
    ),
    NotDrawn(
        "3.3",
        "Geometry of the two cameras",
        "a drawing; the noise that follows from it is `StereoHead.range_std` and "
        "`eccentricity_std`",
    ),
    NotDrawn("3.4", "Calibration as a program, and in the background", _BLOCKS),
    NotDrawn("3.5", "Adaptation with a network", _BLOCKS),
    NotDrawn(
        "3.6",
        "Pointing of the eye, with its errors",
        "a block diagram; its equations are `PlanarPlant.sight`",
    ),
    NotDrawn(
        "3.7",
        "Positioning of the arm, with its errors",
        "a block diagram; its equations are `PlanarPlant.tips`",
    ),
    NotDrawn(
        "3.17",
        "How a virtual neuron shares out a correction",
        "a sketch of the rule; the rule is `handeye.networks.VirtualNeuron`",
    ),
    NotDrawn(
        "3.19",
        "How CMAC shares out a correction",
        "a sketch of the rule; the rule is `handeye.networks.CMAC`",
    ),
    NotDrawn(
        "3.50",
        "Adaptation with nonlinear estimation",
        "a block diagram; the estimator is `handeye.calibration.estimation`",
    ),
    NotDrawn(
        "4.2",
        "Structure of the learning control system",
        "a block diagram; the blocks are the modules of `handeye.catching`",
    ),
    NotDrawn("4.5", "What the mentor does", "a block diagram; its equations are `mentor.advise`"),
    NotDrawn(
        "4.6",
        "Control while catching",
        "a block diagram; the blocks are the steps of `handeye.catching.catcher`",
    ),
    NotDrawn("4.17", "Closed loop with a PID controller", _PID),
    NotDrawn("4.18", "The same with the parameters of Internal Model Control", _PID),
    NotDrawn(
        "A.1",
        "A biological neuron",
        "a sketch; the activation is `handeye.networks.layered.Sigmoid`",
    ),
    NotDrawn("A.2", "An idealized neuron", "a diagram; it is a row of `LayeredNetwork.weights`"),
    NotDrawn(
        "A.3", "A recurrent and a feedforward network", "a diagram of connections, with no result"
    ),
    NotDrawn(
        "A.4",
        "A resource-allocating network",
        "a diagram; the network is `ResourceAllocatingNetwork`",
    ),
    NotDrawn(
        "A.5",
        "Learning by allocating neurons",
        "a sketch of the rule; the rule is `handeye.networks.kernels`",
    ),
]
