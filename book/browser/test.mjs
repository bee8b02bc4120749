// Opens every page of the built book in a browser and tries its figures. `test` beside it says how
// it is run.
//
// A page fails if it complains (an error or warning on the console, an exception, a request that fails
// or goes to another host), or if it is wider than a phone. A figure fails if a control cannot be
// reached or moved by keyboard, if it is not there within a second, if its words cannot be read in a
// theme, or if its numbers are not those of the command `qrt`.

import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, relative } from "node:path";
import { Browser } from "./browser.mjs";
import { playground } from "./playground.mjs";
import { serve } from "./serve.mjs";

const [folder, root] = process.argv.slice(2);
const { AXE, QRT, CHROMIUM, SCREENSHOTS } = process.env;
/** What looks for barriers in a page; none where it is not there. */
const axe = existsSync(AXE ?? "") ? readFileSync(AXE, "utf8") : null;
/** Pages that are parts of others. */
const PARTS = ["toc.html"];

const WIDE = [1280, 900, false];
const PHONE = [375, 740, true];
/** Pages that are open at the same time. */
const TABS = 3;
/** Bytes that WebAssembly stays below. */
const WASM = {
  "qrt_circuit.wasm": 500_000,
  "qrt_counting.wasm": 500_000,
  "qrt_map.wasm": 500_000,
  "qrt_picture.wasm": 500_000,
  "qrt_playground.wasm": 5_000_000,
};
/** Milliseconds until a figure can be used. */
const SOON = 1000;
/**
 * Milliseconds for which the picture may keep its page busy at a stretch. It means to stay below 50,
 * and does on a machine that has nothing else to do; tests run on others, too.
 */
const BUSY = 500;
/** Contrast that text must have: WCAG 2, level AA. */
const CONTRAST = 4.5;
/** Themes that figures are tried in. */
const THEMES = ["light", "navy"];

const failures = [];
const fail = (where, what) => {
  failures.push(`${where}: ${what}`);
  console.error(`FAILED  ${where}: ${what}`);
};

function check(where, name, found, expected, tolerance = 0) {
  const close = Math.abs(found - expected) <= tolerance * Math.max(1, Math.abs(expected));
  if (!close) fail(where, `${name} is ${found}, but qrt says ${expected}`);
}

/** The same of two lists: says how many differ, and how the first. */
function checkAll(where, name, found, expected, tolerance = 0) {
  check(where, `the number of ${name}`, found.length, expected.length);
  const differ = expected.flatMap((value, k) => {
    const close = Math.abs(found[k] - value) <= tolerance * Math.max(1, Math.abs(value));
    return close ? [] : [k];
  });
  if (differ.length) {
    const [k] = differ;
    fail(where, `${differ.length} of the ${name} differ from qrt's; number ${k} is ${found[k]}, but qrt says ${expected[k]}`);
  }
}

/** What the command answers. */
const qrt = (...args) => execFileSync(QRT, args, { cwd: root, encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "pipe"] });

function pages(below) {
  return readdirSync(below, { withFileTypes: true }).flatMap((entry) => {
    const path = join(below, entry.name);
    if (entry.isDirectory()) return pages(path);
    return entry.name.endsWith(".html") ? [relative(folder, path)] : [];
  });
}

/** Elements that stick out of the page, or of what mdBook makes scroll in its place, as selectors. */
function overflowing() {
  const frames = [];
  for (let at = document.querySelector("main") ?? document.body; at; at = at.parentElement) frames.push(at);
  const wide = frames.filter((frame) => frame.scrollWidth > frame.clientWidth + 1);
  if (!wide.length) return [];
  const edge = wide[0].getBoundingClientRect().left + wide[0].clientWidth;
  const scrolls = (element) => {
    for (let at = element.parentElement; at && !frames.includes(at); at = at.parentElement) {
      if (getComputedStyle(at).overflowX !== "visible") return true;
    }
    return false;
  };
  const out = [...wide[0].querySelectorAll("*")].filter((element) => {
    const { right, width } = element.getBoundingClientRect();
    return width > 0 && right > edge + 1 && !scrolls(element);
  });
  const named = out.slice(0, 3).map((e) => e.tagName.toLowerCase() + (e.className && typeof e.className === "string" ? `.${e.className}` : ""));
  return named.length ? named : [`${wide[0].tagName.toLowerCase()} is ${wide[0].scrollWidth} wide`];
}

