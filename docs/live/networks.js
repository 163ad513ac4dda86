// The networks of "Networks as functions" with one input and one output, small enough to learn
// while somebody watches. tests/test_live_plots.py holds each against handeye.networks.
"use strict";

const handeyeNetworks = (() => {
  const LN2 = Math.log(2);

  // Two sigmoids of opposite gain, their thresholds a distance apart (section A.6.6).
  const pair = (x, gain, distance) => [
    Math.tanh(gain * (x + distance / 2)),
    -Math.tanh(gain * (x - distance / 2)),
  ];

  // Uniform numbers in [0, 1) from a seed: mulberry32, so that everybody sees the same beginning.
  const uniform = (seed) => () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };

  // One hidden layer of tanh and a linear output, taught by back-propagation (eq A.9 to A.14).
  // hidden: weight and threshold of each neuron, out: its weight above; the last is the threshold.
  class Layered {
    constructor(hidden, out, rate = 0.03) {
      Object.assign(this, { hidden: hidden.map((row) => [...row]), out: [...out], rate });
    }

    static drawn(neurons, largest, random) {
      const weight = () => largest * (2 * random() - 1);
      const hidden = Array.from({ length: neurons }, () => [weight(), weight()]);
      return new Layered(hidden, Array.from({ length: neurons + 1 }, weight));
    }

    answers(x) {
      return this.hidden.map(([w, bias]) => Math.tanh(w * x + bias));
    }

    predict(x) {
      const o = this.answers(x);
      return o.reduce((sum, oj, j) => sum + this.out[j] * oj, this.out[o.length]);
    }

    learn(x, target) {
      const o = this.answers(x);
      const error = target - this.predict(x);
      const step = this.rate * error;
      o.forEach((oj, j) => {
        const back = step * this.out[j] * (1 - oj * oj);
        this.out[j] += step * oj;
        this.hidden[j][0] += back * x;
        this.hidden[j][1] += back;
      });
      this.out[o.length] += step;
      return error;
    }
  }

  // A resource-allocating network of Gaussian neurons with the virtual neuron rule (eq 3.58, 3.69).
  class Allocating {
    constructor({ farther = 0.1, rate = 0.06, half = 1.2, first = 0.1, on = 0.1, diameter = 2 } = {}) {
      Object.assign(this, { farther, rate, half, first, on, diameter, neurons: [] });
    }

    static response(distance, width) {
      return Math.exp((-LN2 * distance * distance) / (width * width));
    }

    predict(x) {
      return this.neurons.reduce((sum, n) => sum + n.weight * Allocating.response(x - n.center, n.width), 0);
    }

    learn(x, target) {
      const error = target - this.predict(x);
      if (Math.abs(error) <= 1e-3) return error;
      const nearest = Math.min(...this.neurons.map((n) => Math.abs(x - n.center)));
      if (nearest > this.farther) {
        const width = this.half * (this.neurons.length ? nearest : this.first * this.diameter);
        this.neurons.push({ center: x, width, weight: error });
        return error;
      }
      const active = this.neurons.filter((n) => Allocating.response(x - n.center, n.width) > this.on);
      if (!active.length) return error;
      const reach = this.half * Math.min(...active.map((n) => Math.abs(x - n.center)));
      const virtual = active.map((n) => Allocating.response(x - n.center, Math.max(reach, 1e-6 * this.diameter)));
      const overlap = active.reduce((s, n, j) => s + virtual[j] * Allocating.response(x - n.center, n.width), 0);
      if (overlap > 0) active.forEach((n, j) => (n.weight += (this.rate * error * virtual[j]) / overlap));
      return error;
    }
  }

  // Albus's table: layers of cells, each displaced by a quantum against the one before (eq A.19).
  class Table {
    constructor({ field = 0.4, layers = 8, rate = 0.5 } = {}) {
      Object.assign(this, { field, layers, rate, cells: new Map() });
    }

    active(x) {
      const quantum = Math.floor((x / this.field) * this.layers);
      return Array.from({ length: this.layers }, (_, l) => `${l}:${Math.floor((quantum + l) / this.layers)}`);
    }

    predict(x) {
      return this.active(x).reduce((sum, cell) => sum + (this.cells.get(cell) ?? 0), 0);
    }

    learn(x, target) {
      const error = target - this.predict(x);
      const share = (this.rate * error) / this.layers;
      this.active(x).forEach((cell) => this.cells.set(cell, (this.cells.get(cell) ?? 0) + share));
      return error;
    }
  }

  // A symmetric Hopfield memory of patterns of +1 and -1 (section A.6.1).
  class Memory {
    constructor(patterns) {
      this.sums = patterns[0].map((_, i) =>
        patterns[0].map((_, j) => (i === j ? 0 : patterns.reduce((s, p) => s + p[i] * p[j], 0))),
      );
    }

    input(state, i) {
      return this.sums[i].reduce((sum, w, j) => sum + w * state[j], 0);
    }

    energy(state) {
      return (-0.5 * state.reduce((sum, s, i) => sum + s * this.input(state, i), 0)) / state.length;
    }

    // Updates neurons one at a time, in place; returns how many changed.
    sweep(state, order) {
      const change = (i) => {
        const wrong = this.input(state, i) * state[i] < 0;
        if (wrong) state[i] = -state[i];
        return wrong;
      };
      return order.filter(change).length;
    }
  }

  return { pair, uniform, Layered, Allocating, Table, Memory };
})();
