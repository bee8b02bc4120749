// The playground, tried as a reader would: see test.mjs.

import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** Milliseconds from the page to the first picture of the Cornell box, and from a key to its underline. */
const FIRST_PICTURE = 3000;
const UNDERLINE = 60;

const SELECTOR = 'figure[data-figure="playground"]';

/** A scene that is small enough to be traced to its end at once. */
const SMALL = `name: floor
camera: { perspective: { eye: [0, 2, 4], target: [0, 0.4, 0], vfov: 40 } }
film: { width: 12, height: 8 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
  lamp: { emitter: { radiance: [4, 3, 2] } }
geometry:
  - quad: { vertices: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: floor }
  - quad: { vertices: [[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]], material: lamp }
sampling: { path_bits: 8, depths: [{ bits: [6, 6] }, { bits: [6, 6], light: [6, 6] }] }
`;

class Playground {
  constructor(page) {
    this.page = page;
  }

  replace(text) {
    return this.page.call((selector, text) => {
      const view = document.querySelector(selector).qrtEditor;
      view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
    }, SELECTOR, text);
  }

  text() {
    return this.page.call((selector) => document.querySelector(selector).qrtEditor.state.doc.toString(), SELECTOR);
  }

  ready() {
    return this.page.until((s) => ["ready", "static"].includes(document.querySelector(s).dataset.state), [SELECTOR]);
  }

  /** Until the picture is traced and counted, or the scene is wrong. */
  idle() {
    return this.page.until((s) => !document.querySelector(s).dataset.busy, [SELECTOR], 120_000);
  }

  read() {
    return this.page.call((selector) => {
      const figure = document.querySelector(selector);
      const told = {};
      for (const span of figure.querySelectorAll("[data-name]")) told[span.dataset.name] = span.dataset.value;
      const codes = [...figure.querySelectorAll(".qrt-problems li")].map((item) => item.dataset.code);
      const levels = [...figure.querySelectorAll("canvas")].map((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        return Array.from(data);
      });
      const underlined = [...figure.querySelectorAll(".cm-lintRange")].map((part) => part.textContent);
      return { ...figure.dataset, told, codes, levels, underlined, said: figure.querySelector(".qrt-said")?.textContent };
    }, SELECTOR);
  }
}

