// The playground, tried as a reader would: see test.mjs.

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { FORMS, THEMES, WIDE, screenshot, shut, tab, until, visit } from "./browser.mjs";
import { faint } from "./figures.mjs";
import { barriers, misfits } from "./pages.mjs";
import { QRT, SCREENSHOTS, check, checkAll, fail, inTime, qrt, root } from "./report.mjs";

/** Milliseconds from the page to the first picture of the Cornell box, and from a key to its underline. */
const FIRST_PICTURE = 3000;
const UNDERLINE = 60;
/** From a key to its underline, where the command answers over HTTP. */
const UNDERLINE_SERVED = 250;

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
    return this.page.evaluate((selector, text) => {
      const view = document.querySelector(selector).qrtEditor;
      view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
    }, SELECTOR, text);
  }

  text() {
    return this.page.evaluate((selector) => document.querySelector(selector).qrtEditor.state.doc.toString(), SELECTOR);
  }

  ready() {
    return until(this.page, (s) => ["ready", "static"].includes(document.querySelector(s).dataset.state), [SELECTOR]);
  }

  /** Until the picture is traced and counted, or the scene is wrong. */
  idle() {
    return until(this.page, (s) => !document.querySelector(s).dataset.busy, [SELECTOR], 120_000);
  }

  controls() {
    return this.page.evaluate((s) => Object.fromEntries([...document.querySelectorAll(`${s} [name]`)].map((input) => [input.name, input.value])), SELECTOR);
  }

  /** Chooses the arithmetic. */
  async arithmetic(model) {
    await this.page.evaluate((s, model) => {
      const choice = document.querySelector(`${s} [name=model]`);
      choice.value = model;
      choice.dispatchEvent(new Event("input"));
    }, SELECTOR, model);
    await this.idle();
  }

  /** The first line that the editor shows as a whole. */
  top() {
    return this.page.evaluate((selector) => {
      const view = document.querySelector(selector).qrtEditor;
      const { top } = view.scrollDOM.getBoundingClientRect();
      const line = view.lineBlockAtHeight(top - view.documentTop + 0.5);
      const whole = line.top + view.documentTop >= top - 0.5 ? line : view.lineBlockAtHeight(line.bottom + 0.5);
      return view.state.doc.lineAt(whole.from).text;
    }, SELECTOR);
  }

  /** Moves the mouse to a place in the first picture, in parts of its size; presses it there, if so asked. */
  async point(x, y, press = false) {
    const at = await this.page.evaluate((s, x, y) => {
      const canvas = document.querySelector(`${s} canvas`);
      canvas.scrollIntoView({ block: "center" });
      const box = canvas.getBoundingClientRect();
      return { x: box.x + x * box.width, y: box.y + y * box.height };
    }, SELECTOR, x, y);
    await this.page.mouse.move(at.x, at.y);
    if (press) await this.page.mouse.click(at.x, at.y);
  }

  /** Until that pixel is looked at. */
  looked(x, y) {
    return until(this.page, (s, words) => {
      const pixel = document.querySelector(`${s} .qrt-pixel`);
      return !pixel.dataset.busy && pixel.querySelector("h2")?.textContent === words;
    }, [SELECTOR, `Pixel ${x}, ${y}`]);
  }

  read() {
    return this.page.evaluate((selector) => {
      const figure = document.querySelector(selector);
      const told = {};
      for (const span of figure.querySelectorAll("[data-name]")) told[span.dataset.name] = span.dataset.value;
      const codes = [...figure.querySelectorAll(".qrt-problems li")].map((item) => item.dataset.code);
      const levels = [...figure.querySelectorAll("canvas")].filter((canvas) => canvas.offsetParent).map((canvas) => {
        // From a copy: many readings of the page's own canvas would be a warning on the console.
        const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
        copy.drawImage(canvas, 0, 0);
        return Array.from(copy.getImageData(0, 0, canvas.width, canvas.height).data);
      });
      const underlined = [...figure.querySelectorAll(".cm-lintRange")].map((part) => part.textContent);
      return { ...figure.dataset, told, codes, levels, underlined, said: figure.querySelector(".qrt-said")?.textContent };
    }, SELECTOR);
  }
}

