// The interactive figures, and those that scripts move without a server.
//
// A figure fails if a control cannot be reached or moved by keyboard, if it is not there within a
// second, if its words cannot be read in a theme, if axe finds a violation, or if its numbers are not
// those of the command `qrt`.

import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { FORMS, WIDE, screenshot, shut, tab, until, visit } from "./browser.mjs";
import { barriers, misfits } from "./pages.mjs";
import { SCREENSHOTS, check, checkAll, fail, folder, inTime, qrt } from "./report.mjs";

/** Milliseconds until a figure can be used. */
const SOON = 1000;
/** Milliseconds for which the picture may keep its page busy at a stretch. */
const BUSY = 500;
/** Contrast that text must have: WCAG 2, level AA. */
const CONTRAST = 4.5;

/** A figure of the page that is open. */
class Figure {
  constructor(page, name, where) {
    Object.assign(this, { page, name, where });
    this.selector = `figure.qrt-interactive[data-figure="${name}"]`;
  }

  /** What the figure says: readouts by name, and its data. */
  read() {
    return this.page.evaluate((selector) => {
      const figure = document.querySelector(selector);
      const told = {};
      for (const span of figure.querySelectorAll("[data-name]")) told[span.dataset.name] = span.dataset.value;
      const controls = {};
      for (const input of figure.querySelectorAll("[name]")) controls[input.name] = input.type === "checkbox" ? input.checked : input.value;
      return { ...figure.dataset, told, controls, error: figure.querySelector(".qrt-wrong:not([hidden])")?.textContent ?? null };
    }, this.selector);
  }

  idle() {
    return until(this.page, (s) => document.querySelector(s).dataset.state === "ready" && !document.querySelector(s).dataset.busy, [this.selector], 120_000);
  }

  /** Puts a control to a value, as the reader's hand would, at once. */
  async set(name, value) {
    await this.page.evaluate((selector, name, value) => {
      const input = document.querySelector(`${selector} [name="${name}"]`);
      if (input.type === "checkbox") input.checked = value;
      else input.value = value;
      input.dispatchEvent(new Event("input", { bubbles: true }));
    }, this.selector, name, value);
    await this.idle();
  }

  /** Moves every control by keyboard, from one to the next by Tab. */
  async byKeyboard() {
    const { page, selector, where } = this;
    const names = await page.evaluate((selector) => {
      const all = [...document.querySelectorAll(`${selector} [name]`)].filter((input) => input.offsetParent);
      all[0].focus();
      return all.map((input) => [input.name, input.tagName === "BUTTON" ? "button" : input.type]);
    }, selector);
    const state = () => page.evaluate((selector) => {
      const figure = document.querySelector(selector);
      const active = document.activeElement;
      const drawn = [...figure.querySelectorAll("canvas")].map((canvas) => canvas.toDataURL()).join();
      return {
        name: figure.contains(active) ? active.name : null,
        value: active.type === "checkbox" ? String(active.checked) : active.value,
        outline: getComputedStyle(active).outlineStyle,
        label: (active.labels?.[0]?.querySelector(".qrt-label") ?? active).textContent,
        shown: figure.querySelector(".qrt-body").innerHTML + drawn,
      };
    }, selector);
    for (const [place, [name, type]] of names.entries()) {
      if (place > 0) await page.keyboard.press("Tab");
      const before = await state();
      if (before.name !== name) {
        fail(where, `Tab leads to ${before.name}, not to ${name}`);
        return;
      }
      if (!before.label.trim()) fail(where, `${name} has no label`);
      const keys = { range: ["ArrowRight"], "select-one": ["ArrowDown"], number: ["ArrowUp"], checkbox: [" "], text: ["End", " "], button: ["Enter"] }[type];
      // A button at the end of its way has nothing to do: forward comes before back.
      for (const key of keys) await page.keyboard.press(key);
      let after = await state();
      if (after.value === before.value && ["range", "select-one"].includes(type)) {
        await page.keyboard.press(type === "range" ? "ArrowLeft" : "ArrowUp");
        after = await state();
      }
      if (type !== "button" && after.value === before.value) fail(where, `${name} does not move by keyboard`);
      if (after.outline === "none") fail(where, `${name} does not show that it has the focus`);
      await this.idle();
      if (type !== "text" && name !== "back") {
        const changed = (await state()).shown !== before.shown;
        if (!changed) fail(where, `nothing changes with ${name}`);
      }
    }
  }

