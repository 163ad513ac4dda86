"""The formulas of sections 3.5.1 to 3.5.4 and A.6.3, written out in plain NumPy."""

import numpy as np


def respond(response, z, R):
    """Eq 3.45, 3.107, 3.108."""
    r = np.sqrt(z) / R
    match type(response).__name__:
        case "Gaussian":
            return np.exp(-z / R)
        case "Cosine":
            return np.where(r < 1, (1 + np.cos(np.pi * r)) / 2, 0)
        case "Parabolic":
            return np.select([r <= 0.5, r <= 1], [1 - 2 * r**2, 2 * (1 - r) ** 2], 0)
    raise NotImplementedError


def slopes(response, z, R):
    """Eq 3.62, 3.63 and 3.109 to 3.112."""
    d = np.sqrt(z)
    match type(response).__name__:
        case "Gaussian":
            return -np.exp(-z / R) / R, z / R**2 * np.exp(-z / R)
        case "Cosine":
            s = np.where(d < R, np.sin(np.pi * d / R), 0)
            return -np.pi * s / (4 * R * d), np.pi * d * s / (2 * R**2)
        case "Parabolic":
            tests = [d < R / 2, d <= R]
            return (
                np.select(tests, [-2 / R**2, -2 * (R - d) / (d * R**2)], 0),
                np.select(tests, [4 * d**2 / R**3, 4 * (R - d) * d / R**3], 0),
            )
    raise NotImplementedError


def width(response, half_distance):
    """Response one half there."""
    if type(response).__name__ == "Gaussian":
        return half_distance**2 / np.log(2)
    return 2 * half_distance


def threshold(schedule, t, D):
    """Eq 3.47 to 3.56."""
    match type(schedule).__name__:
        case "Constant":
            return schedule.threshold
        case "Power":
            return schedule.k * D / t**schedule.exponent
        case "GaussianDecay":
            return D * np.exp(-((t / schedule.chi) ** 2))
        case "Logarithmic":
            return schedule.k * D / np.log(t + 1)
    raise NotImplementedError


class PlainNetwork:
    """The written-out formulas, on a copy of a network's state in scaled units."""

    def __init__(self, network, *, theta_e, theta_l, h, first_width, smallest_width):
        self.network = network
        self.scales = network.inputs.scales
        self.D = np.sqrt((((network.inputs.high - network.inputs.low) / self.scales) ** 2).sum())
        self.theta_e, self.theta_l, self.h = theta_e, theta_l, h
        self.first, self.floor = first_width * h * self.D, smallest_width * self.D
        self.take()

    def take(self):
        """Start again from the network's state."""
        self.C = self.network.centers / self.scales
        self.R = self.network.widths
        self.W = self.network.weights
        self.t = self.network.trials

    def learn(self, x, target):
        """Section A.6.3; returns the error before, and which of the three things was done."""
        x = x / self.scales
        z = ((x - self.C) ** 2).sum(axis=1)
        o = respond(self.network.response, z, self.R)
        e = target - self.W.T @ o
        self.t += 1
        size = np.sqrt((e**2).sum())
        distance = np.sqrt(z.min()) if len(z) else np.inf
        theta_d = threshold(self.network.schedule, self.t, self.D)
        room = self.network.capacity is None or len(self.R) < self.network.capacity
        if size > self.theta_e and distance > theta_d and room:
            half = max(self.h * distance, self.floor) if len(z) else self.first
            self.C = np.vstack([self.C, x])
            self.R = np.append(self.R, width(self.network.response, half))
            self.W = np.vstack([self.W, e])  # eq 3.46
            return e, "allocate"
        if size > self.theta_l:
            self.adapt(x, z, o, e)
            return e, "adapt"
        return e, "nothing"

    def adapt(self, x, z, o, e):
        """Eq 3.69, 3.73 and 3.59 to 3.61."""
        rule, response = self.network.adaptation, self.network.response
        active = o > getattr(rule, "on_threshold", -1)
        match type(rule).__name__:
            case "VirtualNeuron" if active.any():
                half = max(self.h * np.sqrt(z[active].min()), self.floor)
                V = respond(response, z, width(response, half)) * active
                if (V * o).sum() > 0:
                    self.W = self.W + rule.rate / (V * o).sum() * np.outer(V, e)
            case "FixedVirtualNeuron":
                half = max(rule.half_distance, self.floor)
                V = respond(response, z, width(response, half)) * active
                if (V * o).sum() > 0:
                    self.W = self.W + rule.rate * np.outer(V, e) / (V * o).sum()
            case "CMAC" if active.any():
                self.W = self.W + rule.rate / o[active].sum() * np.outer(active, e)
            case "GradientDescent":
                by_z, by_width = slopes(response, z, self.R)
                back = self.W @ e
                W = self.W + rule.rate * np.outer(o, e)
                C = self.C - 2 * rule.rate * (by_z * back)[:, None] * (x - self.C)
                R = self.R + rule.rate * by_width * back
                self.W, self.C, self.R = W, C, np.maximum(R, width(response, self.floor))
            case "VirtualNeuron" | "CMAC" | "NoAdaptation":
                pass
            case _:
                raise NotImplementedError
