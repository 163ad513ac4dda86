// Elements, sliders and curves for the live plots.
"use strict";

const handeyeDrawing = (() => {
  const SVG = "http://www.w3.org/2000/svg";

  const element = (name, attributes = {}, ...children) => {
    const drawn = ["svg", "path", "line", "text", "circle", "g"].includes(name);
    const made = drawn ? document.createElementNS(SVG, name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
      else made.setAttribute(key, value);
    }
    made.append(...children);
    return made;
  };

  const button = (label, onclick) => element("button", { type: "button", class: "md-button", onclick }, label);

  // A slider with its name and value; whenChanged gets the value.
  const slider = (label, { least, most, step, value, unit = "" }, whenChanged) => {
    const shown = element("output", {}, `${value}${unit}`);
    const input = element("input", { type: "range", min: least, max: most, step, value });
    const set = (v) => {
      input.value = v;
      shown.textContent = `${Number(input.value).toFixed(2)}${unit}`;
    };
    set(value);
    input.addEventListener("input", () => {
      set(input.value);
      whenChanged(Number(input.value));
    });
    return { set, value: () => Number(input.value), row: element("label", {}, element("span", {}, label), input, shown) };
  };

  // Axes over x and y; to(x, y) are places in the picture, from(event) those in the data.
  const axes = (box, { x, y, xTicks, yTicks, xLabel, yLabel, title }) => {
    const [width, height, left, bottom, top, right] = [640, 300, 46, 42, 22, 12];
    const toX = (v) => left + ((v - x[0]) / (x[1] - x[0])) * (width - left - right);
    const toY = (v) => height - bottom - ((v - y[0]) / (y[1] - y[0])) * (height - top - bottom);
    const svg = element("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
    for (const v of yTicks) {
      svg.append(
        element("line", { class: "grid", x1: left, x2: width - right, y1: toY(v), y2: toY(v) }),
        element("text", { x: left - 8, y: toY(v) + 4, "text-anchor": "end" }, `${v}`.replace("-", "−")),
      );
    }
    for (const [v, name] of xTicks) {
      svg.append(
        element("line", { class: "grid", x1: toX(v), x2: toX(v), y1: top, y2: height - bottom }),
        element("text", { x: toX(v), y: height - bottom + 16, "text-anchor": "middle" }, name),
      );
    }
    svg.append(
      element("text", { x: (left + width - right) / 2, y: height - 6, "text-anchor": "middle" }, xLabel),
      element("text", { x: left, y: 13 }, yLabel),
    );
    box.append(svg);
    const curve = (name) => svg.appendChild(element("path", { class: name }));
    const draw = (path, f) => {
      const n = 480;
      const at = (i) => x[0] + (i / n) * (x[1] - x[0]);
      const clipped = (v) => Math.min(Math.max(v, y[0] - 1), y[1] + 1);
      const points = Array.from({ length: n + 1 }, (_, i) => `${toX(at(i)).toFixed(1)},${toY(clipped(f(at(i)))).toFixed(1)}`);
      path.setAttribute("d", `M${points.join("L")}`);
    };
    const from = (event) => {
      const place = svg.getBoundingClientRect();
      const scale = width / place.width;
      const u = ((event.clientX - place.left) * scale - left) / (width - left - right);
      const v = (height - bottom - (event.clientY - place.top) * scale) / (height - top - bottom);
      return [x[0] + u * (x[1] - x[0]), y[0] + v * (y[1] - y[0])];
    };
    return { svg, curve, draw, from, toX, toY };
  };

  return { element, button, slider, axes };
})();
