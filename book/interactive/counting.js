// What the counting register reads, draws from it, and the posterior that they leave.

import { Controls, Readouts, digits, element, grouped, powerOfTwo, shape, whenResized, whole } from "./parts.js";

const HEIGHT = 132;
const LEFT = 44;
const RIGHT = 10;
// The least probability that logarithmic heights show.
const LEAST = 1e-8;

export function start(body, qrt, figure) {
  const angles = qrt("counting_angles").angles;
  let answer;

  const controls = new Controls(body, update);
  const theta = controls.slider("theta", "angle θ, in turns", {
    min: 0, max: 0.5, step: 0.0005, value: 0.3335, told: (value) => value.toFixed(4),
  });
  const bits = controls.slider("phase_bits", "phases T", {
    min: 1, max: 10, value: 6, told: (t) => `${powerOfTwo(t)} = ${grouped(2 ** t)}`,
  });
  const runs = controls.slider("runs", "runs B", { min: 1, max: 64, value: 3 });
  const taper = controls.choice("window", "window", [["rect", "rectangular"], ["sine", "sine"]]);
  const seed = controls.number("seed", "seed", { min: 0, max: 4294967295, value: 1 });
  const logarithmic = controls.check("logarithmic", "logarithmic heights");

  const drawing = element("div", { class: "qrt-drawing" });
  body.append(drawing);
  const readouts = new Readouts(body);

  function update() {
    const sine = taper.value === "sine" ? 1 : 0;
    answer = qrt("counting", [Number(theta.value), whole(bits), whole(runs), sine, whole(seed)]);
    figure.dataset.probability = Array.from(answer.probability).join(" ");
    figure.dataset.drawn = Array.from(answer.drawn).join(" ");
    draw(Math.floor(drawing.clientWidth));
    readouts.show([
      ["theta", "θ", answer.theta, digits(answer.theta, 6)],
      ["good", `good path indices S, of ${grouped(answer.total)}:`, answer.good, grouped(answer.good)],
      ["amplitude", "amplitude", answer.amplitude, digits(answer.amplitude, 6)],
      ["likeliest", "likeliest S", answer.likeliest, grouped(answer.likeliest)],
      ["estimate", "estimate", answer.estimate, digits(answer.estimate, 6)],
      ["error", "off by", answer.estimate - answer.amplitude, digits(answer.estimate - answer.amplitude, 3)],
      ["interval", "95 % interval", `${answer.low} ${answer.high}`, `${digits(answer.low, 4)} to ${digits(answer.high, 4)}`],
      ["mean", "posterior's mean S", answer.mean, digits(answer.mean, 6)],
      ["queries", "queries", answer.queries, grouped(answer.queries)],
    ]);
  }

  function draw(width) {
    if (!answer || width <= 0) return;
    const x = (turns) => LEFT + (turns / 0.5) * (width - LEFT - RIGHT);
    drawing.replaceChildren(distribution(x, width), posterior(x, width));
  }

  /** A place in [0, 1] for a share of the tallest. */
  function height(share) {
    if (!logarithmic.checked) return share;
    return share > LEAST ? 1 - Math.log10(share) / Math.log10(LEAST) : 0;
  }

  function frame(width, title, ticks, below) {
    const top = 26;
    const floor = top + HEIGHT;
    const svg = shape("svg", {
      width, height: floor + below, viewBox: `0 0 ${width} ${floor + below}`, role: "img", "aria-label": title,
    });
    svg.append(shape("text", { x: LEFT, y: 12, class: "qrt-title" }, title));
    for (const [share, words] of ticks) {
      const y = floor - share * HEIGHT;
      svg.append(shape("line", { x1: LEFT, x2: width - RIGHT, y1: y, y2: y, class: "qrt-grid" }));
      svg.append(shape("text", { x: LEFT - 5, y: y + 4, class: "qrt-tick", "text-anchor": "end" }, words));
    }
    return { svg, floor };
  }

  /** Heights that are named: of the tallest `most`. */
  function ticks(most) {
    if (!logarithmic.checked) return [0, 0.5, 1].map((share) => [share, digits(share * most, 2)]);
    return [1, 1e-2, 1e-4, 1e-6, 1e-8].map((share) => [height(share), (share * most).toExponential(0)]);
  }

  function axis(svg, x, y) {
    for (const [turns, words] of [[0, "0"], [0.125, "1/8"], [0.25, "1/4"], [0.375, "3/8"], [0.5, "1/2"]]) {
      svg.append(shape("text", { x: x(turns), y, class: "qrt-tick", "text-anchor": turns === 0.5 ? "end" : "middle" }, words));
    }
  }

  function distribution(x, width) {
    const { probability, drawn, size } = answer;
    const most = Math.max(...probability);
    const title = "P(y | θ) over y/T; dashed: θ; dots: drawn";
    const { svg, floor } = frame(width, title, ticks(most), 44);
    const bar = Math.max(1, Math.min(12, 0.7 * (x(1 / size) - x(0))));
    let bars = "";
    probability.forEach((p, y) => {
      const tall = height(p / most) * HEIGHT;
      if (tall >= 0.25) bars += `M${(x(y / size) - bar / 2).toFixed(2)} ${floor}v${-tall.toFixed(2)}h${bar.toFixed(2)}V${floor}z`;
    });
    svg.append(shape("path", { d: bars, class: "qrt-bars" }));
    svg.append(shape("line", { x1: x(answer.theta), x2: x(answer.theta), y1: floor - HEIGHT, y2: floor, class: "qrt-truth" }));
    drawn.forEach((count, y) => {
      if (count > 0) {
        const r = Math.min(3 + 1.2 * Math.sqrt(count - 1), 9);
        const dot = shape("circle", { cx: x(y / size), cy: floor + 12, r, class: "qrt-drawn" });
        dot.append(shape("title", {}, `y = ${y}: ${count}`));
        svg.append(dot);
      }
    });
    axis(svg, x, floor + 38);
    return svg;
  }

  function posterior(x, width) {
    const most = Math.max(...answer.posterior);
    const { svg, floor } = frame(width, "posterior of S, over its angle; ▾: maximum", ticks(most), 24);
    // The tallest of what falls onto each third of a pixel: no peak is lost.
    const columns = new Map();
    answer.posterior.forEach((p, good) => {
      const column = Math.round(3 * x(angles[good]));
      columns.set(column, Math.max(columns.get(column) ?? 0, p));
    });
    let line = `M${x(0)} ${floor}`;
    for (const [column, p] of columns) line += `L${(column / 3).toFixed(2)} ${(floor - height(p / most) * HEIGHT).toFixed(2)}`;
    svg.append(shape("path", { d: `${line}L${x(0.5)} ${floor}z`, class: "qrt-area" }));
    const at = x(answer.likeliest_theta);
    svg.append(shape("line", { x1: x(answer.theta), x2: x(answer.theta), y1: floor - HEIGHT, y2: floor, class: "qrt-truth" }));
    svg.append(shape("path", { d: `M${at} ${floor - HEIGHT}l-5 -8h10z`, class: "qrt-drawn" }));
    axis(svg, x, floor + 16);
    return svg;
  }

  update();
  whenResized(drawing, draw);
}