/** What keeps readers out of the page that is open, if it is serious. */
async function barriers(page) {
  if (!axe) return [];
  await page.value(`${axe}; 0`);
  const found = await page.call(async () => {
    const { violations } = await window.axe.run(document, { resultTypes: ["violations"] });
    return violations.map(({ id, impact, nodes }) => ({ id, impact, html: nodes[0].html.slice(0, 100), count: nodes.length }));
  });
  return found
    .filter(({ impact }) => ["serious", "critical"].includes(impact))
    .map(({ id, html, count }) => `a barrier: ${id}, ${count} times, such as ${html}`);
}

/** Has every document of a page begin in that theme. */
const themed = (page, theme) => page.send("Page.addScriptToEvaluateOnNewDocument", {
  source: `localStorage.setItem("mdbook-theme", "${theme}");`,
});

/** Every page, wide and narrow in the first theme, wide in the others. Answers those with figures. */
async function everyPage(browser, address) {
  let found = [];
  // One theme after another: all pages that are open have one, since they share what is stored.
  for (const theme of THEMES) {
    const withFigures = await everyPageIn(browser, address, theme);
    if (theme === THEMES[0]) found = withFigures;
  }
  return found;
}

async function everyPageIn(browser, address, theme) {
  const waiting = pages(folder).sort();
  const count = waiting.length;
  const withFigures = [];
  const sizes = [];
  await Promise.all(Array.from({ length: TABS }, async () => {
    const page = await browser.page();
    await themed(page, theme);
    for (let name; (name = waiting.shift()); ) {
      for (const size of theme === THEMES[0] ? [WIDE, PHONE] : [WIDE]) {
        const where = `${name}, ${theme} at ${size[0]}`;
        await page.size(...size);
        await page.visit(`${address}/${name}`);
        // What scripts do once a page is there, they do now.
        await page.value("new Promise((resolve) => setTimeout(resolve, 60))");
        for (const complaint of new Set(page.complaints)) fail(where, complaint);
        for (const out of await page.call(overflowing)) fail(where, `sticks out of the page: ${out}`);
        if (size === WIDE) {
          if (!PARTS.includes(name)) for (const barrier of await barriers(page)) fail(where, barrier);
          sizes.push([[...page.loaded.values()].reduce((a, b) => a + b, 0), name]);
          if (await page.value("document.querySelector('figure.qrt-interactive[data-figure]') !== null")) withFigures.push(name);
        }
      }
    }
  }));
  sizes.sort((a, b) => b[0] - a[0]);
  console.log(`${count} pages, ${theme}`);
  if (theme !== THEMES[0]) return [];
  for (const [wasm, most] of Object.entries(WASM)) {
    const { size } = statSync(join(folder, "interactive", wasm));
    if (size >= most) fail(wasm, `it has ${size} bytes; less than ${most} are allowed`);
  }
  for (const [bytes, name] of sizes.slice(0, 5)) console.log(`  ${(bytes / 1024).toFixed(0).padStart(6)} KiB  ${name}, with all it loads at first`);
  return withFigures.sort();
}

/** A figure of the page that is open. */
class Figure {
  constructor(page, name, where) {
    Object.assign(this, { page, name, where });
    this.selector = `figure.qrt-interactive[data-figure="${name}"]`;
  }

  /** What the figure says: readouts by name, and its data. */
  read() {
    return this.page.call((selector) => {
      const figure = document.querySelector(selector);
      const told = {};
      for (const span of figure.querySelectorAll("[data-name]")) told[span.dataset.name] = span.dataset.value;
      const controls = {};
      for (const input of figure.querySelectorAll("[name]")) controls[input.name] = input.type === "checkbox" ? input.checked : input.value;
      return { ...figure.dataset, told, controls, error: figure.querySelector(".qrt-wrong:not([hidden])")?.textContent ?? null };
    }, this.selector);
  }

  idle() {
    return this.page.until((s) => document.querySelector(s).dataset.state === "ready" && !document.querySelector(s).dataset.busy, [this.selector], 120_000);
  }