  /** Scrolls to the figure and waits until it can be used; false if it stays a still picture. */
  async starts() {
    const { page, selector, name, where } = this;
    await page.evaluate((selector) => document.querySelector(selector).scrollIntoView({ block: "center" }), selector);
    await until(page, (s) => ["ready", "static"].includes(document.querySelector(s).dataset.state), [selector]);
    if ((await this.read()).state !== "ready") {
      fail(where, await page.evaluate((s) => document.querySelector(s).textContent.trim(), selector));
      return false;
    }
    const { ready, took } = await page.evaluate((name) => {
      const measure = performance.getEntriesByName(`qrt-figure:${name}`)[0];
      return { ready: measure.startTime + measure.duration, took: measure.duration };
    }, name);
    await this.idle();
    // Tasks from the figure's first moment on; those before are the page's own.
    const busy = await page.evaluate((from) => Math.max(0, ...window.qrtLong.filter((task) => task.startTime >= from).map((task) => task.duration)), ready - took);
    console.log(`${where}: there after ${took.toFixed(0)} ms, ${ready.toFixed(0)} ms after the page was asked for; longest task ${busy.toFixed(0)} ms`);
    inTime(where, "loading", took, SOON);
    if (name === "picture") inTime(where, "the longest task", busy, BUSY);
    return true;
  }

  /** Tries the figure: its contrast and its layout; if `thoroughly`, its controls by keyboard, and its numbers. */
  async tried(thoroughly) {
    const { page, selector, name, where } = this;
    if (SCREENSHOTS) await screenshot(page, selector, join(SCREENSHOTS, `${where.replaceAll(/[^\w.-]+/g, "-")}.png`));
    for (const text of await faint(page, selector)) fail(where, text);
    if (thoroughly) {
      await this.byKeyboard();
      await NUMBERS[name]?.(this);
    }
    for (const misfit of await misfits(page)) fail(where, misfit);
  }
}

