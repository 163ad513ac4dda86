// The live plots: each fills the element with its name in data-live.
"use strict";

(() => {
  const { element, button, slider, axes } = handeyeDrawing;
  const { pair, uniform, Layered, Allocating, Table, Memory } = handeyeNetworks;
  const UNIT = [-1, -0.5, 0, 0.5, 1];
  const minus = (v) => `${v}`.replace("-", "−");

  // Figures A.6 and A.7 with any gain and distance.
  const sigmoids = (box) => {
    const plot = axes(box, {
      x: [-2 * Math.PI, 2 * Math.PI], y: [-1.2, 2.4], yTicks: [-1, 0, 1, 2],
      xTicks: [[-2, "−2π"], [-1, "−π"], [0, "0"], [1, "π"], [2, "2π"]].map(([v, name]) => [v * Math.PI, name]),
      xLabel: "x", yLabel: "answers, and their sum", title: "A pair of sigmoids and its sum",
    });
    const cosine = plot.curve("other");
    const single = [plot.curve("thin"), plot.curve("thin")];
    const sum = plot.curve("main");
    plot.draw(cosine, (x) => (Math.abs(x) <= Math.PI ? 1 + Math.cos(x) : 0));
    const said = element("p", { class: "said", "aria-live": "polite" });
    const gain = slider("gain", { least: 0.2, most: 8, step: 0.05, value: 1 }, () => show());
    const apart = slider("distance of the thresholds", { least: 0.2, most: 6.28, step: 0.01, value: 3.14 }, () => show());
    const both = (x) => pair(x, gain.value(), apart.value());
    const show = () => {
      single.forEach((path, i) => plot.draw(path, (x) => both(x)[i]));
      plot.draw(sum, (x) => both(x)[0] + both(x)[1]);
      const steps = Array.from({ length: 401 }, (_, i) => -Math.PI + (i / 200) * Math.PI);
      const most = Math.max(...steps.map((x) => Math.abs(both(x)[0] + both(x)[1] - 1 - Math.cos(x))));
      said.textContent = `Within a period the sum differs from 1 + cos x (dashed) by at most ${most.toFixed(2)}.`;
    };
    box.append(gain.row, apart.row, said);
    show();
  };

  const KINDS = {
    "Neurons in layers": () => Layered.drawn(12, 2, uniform(1)),
    "Gaussian neurons": () => new Allocating(),
    "Albus's table": () => new Table(),
  };

  const sine = (network, samples) => {
    const random = uniform(2);
    for (let i = 0; i < samples; i += 1) {
      const x = 2 * random() - 1;
      network.learn(x, Math.sin(Math.PI * x));
    }
    return network;
  };

  // Figure 6.10 by hand: each network has learned a sine; a click teaches it one sample.
  const teaching = (box) => {
    const plot = axes(box, {
      x: [-1, 1], y: [-1.6, 1.6], yTicks: [-1, 0, 1], xTicks: UNIT.map((v) => [v, minus(v)]),
      xLabel: "input", yLabel: "output", title: "What a network answers; click to teach it a sample",
    });
    plot.svg.classList.add("teach");
    const before = plot.curve("other");
    const now = plot.curve("main");
    const dots = plot.svg.appendChild(element("g"));
    const said = element("p", { class: "said", "aria-live": "polite" });
    const input = slider("input", { least: -1, most: 1, step: 0.01, value: 0.2 }, () => {});
    const target = slider("target", { least: -1.5, most: 1.5, step: 0.01, value: 1.2 }, () => {});
    const trained = Object.fromEntries(Object.entries(KINDS).map(([name, made]) => [name, sine(made(), 20000)]));
    let kind = Object.keys(KINDS)[0];
    let samples = [];
    const begin = () => {
      trained[kind] = sine(KINDS[kind](), 20000);
      samples = [];
      dots.replaceChildren();
      [before, now].forEach((path) => plot.draw(path, (x) => trained[kind].predict(x)));
      said.textContent = "It has learned a sine. Click beside the curve, or choose a sample and press Teach.";
    };
    const learn = (some) => {
      const network = trained[kind];
      const grid = Array.from({ length: 201 }, (_, i) => -1 + i / 100);
      const old = grid.map((x) => network.predict(x));
      plot.draw(before, (x) => network.predict(x));
      const errors = some.map(([x, y]) => network.learn(x, y));
      plot.draw(now, (x) => network.predict(x));
      const change = grid.map((x, i) => [x, Math.abs(network.predict(x) - old[i])]);
      const far = change.filter(([x]) => some.every(([at]) => Math.abs(x - at) > 0.4)).map(([, c]) => c);
      const size = Math.abs(errors[errors.length - 1]).toFixed(2);
      const elsewhere = far.length ? ` Farther than 0.4 from what was shown it changed by up to ${Math.max(...far).toFixed(3)}.` : "";
      said.textContent = `The ${some.length > 1 ? "last " : ""}error was ${size} before it was learned.${elsewhere}`;
    };
    const teach = (x, y) => {
      samples.push([x, y]);
      dots.append(element("circle", { cx: plot.toX(x), cy: plot.toY(y), r: 4 }));
      learn([[x, y]]);
    };
    plot.svg.addEventListener("click", (event) => {
      const [x, y] = plot.from(event);
      if (Math.abs(x) > 1 || Math.abs(y) > 1.6) return;
      input.set(x);
      target.set(y);
      teach(x, y);
    });
    const choice = element("div", { class: "choice", role: "radiogroup", "aria-label": "network" });
    Object.keys(KINDS).forEach((name) => {
      const radio = element("input", { type: "radio", name: "live-network", value: name, onchange: () => { kind = name; begin(); } });
      radio.checked = name === kind;
      choice.append(element("label", {}, radio, ` ${name}`));
    });
    const again = () => samples.length && learn(Array.from({ length: 10 }, () => samples).flat());
    const buttons = element("div", { class: "buttons" },
      button("Teach", () => teach(input.value(), target.value())), button("All of them ten times", again), button("Begin anew", begin));
    box.prepend(choice);
    box.append(input.row, target.row, buttons, said);
    begin();
  };

  const LETTERS = [
    "#.....#|#.....#|#.....#|#######|#.....#|#.....#|#.....#",
    "..###..|.#...#.|#.....#|#..#..#|#.....#|.#...#.|..###..",
    "#######|....#..|...#...|..#....|.#.....|#......|#######",
  ].map((rows) => [...rows.replaceAll("|", "")].map((c) => (c === "#" ? 1 : -1)));

  // Three pictures in a Hopfield memory: spoil one, and let it come to rest.
  const memory = (box) => {
    const network = new Memory(LETTERS);
    const random = uniform(3);
    let state = [...LETTERS[0]];
    const said = element("p", { class: "said", "aria-live": "polite" });
    const cells = state.map((_, i) => element("button", {
      type: "button", "aria-label": `point ${i + 1}`, onclick: () => { state[i] = -state[i]; show("One neuron was turned over."); },
    }));
    const show = (what) => {
      cells.forEach((cell, i) => cell.setAttribute("aria-pressed", state[i] > 0));
      const alike = LETTERS.findIndex((p) => p.every((v, i) => v === state[i]));
      const which = alike < 0 ? "It is none of the pictures." : `It is picture ${alike + 1}.`;
      said.textContent = `${what} The energy is ${minus(network.energy(state).toFixed(2))}. ${which}`;
    };
    const order = () => {
      const left = state.map((_, i) => i);
      return state.map(() => left.splice(Math.floor(random() * left.length), 1)[0]);
    };
    const damage = () => {
      order().slice(0, 12).forEach((i) => (state[i] = -state[i]));
      show("Twelve neurons were turned over.");
    };
    const recall = () => {
      let changed = 0;
      for (let n = network.sweep(state, order()); n > 0; n = network.sweep(state, order())) changed += n;
      show(`It came to rest after ${changed} changes.`);
    };
    const pictures = LETTERS.map((p, i) => button(`Picture ${i + 1}`, () => { state = [...p]; show("As it was stored."); }));
    box.append(element("div", { class: "cells" }, ...cells),
      element("div", { class: "buttons" }, ...pictures, button("Damage", damage), button("Recall", recall)), said);
    show("As it was stored.");
  };

  const KNOWN = { sigmoids, teaching, memory };
  const fill = () => document.querySelectorAll("[data-live]").forEach((box) => KNOWN[box.dataset.live](box));
  if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", fill);
  else fill();
})();
