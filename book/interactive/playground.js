// The playground: a scene in an editor, and what qrt says of it while it is written.
//
// Pixels are shared by several who paint; another checks the text at every keystroke, another
// reckons the oracle's cost, and another looks at the pixel under the cursor. See
// qrt_lab::playground for what they are asked.

import * as cm from "./codemirror.js";
import { Controls, Readouts, digits, element, grouped, powerOfTwo, shape, whole } from "./parts.js";
import { Interrupted, engines } from "./playground-engine.js";
import { suggestions } from "./playground-complete.js";

// Milliseconds that one call of a painter takes, about, and that a change of the text rests.
const SLICE = 60;
const REST = 120;
const COST_REST = 400;
// Milliseconds between two looks at pixels that the pointer passes.
const POINT = 50;
// What `open` calls the arithmetic.
const MODELS = { real: 0, fixed: 1, both: 2 };
const FIRST_SCENE = "lit-box";

const sleep = (time) => new Promise((resolve) => setTimeout(resolve, time));

/** The levels of sRGB that show a radiance. */
function level(linear) {
  const value = Math.min(Math.max(linear, 0), 1);
  return Math.round(255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055));
}

// A scene in an address: deflated, in letters that addresses may have.
const base64 = (bytes) => btoa(Array.from(bytes, (b) => String.fromCharCode(b)).join(""));
const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());