/** Changes a colour, and types an error: what is on the page is SMALL. It is underlined within `most` milliseconds. */
async function edits(tried, where, most) {
  const { page } = tried;
  // A colour: the picture changes.
  const before = (await tried.read()).levels[0];
  await page.evaluate((s) => {
    const view = document.querySelector(s).qrtEditor;
    const at = view.state.doc.toString().indexOf("0.8, 0.5, 0.2");
    view.dispatch({ changes: { from: at, to: at + 3, insert: "0.1" } });
  }, SELECTOR);
  await until(page, (s) => document.querySelector(s).dataset.busy, [SELECTOR]);
  await tried.idle();
  const after = (await tried.read()).levels[0];
  if (before.every((level, k) => level === after[k])) fail(where, "a change of colour changes nothing");

  // An error, typed: the word before `albedo`'s colon.
  await page.evaluate((s) => {
    const view = document.querySelector(s).qrtEditor;
    const at = view.state.doc.toString().indexOf("albedo") + 6;
    view.focus();
    view.dispatch({ selection: { anchor: at } });
    performance.clearMeasures("qrt-underline");
  }, SELECTOR);
  for (const key of ["x", "y", "z"]) {
    await page.keyboard.press(key);
    await page.evaluate("new Promise((resolve) => setTimeout(resolve, 150))");
  }
  await tried.idle();
  const wrong = await tried.read();
  if (!wrong.underlined.includes("albedoxyz")) fail(where, `underlined is ${JSON.stringify(wrong.underlined)}`);
  const scratch = mkdtempSync(join(tmpdir(), "qrt-book-"));
  const file = join(scratch, "wrong.yaml");
  writeFileSync(file, await tried.text());
  let expected = "";
  try {
    qrt("inspect", file);
  } catch (error) {
    expected = error.stderr;
  }
  rmSync(scratch, { recursive: true });
  const codes = [...expected.matchAll(/^error\[(\w+)\]/gm)].map(([, code]) => code);
  if (!codes.length || codes.join() !== wrong.codes.join()) fail(where, `lists ${wrong.codes}, but qrt says ${codes}`);
  const delays = await page.evaluate(() => performance.getEntriesByName("qrt-underline").map(({ duration }) => duration));
  const longest = Math.max(...delays);
  console.log(`${where}: from a key to its underline ${longest.toFixed(0)} ms at most`);
  if (delays.length < 3) fail(where, `underlines ${delays.length} keys`);
  inTime(where, "an underline", longest, most);
}

