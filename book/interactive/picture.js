// A small picture that sharpens as queries are spent.

import { Controls, Readouts, digits, element, grouped, whole } from "./parts.js";

// Milliseconds of work between two looks at what the reader does.
const SLICE = 12;

const WORDS = {
  "monte-carlo": "Monte Carlo (classical)",
  paper: "the paper's counting",
  sine: "counting, sine window",
  "adaptive-bayes": "adaptive Bayes",
};

/** A turn for the page. */
const pause = () => new Promise((resolve) => {
  const { port1, port2 } = new MessageChannel();
  port1.onmessage = resolve;
  port2.postMessage(null);
});

export function start(body, qrt, figure) {
  const about = qrt("picture");
  if (about.error) throw new Error(about.error);
  const { width, height } = about;
  const pixels = width * height;
  // Which run is under way: a later one ends it.
  let current = 0;
  let traced = 0;

  const controls = new Controls(body, update);
  const estimator = controls.choice("estimator", "estimator", about.estimators.split("\n").map((name) => [name, WORDS[name] ?? name]));
  estimator.value = "adaptive-bayes";
  const bits = controls.slider("phase_bits", "queries a channel, at most", {
    min: 1, max: about.most_phase_bits, value: 7, told: (t) => grouped(2 ** t - 1),
  });
  const seed = controls.number("seed", "seed", { min: 0, max: 4294967295, value: 0 });

  const [left, right] = ["estimated", "all paths, exactly"].map((words) => {
    const canvas = element("canvas", { class: "qrt-pixels", width, height, role: "img", "aria-label": `the picture, ${words}` });
    return { canvas, figure: element("div", {}, canvas, element("div", { class: "qrt-caption" }, words)) };
  });
  body.append(element("div", { class: "qrt-pair" }, left.figure, right.figure));
  const progress = element("progress", { max: pixels, value: 0, "aria-label": "pixels done" });
  body.append(progress);
  const readouts = new Readouts(body);

  /** Shows levels of sRGB from a pixel on. */
  function paint(canvas, first, levels) {
    const context = canvas.getContext("2d");
    for (let k = 0; k * 3 < levels.length; k++) {
      const [r, g, b] = levels.slice(3 * k, 3 * k + 3);
      context.fillStyle = `rgb(${r} ${g} ${b})`;
      context.fillRect((first + k) % width, Math.floor((first + k) / width), 1, 1);
    }
  }

  /** Calls `work(first, count)` for all pixels, a few at a time; false if another run has begun. */
  async function inSlices(run, from, work) {
    let count = 1;
    let first = from;
    while (first < pixels) {
      const begun = performance.now();
      const now = Math.min(count, pixels - first);
      work(first, now);
      first += now;
      progress.value = first;
      const spent = Math.max(performance.now() - begun, 0.1);
      count = Math.min(Math.max(1, Math.floor((now * SLICE) / spent)), 2 * count);
      await pause();
      if (run !== current) return false;
    }
    return true;
  }

  async function update() {
    const run = ++current;
    figure.dataset.busy = "true";
    progress.hidden = false;
    await pause();
    if (run !== current) return;
    const ready = await inSlices(run, traced, (_, count) => {
      const answer = qrt("picture_trace", [count]);
      traced = answer.traced;
      paint(right.canvas, answer.first, answer.levels);
    });
    if (!ready) return;
    const name = estimator.value;
    const done = await inSlices(run, 0, (first, count) => {
      const answer = qrt("picture_estimate", [whole(bits), whole(seed), first, count], name);
      paint(left.canvas, answer.first, answer.levels);
    });
    if (!done) return;
    const { rmse, queries, mean, estimated, exact } = qrt("picture_summary");
    progress.hidden = true;
    readouts.show([
      ["rmse", "error (RMSE) over the mean", rmse, `${digits(100 * rmse, 3)} %`],
      ["queries", "queries a pixel", queries, grouped(queries)],
      ["mean", "mean radiance", mean, digits(mean, 4)],
      ["paths", "paths a pixel", about.paths, grouped(about.paths)],
    ]);
    figure.dataset.estimated = Array.from(estimated).join(" ");
    figure.dataset.exact = Array.from(exact).join(" ");
    delete figure.dataset.busy;
  }

  update();
}