async function packed(text) {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  return base64(bytes).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

async function unpacked(word) {
  const bytes = Uint8Array.from(atob(word.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
  return new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw")));
}

/** One picture: what it holds, and the canvas that shows it. */
class Picture {
  constructor(words, hint) {
    // An application, so that who hears the page can use the arrow keys, too.
    this.canvas = element("canvas", {
      class: "qrt-pixels", width: 1, height: 1, tabindex: 0, role: "application",
      "aria-roledescription": "picture", "aria-describedby": hint,
    });
    this.mark = element("div", { class: "qrt-mark", hidden: true, "aria-hidden": "true" });
    this.caption = element("div", { class: "qrt-caption" });
    this.box = element("div", {}, element("div", { class: "qrt-under" }, this.canvas, this.mark), this.caption);
    this.exposure = 2;
    this.say(words);
  }

  /** What it is called. */
  say(words) {
    this.caption.textContent = words;
    this.canvas.setAttribute("aria-label", `the picture, ${words}`);
  }

  /** Frames a pixel, if there is one; `kept` says that the pointer does not move the frame. */
  frame(pixel, kept) {
    this.mark.hidden = !pixel;
    if (!pixel) return;
    const { width, height } = this.canvas;
    const share = (part, whole) => `${(100 * part) / whole}%`;
    Object.assign(this.mark.style, { left: share(pixel[0], width), top: share(pixel[1], height), width: share(1, width), height: share(1, height) });
    this.mark.classList.toggle("qrt-kept", kept);
  }

  /** Begins anew; what was there stays to be seen until it is painted over. */
  begin(width, height) {
    if (!this.pixels || this.canvas.width !== width || this.canvas.height !== height) {
      Object.assign(this.canvas, { width, height });
      this.context = this.canvas.getContext("2d");
      this.pixels = this.context.createImageData(width, height);
    }
    this.radiance = new Float64Array(3 * width * height);
  }

  put(pixel, colours, at) {
    for (let c = 0; c < 3; c++) {
      this.radiance[3 * pixel + c] = colours[at + c];
      this.pixels.data[4 * pixel + c] = level(this.exposure * colours[at + c]);
    }
    this.pixels.data[4 * pixel + 3] = 255;
  }

  show() {
    this.context.putImageData(this.pixels, 0, 0);
  }

  expose(exposure) {
    this.exposure = exposure;
    if (!this.radiance) return;
    for (let k = 0; k < this.radiance.length; k++) {
      this.pixels.data[4 * Math.floor(k / 3) + (k % 3)] = level(exposure * this.radiance[k]);
    }
    this.show();
  }
}

/** A drawing of bars: `heights` from 0 to 1, each with words. */
function bars(words, heights, told, ticks = []) {
  const [width, height] = [320, 96];
  const step = width / heights.length;
  const drawing = shape("svg", { viewBox: `0 0 ${width} ${height + 18}`, class: "qrt-bars", role: "img", "aria-label": words });
  heights.forEach((value, place) => {
    const tall = Math.max(value * height, value > 0 ? 1 : 0);
    const bar = shape("rect", { x: place * step + 0.1 * step, y: height - tall, width: 0.8 * step, height: tall });
    bar.append(shape("title", {}, told(place)));
    drawing.append(bar);
  });
  drawing.append(shape("line", { x1: 0, x2: width, y1: height, y2: height }));
  for (const [place, text] of ticks) {
    const anchor = place < 0.2 ? "start" : place > 0.8 ? "end" : "middle";
    drawing.append(shape("text", { x: place * width, y: height + 14, "text-anchor": anchor }, text));
  }
  return drawing;
}

/** The error over queries, on logarithmic axes. */
function curve(points) {
  const [width, height] = [320, 130];
  const drawing = shape("svg", { viewBox: `-46 -8 ${width + 68} ${height + 34}`, class: "qrt-bars", role: "img", "aria-label": "error over queries a pixel, on logarithmic axes" });
  const shown = points.filter(([queries, error]) => queries > 0 && error > 0);
  if (shown.length < 1) return drawing;
  const decades = (values) => [Math.floor(Math.log10(Math.min(...values))), Math.ceil(Math.log10(Math.max(...values)) + 1e-9)];
  const [left, right] = decades(shown.map(([queries]) => queries));
  const [low, high] = decades(shown.map(([, error]) => error));
  const x = (queries) => (width * (Math.log10(queries) - left)) / Math.max(right - left, 1);
  const y = (error) => height - (height * (Math.log10(error) - low)) / Math.max(high - low, 1);
  for (let k = left; k <= right; k++) {
    drawing.append(shape("line", { class: "grid", x1: x(10 ** k), x2: x(10 ** k), y1: 0, y2: height }));
    drawing.append(shape("text", { x: x(10 ** k), y: height + 16, "text-anchor": "middle" }, grouped(10 ** k)));
  }
  for (let k = low; k <= high; k++) {
    drawing.append(shape("line", { class: "grid", x1: 0, x2: width, y1: y(10 ** k), y2: y(10 ** k) }));
    const percent = 10 ** (k + 2);
    drawing.append(shape("text", { x: -4, y: y(10 ** k) + 4, "text-anchor": "end" }, `${percent >= 1 ? percent : digits(percent, 1)} %`));
  }
  drawing.append(shape("polyline", { points: shown.map(([queries, error]) => `${x(queries)},${y(error)}`).join(" ") }));
  for (const [queries, error] of shown) drawing.append(shape("circle", { cx: x(queries), cy: y(error), r: 3 }));
  return drawing;
}

/** The playground's style, before anything is measured. */
function styled() {
  const href = new URL("playground.css", import.meta.url).href;
  if ([...document.styleSheets].some((sheet) => sheet.href === href)) return null;
  const link = element("link", { rel: "stylesheet", href });
  const there = new Promise((resolve, reject) => {
    link.onload = resolve;
    link.onerror = () => reject(new Error("its style is not there"));
  });
  document.head.append(link);
  return there;
}

export async function start(body, figure) {
  await styled();
  const { painters, checker, reckoner, looker } = engines(figure.dataset.engine === "served");
  const schema = fetch(new URL("scene.schema.json", import.meta.url)).then((answer) => answer.json());
  schema.catch(() => {});

  // What is shown.
  const controls = new Controls(body, changed);
  const examples = controls.choice("example", "begin with", []);
  const model = controls.choice("model", "arithmetic", [["real", "real numbers"], ["fixed", "the circuit's integers"], ["both", "both, side by side"]]);
  const estimator = controls.choice("estimator", "estimator", [["", "the scene's"]]);
  const bits = controls.slider("phase_bits", "queries a run, at most", { min: 1, max: 16, value: 8, told: (t) => grouped(2 ** t - 1) });
  const exposure = controls.slider("exposure", "exposure", { min: -4, max: 6, step: 0.5, value: 1, told: (e) => `${e > 0 ? "+" : ""}${e}` });
  const seed = controls.number("seed", "seed", { min: 0, max: 4294967295, value: 0 });
  controls.buttons(["link", "copy a link to this scene", link]);
  const said = element("div", { class: "qrt-said", role: "status" });
  const editor = element("div", { class: "qrt-editor" });
  const problems = element("ol", { class: "qrt-problems", "aria-live": "polite", "aria-label": "what is wrong with the scene" });
  const hint = element("p", { class: "qrt-hint", id: "qrt-hint" }, "Point at a pixel, or choose one with the arrow keys: it is looked at below. A click keeps it; a click on it lets it go.");
  const [exact, beside, counted] = Array.from({ length: 3 }, () => new Picture("", hint.id));
  const pictures = [exact, beside, counted];
  const progress = element("progress", { max: 1, value: 0, "aria-label": "how far the picture is" });
  const left = element("div", { class: "qrt-write" }, editor, problems);
  const right = element("div", { class: "qrt-see" }, element("div", { class: "qrt-pair" }, ...pictures.map(({ box }) => box)), hint, progress);
  body.append(said, element("div", { class: "qrt-desk" }, left, right));
  const readouts = new Readouts(right);
  const chart = element("div", { class: "qrt-chart" });
  const cost = element("section", { class: "qrt-cost", "aria-label": "cost of the oracle" });
  // What is read out of a pixel is what is told of it, not its drawings.
  const pixelTold = element("div", { "aria-live": "polite", "aria-atomic": "true" });
  const pixelDrawn = element("div");
  const pixel = element("section", { class: "qrt-pixel", "aria-label": "the chosen pixel" }, pixelTold, pixelDrawn);
  right.append(chart);
  body.append(element("div", { class: "qrt-desk" }, cost, pixel));

  // What holds: the text that was last valid, and which run is under way.
  let text = "";
  let valid = "";
  let run = 0;
  let film = [0, 0];
  let cursor = null;
  let kept = false;
  let looking = false;
  let loading = false;
  let counting = false;
  name();

  const view = new cm.EditorView({
    parent: editor,
    state: cm.EditorState.create({
      doc: "",
      extensions: [
        cm.lineNumbers(), cm.history(), cm.drawSelection(), cm.bracketMatching(), cm.indentOnInput(),
        cm.lintGutter(), cm.yaml(), cm.EditorState.tabSize.of(2),
        cm.syntaxHighlighting(cm.HighlightStyle.define([
          { tag: cm.tags.comment, class: "qrt-comment" },
          { tag: [cm.tags.propertyName, cm.tags.definition(cm.tags.propertyName)], class: "qrt-key" },
          { tag: [cm.tags.string, cm.tags.content], class: "qrt-text" },
        ])),
        cm.autocompletion({ override: [complete], activateOnTyping: true }),
        cm.keymap.of([...cm.completionKeymap, ...cm.lintKeymap, ...cm.searchKeymap, ...cm.historyKeymap, ...cm.defaultKeymap]),
        cm.EditorView.contentAttributes.of({ "aria-label": "the scene, in YAML", spellcheck: "false", tabindex: "0" }),
        cm.EditorView.updateListener.of((update) => {
          if (update.docChanged) edited();
        }),
      ],
    }),
  });
  // For tests, and for those who look into the page.
  figure.qrtEditor = view;

  async function complete(context) {
    const at = await schema.catch(() => null);
    if (!at) return null;
    const { word, options } = suggestions(context.state.doc.toString(), context.pos, at);
    if (!options.length || (!word && !context.explicit)) return null;
    return { from: context.pos - word.length, options, validFor: /^[\w-]*$/ };
  }

  /** What each picture is called, and whether there are two or three. */
  function name() {
    const both = model.value === "both";
    beside.box.hidden = !both;
    exact.say(both ? "real numbers, exactly" : "all paths, exactly");
    beside.say("the circuit's integers, exactly");
    const how = counting ? "counting ..." : "counted";
    counted.say(both ? `real numbers, ${how}` : how);
  }

  /** Says whether the counted picture is still being made. */
  function count(now) {
    counting = now;
    name();
  }

  function tell(words) {
    said.textContent = words;
  }

  /** What is wrong, under its place and as a list. */
  function underline(answer) {
    const count = answer.problems ?? 0;
    const lists = ["codes", "messages", "labels", "helps"].map((name) => (answer[name] ?? "").split("\n"));
    const severity = answer.valid ? "warning" : "error";
    const length = view.state.doc.length;
    const shown = Array.from({ length: count }, (_, k) => {
      const [code, message, label, help] = lists.map((list) => list[k]);
      const from = Math.min(answer.from[k], length);
      const to = Math.min(Math.max(answer.to[k], from + 1), length);
      return { from, to: Math.max(from, to), severity, code, label, help, line: answer.line[k], column: answer.column[k], what: message };
    });
    view.dispatch(cm.setDiagnostics(view.state, shown.map(({ from, to, severity, code, what, label, help }) => ({
      from, to, severity, source: code, message: [what, label, help && `help: ${help}`].filter(Boolean).join("\n"),
    }))));
    problems.replaceChildren(...shown.map(({ from, code, what, label, help, line, column }) => {
      const place = element("button", { type: "button" }, `${line}:${column}`);
      place.addEventListener("click", () => {
        view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
        view.focus();
      });
      const link = figure.dataset.engine === "served" ? code : element("a", { href: `error-codes.html#${code}` }, code);
      return element("li", { class: severity, "data-code": code }, place, " ", link, ` ${what}`, label ? `: ${label}` : "", help ? element("div", {}, `help: ${help}`) : "");
    }));
  }

  async function edited() {
    text = view.state.doc.toString();
    const asked = performance.now();
    const mine = text;
    figure.dataset.busy = "true";
    const answer = await checker.call("check", [], mine);
    if (mine !== text) return;
    underline(answer);
    performance.measure("qrt-underline", { start: asked, end: performance.now() });
    if (!answer.valid) {
      // A picture that is not finished is begun anew when the text comes back.
      if (run !== figure.qrtDone) {
        run++;
        valid = "";
        count(false);
      }
      progress.hidden = true;
      figure.dataset.state_of_scene = "wrong";
      delete figure.dataset.busy;
      return;
    }
    figure.dataset.state_of_scene = "valid";
    tell(answer.planned ? "This scene asks for an accuracy. The playground shows it with the parameters that it would have without; qrt render plans them." : "");
    if (mine === valid) {
      if (run === figure.qrtDone) delete figure.dataset.busy;
      if (cost.dataset.busy) reckon(mine);
      return;
    }
    const rest = loading ? 0 : REST;
    loading = false;
    await sleep(rest);
    if (mine !== text) return;
    valid = mine;
    kept = false;
    point(null);
    for (const part of [pixelTold, pixelDrawn]) part.replaceChildren();
    paint();
    reckon(mine);
  }

  function changed(input) {
    if (input === examples) return void load(examples.value);
    if (input === exposure) return void pictures.forEach((picture) => picture.expose(2 ** Number(exposure.value)));
    if (input === model) name();
    if (input === seed && cursor) {
      // The same pixel, of other paths.
      point([...cursor]);
      look();
    }
    if (valid) paint(input === estimator || input === bits);
  }

  async function load(name) {
    const { text: found, error } = await checker.call("example", [], name);
    if (error) throw new Error(error);
    replace(found);
  }

  function replace(found) {
    loading = true;
    // What an example says of itself can be scrolled to; the scene is what is shown.
    const begin = Math.max(found.search(/^\w/m), 0);
    const effects = cm.EditorView.scrollIntoView(begin, { y: "start" });
    view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: found }, selection: { anchor: begin }, effects });
    // An editor that was never laid out has no heights to scroll by, and forgets where to: once more.
    const { doc } = view.state;
    requestAnimationFrame(() => requestAnimationFrame(() => {
      if (view.state.doc === doc) view.dispatch({ effects });
    }));
  }

  /** Calls `work(worker, part, first, count)` for all pixels of all painters; false if another run has begun. */
  async function everywhere(mine, sizes, picture, work) {
    Object.assign(total, { sum: 0, squares: 0, queries: 0 });
    let done = 0;
    const whole = sizes.reduce((a, b) => a + b, 0);
    const shares = painters.map(async (painter, part) => {
      let count = 4;
      for (let first = 0; first < sizes[part]; ) {
        const begun = performance.now();
        const now = Math.min(count, sizes[part] - first);
        const answer = await painter.call(...work(first, now));
        if (mine !== run) return false;
        if (answer.error) throw new Error(answer.error);
        taken(part, answer);
        first += answer.count;
        done += answer.count;
        progress.value = done / whole;
        count = Math.max(1, Math.min(4 * count, Math.round((now * SLICE) / Math.max(performance.now() - begun, 1))));
      }
      return true;
    });
    const all = await Promise.all(shares);
    return all.every(Boolean);

    function taken(part, answer) {
      for (let k = 0; k < answer.count; k++) {
        picture.put(part + (answer.first + k) * painters.length, answer.radiance, 3 * k);
      }
      picture.show();
      for (const name of Object.keys(total)) total[name] += answer[name] ?? 0;
    }
  }

  const total = { sum: 0, squares: 0, queries: 0 };
  let sizes = [];
  let apart = [];

  /** The mean of what was gone through last, and how far it is off, as a share of the mean. */
  function off() {
    const values = 3 * film[0] * film[1];
    const mean = total.sum / values;
    return [mean, mean > 0 ? Math.sqrt(total.squares / values) / mean : 0];
  }

  const percent = (share) => `${digits(100 * share, 3)} %`;

  /** What is measured: paths, how far the two arithmetics are apart, and more. */
  function measured(now, ...more) {
    readouts.show([["paths", "paths a pixel", 2 ** now, grouped(2 ** now)], ...apart, ...more]);
  }

  /** The picture from the first path on; or, where all are traced, the counting alone. */
  async function paint(countOnly = false) {
    const traced = figure.dataset.traced === "true" && countOnly;
    const mine = ++run;
    figure.dataset.busy = "true";
    progress.hidden = false;
    count(false);
    try {
      const begun = performance.now();
      const both = model.value === "both";
      if (!traced) {
        delete figure.dataset.traced;
        const opened = await Promise.all(painters.map((painter, part) => painter.call("open", [MODELS[model.value], whole(seed), part, painters.length], valid)));
        if (mine !== run) return;
        const wrong = opened.find(({ error }) => error);
        if (wrong) throw new Error(wrong.error);
        const [{ width, height, path_bits, phase_bits, estimators, estimator: own }] = opened;
        sizes = opened.map(({ pixels }) => pixels);
        film = [width, height];
        figure.dataset.path_bits = path_bits;
        if (estimator.options.length === 1) {
          for (const name of estimators.split("\n")) estimator.append(element("option", { value: name }, name));
        }
        estimator.options[0].textContent = `the scene's: ${own}`;
        if (figure.dataset.opened !== valid) {
          figure.dataset.opened = valid;
          bits.value = phase_bits;
          bits.tell();
        }
        for (const picture of pictures) picture.begin(width, height);
        point(cursor);
        apart = [];
        for (let now = 0; ; now = Math.min(now + 2, path_bits)) {
          const ready = await everywhere(mine, sizes, exact, (first, count) => ["trace", [first, count, now]]);
          if (!ready) return;
          if (both) {
            const too = await everywhere(mine, sizes, beside, (first, count) => ["beside", [first, count, now]]);
            if (!too) return;
            const [, share] = off();
            apart = [["apart", "integers against real numbers (RMSE) over the mean", share, percent(share)]];
          }
          if (now === 0) performance.measure("qrt-first-picture", { start: begun, end: performance.now() });
          measured(now);
          if (now === path_bits) break;
        }
        figure.dataset.traced = "true";
      }
      counted.begin(...film);
      count(true);
      const points = [];
      const most = whole(bits);
      for (let now = Math.min(3, most); now <= most; now++) {
        const ready = await everywhere(mine, sizes, counted, (first, count) => ["estimate", [first, count, now], estimator.value]);
        if (!ready) return;
        const [mean, rmse] = off();
        const queries = total.queries / (film[0] * film[1]);
        points.push([queries, rmse]);
        chart.replaceChildren(curve(points));
        measured(
          Number(figure.dataset.path_bits),
          ["queries", "queries a pixel", queries, grouped(queries)],
          ["rmse", "error of counting (RMSE) over the mean", rmse, percent(rmse)],
          ["mean", "mean radiance", mean, digits(mean, 4)],
        );
      }
    } catch (error) {
      if (mine !== run || error instanceof Interrupted) return;
      tell(error.message);
    }
    count(false);
    progress.hidden = true;
    figure.qrtDone = run;
    delete figure.dataset.busy;
  }

  /** The oracle's cost, when the text rests. */
  async function reckon(mine) {
    reckoner.interrupt();
    cost.dataset.busy = "true";
    await sleep(COST_REST);
    if (mine !== text) return;
    cost.replaceChildren(element("h2", {}, "The oracle"), element("p", {}, "compiling its circuit ..."));
    let answer;
    try {
      answer = await reckoner.call("cost", [], mine);
    } catch (error) {
      if (error instanceof Interrupted) return;
      answer = { error: error.message };
    }
    if (mine !== text) return;
    delete cost.dataset.busy;
    const title = element("h2", {}, "The oracle");
    if (answer.error) return void cost.replaceChildren(title, element("p", {}, answer.error));
    const rows = [
      ["toffoli", "Toffolis of a call", answer.toffoli], ["qubits", "qubits", answer.qubits],
      ["toffoli_depth", "Toffoli depth", answer.toffoli_depth], ["and_measured", "ANDs, if they are undone by measurement", answer.and_measured],
    ];
    const list = new Readouts(cost);
    list.show(rows.map(([name, words, value]) => [name, words, value, grouped(value)]));
    const sums = new Map();
    answer.stages.split("\n").forEach((stage, k) => {
      const words = answer.depths[k] >= 0 ? `${stage}, depth ${answer.depths[k]}` : stage;
      sums.set(words, (sums.get(words) ?? 0) + answer.toffolis[k]);
    });
    const most = Math.max(...sums.values(), 1);
    const table = element("table", { class: "qrt-stages" }, element("caption", {}, `compute, channel ${answer.channel}: Toffolis by stage`));
    for (const [words, value] of sums) {
      if (!value) continue;
      const bar = element("div", { class: "qrt-bar" });
      bar.style.width = `${(100 * value) / most}%`;
      table.append(element("tr", {}, element("th", { scope: "row" }, words), element("td", {}, grouped(value)), element("td", { class: "qrt-room", "aria-hidden": "true" }, bar)));
    }
    const drawing = element("img", { alt: "The oracle's frame: generate ray, find the hit, sample, shade, and the same undone", src: URL.createObjectURL(new Blob([answer.svg], { type: "image/svg+xml" })) });
    const frame = element("details", {}, element("summary", {}, "its drawing"), element("div", { class: "qrt-frame", tabindex: "0", role: "region", "aria-label": "The oracle's frame" }, drawing));
    cost.replaceChildren(title, list.box, table, frame);
  }

  /** Looks at the chosen pixel; those that were passed meanwhile are passed over. */
  async function look() {
    if (looking) return;
    looking = true;
    pixel.dataset.busy = "true";
    try {
      for (let last = null; cursor && last !== cursor; ) {
        last = cursor;
        await paths(...last);
      }
    } finally {
      looking = false;
      delete pixel.dataset.busy;
    }
  }

  /** The paths of a pixel. */
  async function paths(x, y) {
    const mine = valid;
    const title = element("h2", {}, `Pixel ${x}, ${y}`);
    if (!pixelTold.firstChild) {
      pixelTold.append(title);
      pixelDrawn.append(element("p", {}, "tracing its paths ..."));
    }
    let answer;
    try {
      answer = await looker.call("pixel", [x, y, whole(seed), 8], mine);
    } catch (error) {
      if (error instanceof Interrupted) return;
      answer = { error: error.message };
    }
    if (mine !== valid || !cursor) return;
    if (answer.error) {
      pixelTold.replaceChildren(title, element("p", {}, answer.error));
      return void pixelDrawn.replaceChildren();
    }
    const { channel, good, total: ids, mean, histogram, paths, probability, theta, phase_bits } = answer;
    const name = ["red", "green", "blue"][channel];
    const list = new Readouts(pixelTold);
    // What is around it is read out as a whole.
    list.box.setAttribute("aria-live", "off");
    list.show([
      ["mean", "radiance", Array.from(mean).join(" "), Array.from(mean, (v) => digits(v, 3)).join(", ")],
      ["good", `good indices, ${name}`, good[channel], `${grouped(good[channel])} of ${grouped(ids)}`],
      ["amplitude", "amplitude a = S/N", good[channel] / ids, digits(good[channel] / ids, 4)],
      ["theta", "angle", theta, digits(theta, 4)],
    ]);
    const dark = histogram.length - 1;
    const tall = Math.max(...histogram);
    const share = (k) => (k === dark ? "black" : `from ${powerOfTwo(-k - 1).replace("-", "⁻")} to ${powerOfTwo(-k).replace("-", "⁻")} of the scale`);
    const paths_of = bars("paths by brightness", Array.from(histogram, (n) => n / tall), (k) => `${share(k)}: ${grouped(histogram[k])} of ${grouped(paths)} paths`, [[0, "brightest"], [1, "black"]]);
    const likely = Math.max(...probability);
    const outcomes = bars("outcomes of the phase register", Array.from(probability, (p) => p / likely), (y) => `outcome ${y}: ${digits(probability[y], 3)}`, [[0, "0"], [1, `outcome ${probability.length - 1}`]]);
    const brightest = answer.brightest ? answer.brightest.split("\n") : [];
    const table = element("table", { class: "qrt-paths" }, element("caption", {}, "its brightest paths"), element("tr", {}, ...["index", "meets", "radiance"].map((head) => element("th", { scope: "col" }, head))));
    for (const line of brightest) {
      const [id, ...rest] = line.split(": ");
      const radiance = rest.pop();
      table.append(element("tr", {}, ...[id, rest.join(": "), radiance].map((cell) => element("td", {}, cell))));
    }
    pixelTold.replaceChildren(title, list.box);
    pixelDrawn.replaceChildren(
      element("div", { class: "qrt-caption" }, `${grouped(paths)} paths by brightness: each bar half as bright as the one before`), paths_of,
      element("div", { class: "qrt-caption" }, `what a phase register of ${phase_bits} bits shows of ${name}, sine window`), outcomes,
      brightest.length ? table : element("p", {}, "No path carries light."),
    );
  }

  /** Points at pixels, by mouse and by arrows. */
  for (const { canvas } of pictures) {
    const under = ({ clientX, clientY }) => {
      const { left, top, width, height } = canvas.getBoundingClientRect();
      choose(((clientX - left) * film[0]) / width, ((clientY - top) * film[1]) / height);
    };
    // A finger that moves scrolls the page; it chooses by touching.
    let passing = null;
    canvas.addEventListener("pointermove", (event) => {
      if (event.pointerType === "touch") return;
      if (!passing) {
        setTimeout(() => {
          if (!kept && passing) under(passing);
          passing = null;
        }, POINT);
      }
      passing = event;
    });
    canvas.addEventListener("click", (event) => {
      const before = cursor;
      under(event);
      keep(!(kept && cursor === before));
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.key === "Escape") keep(false);
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1], Enter: [0, 0] }[event.key];
      if (!step) return;
      event.preventDefault();
      const [x, y] = cursor ?? [film[0] >> 1, film[1] >> 1];
      choose(x + step[0], y + step[1]);
      // Chosen by keyboard, it is not lost to a mouse that is nudged.
      keep(true);
    });
  }

  function choose(x, y) {
    // There are no pixels before the picture of this text is begun.
    if (figure.dataset.opened !== valid || !valid) return;
    const inside = (value, size) => Math.min(Math.max(Math.floor(value), 0), size - 1);
    const [column, row] = [inside(x, film[0]), inside(y, film[1])];
    const same = cursor?.[0] === column && cursor[1] === row;
    point(same ? cursor : [column, row]);
    if (!same) look();
  }

  /** Whether the pointer no longer moves the choice. */
  function keep(yes) {
    kept = yes && cursor !== null;
    point(cursor);
  }

  /** Frames the chosen pixel in every picture. */
  function point(chosen) {
    cursor = chosen;
    for (const picture of pictures) picture.frame(cursor, kept);
  }

  async function link() {
    const address = new URL(location.href);
    address.hash = `scene=${await packed(text)}`;
    history.replaceState(null, "", address);
    try {
      await navigator.clipboard.writeText(address.href);
      tell("The address of this page now carries the scene; it is copied.");
    } catch {
      tell("The address of this page now carries the scene.");
    }
  }

  const { names, error } = await checker.call("examples");
  if (error) throw new Error(error);
  const given = await figure.dataset.scene;
  if (given) examples.append(element("option", { value: "" }, "your scene"));
  for (const name of names.split("\n")) examples.append(element("option", { value: name }, name));
  const [kind, word] = decodeURIComponent(location.hash.slice(1)).split("=");
  if (kind === "scene" && word) {
    const found = await unpacked(word).catch(() => null);
    if (found === null) tell("The address carries a scene that cannot be read; this is an example.");
    else return void replace(found);
  }
  if (given) return void replace(given);
  const first = kind === "example" && names.split("\n").includes(word) ? word : FIRST_SCENE;
  examples.value = first;
  await load(first);
}