  /** Puts a control to a value, as the reader's hand would, at once. */
  async set(name, value) {
    await this.page.call((selector, name, value) => {
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
    const names = await page.call((selector) => {
      const all = [...document.querySelectorAll(`${selector} [name]`)].filter((input) => input.offsetParent);
      all[0].focus();
      return all.map((input) => [input.name, input.tagName === "BUTTON" ? "button" : input.type]);
    }, selector);
    const state = () => page.call((selector) => {
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
      if (place > 0) await page.key("Tab");
      const before = await state();
      if (before.name !== name) {
        fail(where, `Tab leads to ${before.name}, not to ${name}`);
        return;
      }
      if (!before.label.trim()) fail(where, `${name} has no label`);
      const keys = { range: ["ArrowRight"], "select-one": ["ArrowDown"], number: ["ArrowUp"], checkbox: [" "], text: ["End", " "], button: ["Enter"] }[type];
      // A button at the end of its way has nothing to do: forward comes before back.
      for (const key of keys) await page.key(key);
      let after = await state();
      if (after.value === before.value && ["range", "select-one"].includes(type)) {
        await page.key(type === "range" ? "ArrowLeft" : "ArrowUp");
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

  /** Text that is hard to read, in the theme that is on. */
  faint() {
    return faint(this.page, this.selector);
  }
}

/** Text below `selector` that is hard to read, in the theme that is on. */
function faint(page, selector) {
  return page.call((selector, least) => {
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
    const said = await figure.page.until((s) => document.querySelector(`${s} .qrt-wrong:not([hidden])`)?.textContent, [figure.selector]);
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
    const shown = await page.call((s) => [...document.querySelectorAll(`${s} [data-register]`)].map((row) => row.dataset.register).sort(), figure.selector);
    const registers = new Set(inspected.registers.map(({ name }) => name));
    for (const name of registers) if (!shown.includes(name)) fail(where, `the register ${name} is missing`);
    // The good ids, all of them, against those of the picture that the circuit makes.
    const scratch = mkdtempSync(join(tmpdir(), "qrt-book-"));
    const counts = join(scratch, "counts.csv");
    qrt("render", "book/widgets/scenes/lamp.yaml", "--model", "gates", "--estimator", "exact", "-o", join(scratch, "a.png"), "--counts", counts);
    const [red] = readFileSync(counts, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
    rmSync(scratch, { recursive: true });
    const last = Number((await page.call((s) => document.querySelector(`${s} [name=step]`).max, figure.selector)));
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

/** All figures of a page. */
async function figures(browser, address, name) {
  for (const theme of THEMES) {
    for (const size of [WIDE, PHONE]) {
      const page = await browser.page();
      await page.size(...size);
      await page.send("Page.addScriptToEvaluateOnNewDocument", {
        source: `localStorage.setItem("mdbook-theme", "${theme}");
          window.qrtLong = [];
          new PerformanceObserver((list) => window.qrtLong.push(...list.getEntries())).observe({ type: "longtask" });`,
      });
      await page.visit(`${address}/${name}`);
      const names = await page.value("[...document.querySelectorAll('figure.qrt-interactive[data-figure]:not([data-figure=playground])')].map((f) => f.dataset.figure)");
      for (const kind of names) {
        const where = `${name}, ${kind}, ${theme} at ${size[0]}`;
        const figure = new Figure(page, kind, where);
        await page.call((selector) => document.querySelector(selector).scrollIntoView({ block: "center" }), figure.selector);
        await page.until((s) => ["ready", "static"].includes(document.querySelector(s).dataset.state), [figure.selector]);
        const { state } = await figure.read();
        if (state !== "ready") {
          fail(where, await page.call((s) => document.querySelector(s).textContent.trim(), figure.selector));
          continue;
        }
        const { ready, took } = await page.call((kind) => {
          const measure = performance.getEntriesByName(`qrt-figure:${kind}`)[0];
          return { ready: measure.startTime + measure.duration, took: measure.duration };
        }, kind);
        await figure.idle();
        // What keeps the page busy from the figure's first moment on; before, it is the page itself.
        const busy = await page.call((from) => Math.max(0, ...window.qrtLong.filter((task) => task.startTime >= from).map((task) => task.duration)), ready - took);
        console.log(`${where}: there after ${took.toFixed(0)} ms, ${ready.toFixed(0)} ms after the page was asked for; longest task ${busy.toFixed(0)} ms`);
        if (took > SOON) fail(where, `takes ${took.toFixed(0)} ms to load`);
        if (kind === "picture" && busy > BUSY) fail(where, `keeps the page busy for ${busy.toFixed(0)} ms`);
        if (SCREENSHOTS) {
          const box = await page.call((s) => {
            const { x, y, width, height } = document.querySelector(s).getBoundingClientRect();
            return { x: x + scrollX, y: y + scrollY, width, height };
          }, figure.selector);
          await page.picture(join(SCREENSHOTS, `${kind}-${theme}-${size[0]}.png`), { ...box, scale: 1 });
        }
        for (const faint of await figure.faint()) fail(where, faint);
        if (theme === THEMES[0]) await figure.byKeyboard();
        if (theme === THEMES[0] && size === WIDE) await NUMBERS[kind]?.(figure);
        for (const out of await page.call(overflowing)) fail(where, `sticks out of the page: ${out}`);
      }
      for (const complaint of new Set(page.complaints)) fail(`${name}, ${theme} at ${size[0]}`, complaint);
      await page.send("Page.close").catch(() => {});
    }
  }
}

/** The figures that need no server's WebAssembly: moved by keyboard, and held against the still pictures' own words. */
async function stills(browser, address) {
  const page = await browser.page();
  await page.size(...WIDE);
  await page.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-reduced-motion", value: "reduce" }] });
  const read = (name) => readFileSync(join(folder, "figures", name), "utf8");
  const slide = (name, place, value) => page.call((name, place, value) => {
    const input = document.querySelectorAll(`figure.qrt-still[data-still=${name}] input`)[place];
    input.value = value;
    input.dispatchEvent(new Event("input"));
  }, name, place, value);
  await page.visit(`${address}/grover.html`);
  // What a state vector finds after 0, 1, 2, 3 iterates.
  const known = read("grover-plane.svg").match(/measured with ([\d., ]+) %/)[1].split(", ").map(Number);
  await slide("grover", 0, 3);
  for (const [k, percent] of known.entries()) {
    await slide("grover", 1, k);
    const found = await page.value("Number(document.querySelector('figure[data-still=grover]').dataset.probability)");
    check(`grover, ${k} iterates`, "the probability of a good index in percent", 100 * found, percent, 0.011);
  }
  await page.visit(`${address}/oracle.html`);
  const steps = read("oracle-call.svg").match(/<g id="s\d+"/g).length - 1;
  const shown = () => page.value("[...document.querySelectorAll('figure[data-still=call] img.qrt-shown')].map((i) => `${i.src.split('#')[1]} ${i.naturalWidth > 0}`).join()");
  if ((await shown()) !== "undefined true") fail("call", `begins with ${await shown()}, by itself though motion is not wanted`);
  await slide("call", 0, steps);
  await page.until(() => document.querySelector("figure[data-still=call] img.qrt-shown").naturalWidth > 0);
  if ((await shown()) !== `s${steps} true`) fail("call", `shows ${await shown()} after all ${steps} stages`);
  await page.call(() => document.querySelector("figure[data-still=call] input").focus());
  await page.key("ArrowLeft");
  if (!(await shown()).startsWith(`s${steps - 1} `)) fail("call", "does not move by keyboard");
  for (const complaint of new Set(page.complaints)) fail("stills", complaint);
}

const { server, address } = await serve(folder);
const browser = await Browser.start(CHROMIUM);
try {
  const withFigures = process.env.ONLY ? [process.env.ONLY] : await everyPage(browser, address);
  const tools = { fail, check, checkAll, qrt, root, themes: THEMES, sizes: [WIDE, PHONE], faint, overflowing, barriers, command: QRT, screenshots: SCREENSHOTS };
  for (const name of withFigures) {
    await figures(browser, address, name);
    if (name === "playground.html") await playground(browser, address, name, tools);
  }
  await stills(browser, address);
  console.log(`figures on ${withFigures.length} pages`);
} catch (error) {
  fail("the test", error.stack);
} finally {
  await browser.stop();
  server.close();
}
if (failures.length) {
  console.error(`\n${failures.length} failures`);
  process.exit(1);
}
console.log("all of it holds");