/** Text below `selector` that is hard to read, in the theme that is on. Unlike axe, it reads drawings, too. */
export function faint(page, selector) {
  return page.evaluate((selector, least) => {
    const channels = (colour) => colour.match(/[\d.]+/g).map(Number);
    const light = (colour) => {
      const [r, g, b] = channels(colour).map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const over = (top, below) => {
      const [r, g, b, a = 1] = channels(top);
      const under = channels(below);
      return `rgb(${[r, g, b].map((c, k) => c * a + under[k] * (1 - a)).join(",")})`;
    };
    const ground = (element) => {
      const colours = [];
      for (let at = element; at; at = at.parentElement) colours.push(getComputedStyle(at).backgroundColor);
      return colours.reverse().reduce((below, top) => over(top, below), "rgb(255,255,255)");
    };
    const found = new Set();
    for (const element of document.querySelectorAll(`${selector} *`)) {
      const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
      if (!own || !element.getClientRects().length) continue;
      const style = getComputedStyle(element);
      const [text, back] = [light(over("ownerSVGElement" in element ? style.fill : style.color, ground(element))), light(ground(element))];
      const contrast = (Math.max(text, back) + 0.05) / (Math.min(text, back) + 0.05);
      if (contrast < least) found.add(`"${element.textContent.trim().slice(0, 30)}" has a contrast of ${contrast.toFixed(1)}`);
    }
    return [...found];
  }, selector, CONTRAST);
}

/** What each figure's numbers are held against. */
const NUMBERS = {
  async counting(figure) {
    for (const [theta, bits, runs, window, seed] of [
      [0.3335, 6, 3, "rect", 1], [0.25, 5, 1, "rect", 2], [0.1, 10, 64, "sine", 3], [0, 1, 5, "rect", 4], [0.5, 8, 7, "sine", 5],
    ]) {
      for (const [name, value] of Object.entries({ theta, phase_bits: bits, runs, window, seed })) await figure.set(name, value);
      const { told, probability, drawn } = await figure.read();
      const answer = JSON.parse(qrt("count", "--good", told.good, "--total", "4096", "--phase-bits", String(bits),
        "--window", window, "--shots", String(runs), "--seed", String(seed), "--json"));
      const where = `${figure.where}, ${[theta, bits, runs, window, seed]}`;
      check(where, "theta", told.theta, answer.theta, 1e-15);
      check(where, "likeliest S", told.likeliest, answer.estimate.good);
      check(where, "estimate", told.estimate, answer.estimate.amplitude, 1e-15);
      const interval = told.interval.split(" ").map(Number);
      check(where, "the interval's lower end", interval[0], answer.estimate.interval[0], 1e-13);
      check(where, "the interval's upper end", interval[1], answer.estimate.interval[1], 1e-13);
      check(where, "queries", told.queries, answer.estimate.queries);
      check(where, "the posterior's mean", told.mean, answer.posterior.mean, 1e-10);
      const [shown, draws] = [probability, drawn].map((list) => list.split(" ").map(Number));
      checkAll(where, "probabilities", shown, answer.outcomes.map(({ probability }) => probability), 1e-14);
      const counts = new Map(answer.draws.map(({ y, count }) => [y, count]));
      checkAll(where, "draws", draws, answer.outcomes.map(({ y }) => counts.get(y) ?? 0));
    }
  },

  async map(figure) {
    const { where } = figure;
    // A change of variables multiplies by J: the projected hemisphere has the area pi.
    for (const [map, divided] of [["0", 1 / (4 * Math.PI)], ["1", 1 / (2 * Math.PI)], ["2", 1 / (4 * Math.PI)]]) {
      await figure.set("map", map);
      await figure.set("bits", 5);
      const { told, error } = await figure.read();
      if (error) fail(where, error);
      check(where, "the integral", told.multiplied, Math.PI, 1e-12);
      check(where, "what division gives", told.divided, divided, 1e-12);
      check(where, "points", told.points, 1024);
    }
    // What is wrong with a map of one's own, in the words that the command has for it.
    const own = ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*w)", "sqrt(1-u)"];
    for (const [k, name] of ["x", "y", "z"].entries()) await figure.set(name, own[k]);
    const said = await until(figure.page, (s) => document.querySelector(`${s} .qrt-wrong:not([hidden])`)?.textContent, [figure.selector])
      .then((text) => text.jsonValue());
    let expected = "";
    try {
      const bsdf = `{ bsdf: { map: [${own.map((text) => `"${text}"`)}], value: ["0"] } }`;
      qrt("inspect", "scenes-yaml/velvet.yaml", "--set", `materials.velvet=${bsdf}`);
    } catch (error) {
      expected = error.stderr;
    }
    const words = (text) => text.match(/^error\[.*$|help: .*$/gm)?.slice(0, 2).join("\n");
    if (!expected.includes("QRT0401") || words(said) !== words(expected)) {
      fail(where, `says\n${said}\nwhere the command says\n${expected}`);
    }
    await figure.set("map", "0");
  },

  async circuit(figure) {
    const { where, page } = figure;
    const inspected = JSON.parse(qrt("inspect", "book/widgets/scenes/lamp.yaml", "--set", "comparator.bits=3", "--json"));
    const { qubits, toffolis, good } = await figure.read();
    check(where, "qubits", qubits, inspected.qubits.peak);
    check(where, "Toffolis", toffolis, inspected.gates.toffoli);
    const shown = await page.evaluate((s) => [...document.querySelectorAll(`${s} [data-register]`)].map((row) => row.dataset.register).sort(), figure.selector);
    const registers = new Set(inspected.registers.map(({ name }) => name));
    for (const name of registers) if (!shown.includes(name)) fail(where, `the register ${name} is missing`);
    // The good ids, all of them, against those of the picture that the circuit makes.
    const scratch = mkdtempSync(join(tmpdir(), "qrt-book-"));
    const counts = join(scratch, "counts.csv");
    qrt("render", "book/widgets/scenes/lamp.yaml", "--model", "gates", "--estimator", "exact", "-o", join(scratch, "a.png"), "--counts", counts);
    const [red] = readFileSync(counts, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
    rmSync(scratch, { recursive: true });
    const last = Number((await page.evaluate((s) => document.querySelector(`${s} [name=step]`).max, figure.selector)));
    await figure.set("step", last);
    const { told } = await figure.read();
    check(where, "turned signs", told.flipped, Number(red[4]));
    check(where, "qubits in use at the end", told.held, 0);
    check(where, "qubits that are zero at the end", told.unowned_are_zero, 1);
    await figure.set("step", 0);
    check(where, "turned signs after going back", (await figure.read()).told.flipped, 0);
  },

  async picture(figure) {
    const { where } = figure;
    const scratch = mkdtempSync(join(tmpdir(), "qrt-book-"));
    const sets = ["film={ width: 24, height: 24 }", "sampling.path_bits=10", "counting.repetitions=1"];
    await figure.set("seed", 0);
    for (const [estimator, bits] of [["monte-carlo", 4], ["paper", 8], ["sine", 6], ["adaptive-bayes", 5]]) {
      await figure.set("estimator", estimator);
      await figure.set("phase_bits", bits);
      const found = await figure.read();
      const counts = join(scratch, "counts.csv");
      const all = [...sets, `counting.phase_bits=${bits}`].flatMap((set) => ["--set", set]);
      qrt("render", "scenes-yaml/cornell-box.yaml", "-o", join(scratch, "a.png"), "--estimator", estimator, "--counts", counts, ...all);
      const expected = readFileSync(counts, "utf8").trim().split("\n").slice(1).map((line) => Number(line.split(",")[3]));
      const shown = found.estimated.split(" ").map(Number);
      const exact = found.exact.split(" ").map(Number);
      checkAll(`${where}, ${estimator}`, "values", shown, expected, 1e-12);
      const mean = exact.reduce((a, b) => a + b) / exact.length;
      const squares = expected.reduce((sum, value, k) => sum + (value - exact[k]) ** 2, 0);
      check(`${where}, ${estimator}`, "RMSE", found.told.rmse, Math.sqrt(squares / exact.length) / mean, 1e-9);
    }
    rmSync(scratch, { recursive: true });
  },
};

/** Tries all figures of the page `name`, light and dark, wide and narrow. */
export async function figures(browser, address, name) {
  for (const [theme, size] of FORMS) {
    const page = await tab(browser, size, theme);
    await page.evaluateOnNewDocument(() => {
      window.qrtLong = [];
      new PerformanceObserver((list) => window.qrtLong.push(...list.getEntries())).observe({ type: "longtask" });
    });
    await visit(page, `${address}/${name}`);
    const place = `${theme} at ${size.width}`;
    const kinds = await page.evaluate(() => [...document.querySelectorAll("figure.qrt-interactive[data-figure]:not([data-figure=playground])")].map((f) => f.dataset.figure));
    for (const kind of kinds) {
      const figure = new Figure(page, kind, `${name}, ${kind}, ${place}`);
      if (await figure.starts()) await figure.tried(size === WIDE);
    }
    for (const barrier of await barriers(page)) fail(`${name}, figures, ${place}`, barrier);
    for (const fault of page.faults) fail(`${name}, ${place}`, fault);
    await shut(page);
  }
}

/** The figures that need no server's WebAssembly: moved by keyboard, and held against the still pictures' own words. */
export async function stills(browser, address) {
  const page = await tab(browser, WIDE);
  await page.emulateMediaFeatures([{ name: "prefers-reduced-motion", value: "reduce" }]);
  const read = (name) => readFileSync(join(folder, "figures", name), "utf8");
  const slide = (name, place, value) => page.evaluate((name, place, value) => {
    const input = document.querySelectorAll(`figure.qrt-still[data-still=${name}] input`)[place];
    input.value = value;
    input.dispatchEvent(new Event("input"));
  }, name, place, value);
  await visit(page, `${address}/grover.html`);
  // What a state vector finds after 0, 1, 2, 3 iterates.
  const known = read("grover-plane.svg").match(/measured with ([\d., ]+) %/)[1].split(", ").map(Number);
  await slide("grover", 0, 3);
  for (const [k, percent] of known.entries()) {
    await slide("grover", 1, k);
    const found = await page.evaluate("Number(document.querySelector('figure[data-still=grover]').dataset.probability)");
    check(`grover, ${k} iterates`, "the probability of a good index in percent", 100 * found, percent, 0.011);
  }
  await visit(page, `${address}/oracle.html`);
  const steps = read("oracle-call.svg").match(/<g id="s\d+"/g).length - 1;
  const shown = () => page.evaluate("[...document.querySelectorAll('figure[data-still=call] img.qrt-shown')].map((i) => `${i.src.split('#')[1]} ${i.naturalWidth > 0}`).join()");
  if ((await shown()) !== "undefined true") fail("call", `begins with ${await shown()}, by itself though motion is not wanted`);
  await slide("call", 0, steps);
  await until(page, () => document.querySelector("figure[data-still=call] img.qrt-shown").naturalWidth > 0);
  if ((await shown()) !== `s${steps} true`) fail("call", `shows ${await shown()} after all ${steps} stages`);
  await page.evaluate(() => document.querySelector("figure[data-still=call] input").focus());
  await page.keyboard.press("ArrowLeft");
  if (!(await shown()).startsWith(`s${steps - 1} `)) fail("call", "does not move by keyboard");
  for (const fault of page.faults) fail("stills", fault);
  await shut(page);
}