/** Tries all of it on the page `name`; `tools` are those of test.mjs. */
export async function playground(browser, address, name, { fail, check, checkAll, qrt, root, themes, sizes, faint, overflowing, screenshots }) {
  const open = async (theme, size, hash) => {
    const page = await browser.page();
    await page.size(...size);
    await page.send("Page.addScriptToEvaluateOnNewDocument", { source: `localStorage.setItem("mdbook-theme", "${theme}");` });
    await page.visit(`${address}/${name}${hash}`);
    await page.call((selector) => document.querySelector(selector).scrollIntoView(), SELECTOR);
    const tried = new Playground(page);
    await tried.ready();
    return tried;
  };
  const close = async (tried, where) => {
    for (const complaint of new Set(tried.page.complaints)) fail(where, complaint);
    await tried.page.send("Page.close").catch(() => {});
  };

  // The first picture, and every example.
  {
    const where = `${name}, examples`;
    const tried = await open(themes[0], sizes[0], "#example=cornell-box");
    const first = () => tried.page.call(() => performance.getEntriesByName("qrt-first-picture").map((m) => m.startTime + m.duration));
    await tried.page.until(() => performance.getEntriesByName("qrt-first-picture").length > 0, [], 60_000);
    const [took] = await first();
    console.log(`${where}: the first picture ${took.toFixed(0)} ms after the page was asked for`);
    if (took > FIRST_PICTURE) fail(where, `the first picture comes after ${took.toFixed(0)} ms`);
    const scenes = readdirSync(join(root, "scenes-yaml")).filter((file) => file.endsWith(".yaml"));
    const offered = await tried.page.call((s) => [...document.querySelectorAll(`${s} [name=example] option`)].map((o) => o.value), SELECTOR);
    check(where, "the number of examples", offered.length, scenes.length);
    for (const scene of offered) {
      const before = (await first()).length;
      await tried.page.call((s, scene) => {
        const choice = document.querySelector(`${s} [name=example]`);
        choice.value = scene;
        choice.dispatchEvent(new Event("input"));
      }, SELECTOR, scene);
      await tried.page.until((count) => performance.getEntriesByName("qrt-first-picture").length > count, [before], 120_000)
        .catch(() => fail(where, `${scene} makes no picture`));
      const { codes, said, levels, state_of_scene } = await tried.read();
      if (state_of_scene !== "valid" || codes.length) fail(where, `${scene} has problems: ${codes} ${said}`);
      if (!levels[0].some((level, k) => k % 4 < 3 && level > 0)) fail(where, `${scene} is black`);
    }
    await close(tried, where);
  }

  // Numbers, edits, underlines, pixels, links.
  {
    const where = `${name}, a small scene`;
    const tried = await open(themes[0], sizes[0], "");
    const { page } = tried;
    const scratch = mkdtempSync(join(tmpdir(), "qrt-book-"));
    const file = join(scratch, "small.yaml");
    writeFileSync(file, SMALL);
    const rendered = (...more) => {
      const counts = join(scratch, "counts.csv");
      qrt("render", file, "-o", join(scratch, "a.png"), "--counts", counts, ...more);
      return readFileSync(counts, "utf8").trim().split("\n").slice(1).map((line) => Number(line.split(",")[3]));
    };
    await tried.replace(SMALL);
    await page.until((s) => document.querySelector(s).dataset.busy, [SELECTOR]);
    await tried.idle();
    for (const model of ["real", "fixed"]) {
      await page.call((s, model) => {
        const choice = document.querySelector(`${s} [name=model]`);
        choice.value = model;
        choice.dispatchEvent(new Event("input"));
      }, SELECTOR, model);
      await tried.idle();
      const { told, levels } = await tried.read();
      const exact = rendered("--model", model, "--estimator", "exact");
      const counted = rendered("--model", model);
      const mean = exact.reduce((a, b) => a + b) / exact.length;
      const squares = counted.reduce((sum, value, k) => sum + (value - exact[k]) ** 2, 0);
      check(`${where}, ${model}`, "the mean", told.mean, mean, 1e-9);
      check(`${where}, ${model}`, "the error of counting", told.rmse, Math.sqrt(squares / exact.length) / mean, 1e-9);
      // As the exposure is at first: twice as bright.
      const srgb = (v) => level(2 * v);
      const level = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(v, 1) ** (1 / 2.4) - 0.055));
      for (const [k, picture] of [exact, counted].entries()) {
        checkAll(`${where}, ${model}`, "levels", levels[k].filter((_, at) => at % 4 < 3), picture.map(srgb));
      }
    }
    // Its oracle.
    await page.until((s) => document.querySelector(`${s} .qrt-cost [data-name=toffoli]`), [SELECTOR], 60_000);
    const { told } = await tried.read();
    const inspected = JSON.parse(qrt("inspect", file, "--json"));
    check(where, "Toffolis", told.toffoli, inspected.gates.toffoli);
    check(where, "qubits", told.qubits, inspected.qubits.peak);

    // A pixel, by keyboard.
    await page.call((s) => document.querySelector(`${s} canvas`).focus(), SELECTOR);
    await page.key("ArrowDown");
    await page.until((s) => document.querySelector(`${s} .qrt-pixel h3`)?.textContent === "Pixel 6, 5", [SELECTOR]);
    await page.until((s) => document.querySelector(`${s} .qrt-pixel [data-name=amplitude]`), [SELECTOR]);
    const means = (await tried.read()).told;
    const place = 3 * (12 * 5 + 6);
    const exact = rendered("--estimator", "exact");
    const shown = await page.call((s) => document.querySelector(`${s} .qrt-pixel [data-name=mean]`).dataset.value, SELECTOR);
    checkAll(where, "channels of a pixel", shown.split(" ").map(Number), exact.slice(place, place + 3), 1e-12);
    check(where, "its amplitude", means.amplitude, means.good / (256 * 2 ** inspected.comparator_bits), 1e-12);

    // A colour: the picture changes.
    const before = (await tried.read()).levels[0];
    await page.call((s) => {
      const view = document.querySelector(s).qrtEditor;
      const at = view.state.doc.toString().indexOf("0.8, 0.5, 0.2");
      view.dispatch({ changes: { from: at, to: at + 3, insert: "0.1" } });
    }, SELECTOR);
    await page.until((s) => document.querySelector(s).dataset.busy, [SELECTOR]);
    await tried.idle();
    const after = (await tried.read()).levels[0];
    if (before.every((level, k) => level === after[k])) fail(where, "a change of colour changes nothing");

    // An error, typed: the word before `albedo`'s colon.
    await page.call((s) => {
      const view = document.querySelector(s).qrtEditor;
      const at = view.state.doc.toString().indexOf("albedo") + 6;
      view.focus();
      view.dispatch({ selection: { anchor: at } });
      performance.clearMeasures("qrt-underline");
    }, SELECTOR);
    for (const key of ["x", "y", "z"]) {
      await page.key(key);
      await page.value("new Promise((resolve) => setTimeout(resolve, 150))");
    }
    await tried.idle();
    const wrong = await tried.read();
    if (!wrong.underlined.includes("albedoxyz")) fail(where, `underlined is ${JSON.stringify(wrong.underlined)}`);
    let expected = "";
    writeFileSync(file, (await tried.text()));
    try {
      qrt("inspect", file);
    } catch (error) {
      expected = error.stderr;
    }
    const codes = [...expected.matchAll(/^error\[(\w+)\]/gm)].map(([, code]) => code);
    if (!codes.length || codes.join() !== wrong.codes.join()) fail(where, `lists ${wrong.codes}, but qrt says ${codes}`);
    const delays = await page.call(() => performance.getEntriesByName("qrt-underline").map(({ duration }) => duration));
    const longest = Math.max(...delays);
    console.log(`${where}: from a key to its underline ${longest.toFixed(0)} ms at most`);
    if (delays.length < 3 || longest > UNDERLINE) fail(where, `underlines ${delays.length} keys, after ${longest.toFixed(0)} ms at most`);

    // What the schema suggests there: erase, ask, and take the first.
    for (let k = 0; k < 9; k++) await page.key("Backspace");
    await page.send("Input.dispatchKeyEvent", { type: "rawKeyDown", key: " ", code: "Space", windowsVirtualKeyCode: 32, modifiers: 2 });
    await page.send("Input.dispatchKeyEvent", { type: "keyUp", key: " ", code: "Space", windowsVirtualKeyCode: 32, modifiers: 2 });
    await page.until(() => document.querySelector(".cm-tooltip-autocomplete li"), []).catch(() => fail(where, "nothing is suggested"));
    const suggested = await page.call(() => [...document.querySelectorAll(".cm-tooltip-autocomplete .cm-completionLabel")].map((e) => e.textContent));
    if (!suggested.includes("albedo")) fail(where, `suggests ${suggested} in a lambertian material`);

    // A link that carries the scene.
    await tried.replace(SMALL);
    await tried.idle();
    await page.call((s) => document.querySelector(`${s} [name=link]`).click(), SELECTOR);
    await page.until(() => location.hash.startsWith("#scene="), []);
    const hash = await page.value("location.hash");
    await close(tried, where);
    const again = await open(themes[0], sizes[0], hash);
    await again.page.until((s, text) => document.querySelector(s).qrtEditor.state.doc.toString() === text, [SELECTOR, SMALL])
      .catch(() => fail(where, "the link brings another scene"));
    await close(again, where);
    rmSync(scratch, { recursive: true });
  }

  // In every theme, wide and narrow.
  for (const theme of themes) {
    for (const size of sizes) {
      const where = `${name}, ${theme} at ${size[0]}`;
      const tried = await open(theme, size, "");
      const { page } = tried;
      await tried.replace(SMALL.replace("albedo", "albdo"));
      await page.until((s) => document.querySelector(`${s} .qrt-problems li`), [SELECTOR]);
      for (const words of await faint(page, SELECTOR)) fail(where, words);
      await tried.replace(SMALL);
      await tried.idle();
      await page.call((s) => document.querySelector(`${s} canvas`).focus(), SELECTOR);
      await page.key("Enter");
      await page.until((s) => document.querySelector(`${s} .qrt-pixel [data-name=mean]`), [SELECTOR]);
      await page.until((s) => document.querySelector(`${s} .qrt-stages`), [SELECTOR], 60_000);
      for (const words of await faint(page, SELECTOR)) fail(where, words);
      for (const out of await page.call(overflowing)) fail(where, `sticks out of the page: ${out}`);
      const unnamed = await page.call((s) => [...document.querySelectorAll(`${s} :is(input, select, button, canvas, progress)`)]
        .filter((e) => !(e.labels?.length || e.ariaLabel || e.textContent.trim())).map((e) => e.outerHTML.slice(0, 80)), SELECTOR);
      for (const html of unnamed) fail(where, `has no name for who cannot see it: ${html}`);
      if (screenshots) {
        const box = await page.call((s) => {
          const { x, y, width, height } = document.querySelector(s).getBoundingClientRect();
          return { x: x + scrollX, y: y + scrollY, width, height };
        }, SELECTOR);
        await page.picture(join(screenshots, `playground-${theme}-${size[0]}.png`), { ...box, scale: 1 });
      }
      await close(tried, where);
    }
  }
  console.log(`${name}: the playground, tried`);
}