/** Checks the captions while a picture is made, and the words for the pixel under the pointer. */
async function words(tried, where) {
  const { page } = tried;
  await page.evaluate((s) => {
    const figure = document.querySelector(s);
    const canvas = [...figure.querySelectorAll("canvas")].at(-1);
    const caption = canvas.closest("div").parentElement.querySelector(".qrt-caption");
    window.qrtCaptions = [];
    new MutationObserver(() => window.qrtCaptions.push({
      caption: caption.textContent, label: canvas.ariaLabel, busy: figure.dataset.busy ?? "",
    })).observe(caption, { childList: true });
    // Another seed: all of it is counted again.
    const seed = figure.querySelector("[name=seed]");
    seed.value = Number(seed.value) + 1;
    seed.dispatchEvent(new Event("input"));
  }, SELECTOR);
  await tried.idle();
  const said = (await page.evaluate(() => window.qrtCaptions)).filter(({ caption, busy }, k, all) => k === 0 || caption !== all[k - 1].caption || busy !== all[k - 1].busy);
  const expected = [["counted", "true"], ["counting ...", "true"], ["counted", ""]];
  const seen = said.map(({ caption, busy }) => [caption, busy]);
  if (JSON.stringify(seen) !== JSON.stringify(expected)) fail(where, `the counted picture's caption and whether it is made: ${JSON.stringify(seen)}`);
  for (const { caption, label } of said) if (label !== `the picture, ${caption}`) fail(where, `the picture under "${caption}" is called "${label}"`);

  // Its channel is the one with the most good indices.
  const scratch = mkdtempSync(join(tmpdir(), "qrt-book-"));
  const [file, counts] = [join(scratch, "scene.yaml"), join(scratch, "counts.csv")];
  writeFileSync(file, await tried.text());
  const { seed } = await tried.controls();
  qrt("render", file, "-o", join(scratch, "a.png"), "--counts", counts, "--estimator", "exact", "--seed", seed);
  const rows = readFileSync(counts, "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  rmSync(scratch, { recursive: true });
  const good = rows.filter(([x, y]) => x === "6" && y === "5").map((row) => Number(row[4]));
  const channel = ["red", "green", "blue"][good.lastIndexOf(Math.max(...good))];
  // No pixel is kept: the pointer chooses.
  await page.evaluate((s) => document.querySelector(`${s} canvas`).focus(), SELECTOR);
  await page.keyboard.press("Escape");
  await tried.point(0.51, 0.7);
  await tried.looked(6, 5);
  const told = await page.evaluate((s) => document.querySelector(`${s} .qrt-pixel`).innerText, SELECTOR);
  for (const part of [`good indices, ${channel}`, `shows of ${channel}`]) {
    if (!told.includes(part)) fail(where, `the pixel's words lack "${part}": ${told}`);
  }
}

/** The same page, served by the command. */
async function served(browser) {
  const scratch = mkdtempSync(join(tmpdir(), "qrt-book-"));
  writeFileSync(join(scratch, "small.yaml"), SMALL);
  const child = spawn(QRT, ["playground", join(scratch, "small.yaml")], { stdio: ["ignore", "pipe", "inherit"] });
  try {
    const line = await new Promise((resolve, reject) => {
      child.stdout.once("data", (data) => resolve(String(data)));
      child.once("exit", () => reject(new Error("qrt playground ended")));
    });
    const address = line.match(/http:\S+/)[0];
    for (const [theme, size] of FORMS) {
      const where = `qrt playground, ${theme} at ${size.width}`;
      const page = await tab(browser, size, theme);
      await visit(page, address);
      const tried = new Playground(page);
      await tried.ready();
      await until(page, () => performance.getEntriesByName("qrt-first-picture").length > 0, [], 60_000);
      await tried.idle();
      await until(page, (s) => document.querySelector(`${s} .qrt-cost [data-name=toffoli]`), [SELECTOR], 60_000);
      for (const misfit of await misfits(page)) fail(where, misfit);
      for (const barrier of await barriers(page)) fail(where, barrier);
      if (size === WIDE) {
        await words(tried, where);
        await edits(tried, where, UNDERLINE_SERVED);
      }
      await close(tried, where);
    }
  } finally {
    child.kill();
    rmSync(scratch, { recursive: true });
  }
}

async function close({ page }, where) {
  for (const fault of page.faults) fail(where, fault);
  await shut(page);
}

/** Tries all of it on the page `name`. */
export async function playground(browser, address, name) {
  const open = async (theme, size, hash) => {
    const page = await tab(browser, size, theme);
    await visit(page, `${address}/${name}${hash}`);
    await page.evaluate((selector) => document.querySelector(selector).scrollIntoView(), SELECTOR);
    const tried = new Playground(page);
    await tried.ready();
    return tried;
  };

  // The first picture, and every example.
  {
    const where = `${name}, examples`;
    const tried = await open(THEMES[0], WIDE, "#example=cornell-box");
    const first = () => tried.page.evaluate(() => performance.getEntriesByName("qrt-first-picture").map((m) => m.startTime + m.duration));
    await until(tried.page, () => performance.getEntriesByName("qrt-first-picture").length > 0, [], 60_000);
    const [took] = await first();
    console.log(`${where}: the first picture ${took.toFixed(0)} ms after the page was asked for`);
    inTime(where, "the first picture", took, FIRST_PICTURE);
    // What an example says of itself stands above what is shown.
    // The editor scrolls once more when it has measured its lines.
    const named = async (scene) => {
      const patience = Date.now() + 5_000;
      let line = await tried.top();
      while (!line.startsWith("name:") && Date.now() < patience) {
        await new Promise((soon) => setTimeout(soon, 50));
        line = await tried.top();
      }
      if (!line.startsWith("name:")) fail(where, `${scene} is shown from "${line}" on`);
    };
    await named("the first example");
    const scenes = readdirSync(join(root, "scenes-yaml")).filter((file) => file.endsWith(".yaml"));
    const offered = await tried.page.evaluate((s) => [...document.querySelectorAll(`${s} [name=example] option`)].map((o) => o.value), SELECTOR);
    check(where, "the number of examples", offered.length, scenes.length);
    for (const scene of offered) {
      const before = (await first()).length;
      await tried.page.evaluate((s, scene) => {
        const choice = document.querySelector(`${s} [name=example]`);
        choice.value = scene;
        choice.dispatchEvent(new Event("input"));
      }, SELECTOR, scene);
      await until(tried.page, (count) => performance.getEntriesByName("qrt-first-picture").length > count, [before], 120_000)
        .catch(() => fail(where, `${scene} makes no picture`));
      const { codes, said, levels, state_of_scene } = await tried.read();
      if (state_of_scene !== "valid" || codes.length) fail(where, `${scene} has problems: ${codes} ${said}`);
      if (!levels[0].some((level, k) => k % 4 < 3 && level > 0)) fail(where, `${scene} is black`);
      await named(scene);
    }
    await close(tried, where);
  }

  // Numbers, edits, underlines, pixels, links.
  {
    const where = `${name}, a small scene`;
    const tried = await open(THEMES[0], WIDE, "");
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
    await until(page, (s) => document.querySelector(s).dataset.busy, [SELECTOR]);
    await tried.idle();
    for (const choice of ["real", "fixed", "both"]) {
      await tried.arithmetic(choice);
      const { told, levels } = await tried.read();
      const model = choice === "both" ? "real" : choice;
      const exact = rendered("--model", model, "--estimator", "exact");
      const counted = rendered("--model", model);
      const pictures = [exact, counted];
      const mean = exact.reduce((a, b) => a + b) / exact.length;
      const squares = counted.reduce((sum, value, k) => sum + (value - exact[k]) ** 2, 0);
      check(`${where}, ${choice}`, "the mean", told.mean, mean, 1e-9);
      check(`${where}, ${choice}`, "the error of counting", told.rmse, Math.sqrt(squares / exact.length) / mean, 1e-9);
      if (choice === "both") {
        // The circuit's integers between the two, and how far they are off.
        const beside = rendered("--model", "fixed", "--estimator", "exact");
        pictures.splice(1, 0, beside);
        const apart = beside.reduce((sum, value, k) => sum + (value - exact[k]) ** 2, 0);
        check(`${where}, ${choice}`, "how far integers are off", told.apart, Math.sqrt(apart / exact.length) / mean, 1e-9);
      }
      check(`${where}, ${choice}`, "the number of pictures", levels.length, pictures.length);
      // As the exposure is at first: twice as bright.
      const srgb = (v) => level(2 * v);
      const level = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(v, 1) ** (1 / 2.4) - 0.055));
      for (const [k, picture] of pictures.entries()) {
        checkAll(`${where}, ${choice}`, "levels", levels[k].filter((_, at) => at % 4 < 3), picture.map(srgb));
      }
    }
    // Its oracle.
    await until(page, (s) => document.querySelector(`${s} .qrt-cost [data-name=toffoli]`), [SELECTOR], 60_000);
    const { told } = await tried.read();
    const inspected = JSON.parse(qrt("inspect", file, "--json"));
    check(where, "Toffolis", told.toffoli, inspected.gates.toffoli);
    check(where, "qubits", told.qubits, inspected.qubits.peak);

    // A pixel, by mouse: the one under it, until a click keeps one, and again from a click on that one on.
    await tried.point(0.51, 0.01);
    await tried.looked(6, 0);
    await tried.point(0.01, 0.99, true);
    await tried.looked(0, 7);
    await tried.point(0.51, 0.51);
    await page.evaluate("new Promise((resolve) => setTimeout(resolve, 200))");
    await tried.looked(0, 7).catch(() => fail(where, "the mouse moves from the pixel that was kept"));
    await tried.point(0.99, 0.01, true);
    await tried.looked(11, 0);
    await tried.point(0.99, 0.01, true);
    await tried.point(0.51, 0.51);
    await tried.looked(6, 4);

    // A pixel, by keyboard.
    await page.evaluate((s) => document.querySelector(`${s} canvas`).focus(), SELECTOR);
    await page.keyboard.press("ArrowDown");
    await until(page, (s) => document.querySelector(`${s} .qrt-pixel h2`)?.textContent === "Pixel 6, 5", [SELECTOR]);
    await until(page, (s) => document.querySelector(`${s} .qrt-pixel [data-name=amplitude]`), [SELECTOR]);
    const means = (await tried.read()).told;
    const place = 3 * (12 * 5 + 6);
    const exact = rendered("--estimator", "exact");
    const shown = await page.evaluate((s) => document.querySelector(`${s} .qrt-pixel [data-name=mean]`).dataset.value, SELECTOR);
    checkAll(where, "channels of a pixel", shown.split(" ").map(Number), exact.slice(place, place + 3), 1e-12);
    check(where, "its amplitude", means.amplitude, means.good / (256 * 2 ** inspected.comparator_bits), 1e-12);

    // What the schema suggests where a key is typed: erase it, and ask.
    await page.evaluate((s) => {
      const view = document.querySelector(s).qrtEditor;
      view.focus();
      view.dispatch({ selection: { anchor: view.state.doc.toString().indexOf("albedo") + 6 } });
    }, SELECTOR);
    for (let k = 0; k < 6; k++) await page.keyboard.press("Backspace");
    await page.keyboard.down("Control");
    await page.keyboard.press("Space");
    await page.keyboard.up("Control");
    await until(page, () => document.querySelector(".cm-tooltip-autocomplete li"), []).catch(() => fail(where, "nothing is suggested"));
    const suggested = await page.evaluate(() => [...document.querySelectorAll(".cm-tooltip-autocomplete .cm-completionLabel")].map((e) => e.textContent));
    if (!suggested.includes("albedo")) fail(where, `suggests ${suggested} in a lambertian material`);

    // A link that carries the scene.
    await tried.replace(SMALL);
    await tried.idle();
    await page.evaluate((s) => document.querySelector(`${s} [name=link]`).click(), SELECTOR);
    await until(page, () => location.hash.startsWith("#scene="), []);
    const hash = await page.evaluate("location.hash");
    await close(tried, where);
    const again = await open(THEMES[0], WIDE, hash);
    await until(again.page, (s, text) => document.querySelector(s).qrtEditor.state.doc.toString() === text, [SELECTOR, SMALL])
      .catch(() => fail(where, "the link brings another scene"));
    await close(again, where);
    rmSync(scratch, { recursive: true });
  }

  for (const [theme, size] of FORMS) {
    const where = `${name}, ${theme} at ${size.width}`;
    const tried = await open(theme, size, "");
    const { page } = tried;
    await tried.replace(SMALL.replace("albedo", "albdo"));
    await until(page, (s) => document.querySelector(`${s} .qrt-problems li`), [SELECTOR]);
    for (const text of await faint(page, SELECTOR)) fail(where, text);
    await tried.replace(SMALL);
    await tried.idle();
    await page.evaluate((s) => document.querySelector(`${s} canvas`).focus(), SELECTOR);
    await page.keyboard.press("Enter");
    await until(page, (s) => document.querySelector(`${s} .qrt-pixel [data-name=mean]`), [SELECTOR]);
    await until(page, (s) => document.querySelector(`${s} .qrt-stages`), [SELECTOR], 60_000);
    for (const text of await faint(page, SELECTOR)) fail(where, text);
    for (const misfit of await misfits(page)) fail(where, misfit);
    for (const barrier of await barriers(page)) fail(where, barrier);
    if (SCREENSHOTS) await screenshot(page, SELECTOR, join(SCREENSHOTS, `playground-${theme}-${size.width}.png`));
    if (size === WIDE) {
      await words(tried, where);
      await edits(tried, where, UNDERLINE);
    }
    await close(tried, where);
  }
  await served(browser);
}
