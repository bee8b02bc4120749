// Every page of the built book, light and dark, wide, narrow and on paper.
//
// A page fails if something goes wrong while it loads (an error or a warning on the console, an
// exception, a request that fails or leaves for another host), if it is wider than the window or the
// sheet, if a picture has no description, or if axe finds a violation of one of its rules.

import { readFileSync, readdirSync } from "node:fs";
import { join, relative } from "node:path";
import { NARROW, SHEET, THEMES, WIDE, shut, tab, until, visit } from "./browser.mjs";

const AXE = readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
/** Tabs that are open at the same time. */
const TABS = 2;
/** A part of the other pages: where scripts do not run, they show the table of contents in a frame. */
const FRAMED = "toc.html";

function files(folder, below = folder) {
  return readdirSync(below, { withFileTypes: true }).flatMap((entry) => {
    const path = join(below, entry.name);
    if (entry.isDirectory()) return files(folder, path);
    return entry.name.endsWith(".html") ? [relative(folder, path)] : [];
  });
}

/** Selectors of elements that stick out of the page, or out of the parts that mdBook scrolls in its place. */
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

/** Pictures, drawings and figures that do not say what they show. */
function undescribed() {
  const text = (element) => element?.textContent.trim() ?? "";
  const described = {
    img: (e) => e.alt.trim(),
    canvas: (e) => e.ariaLabel,
    "svg[role=img]": (e) => e.ariaLabel || text(e.querySelector("title")),
    figure: (e) => e.ariaLabel || text(e.querySelector("figcaption")) || e.querySelector("img[alt]:not([alt=''])"),
    // A drawing without a role is an ornament, and hidden from those who hear the page.
    "main svg:not([role])": (e) => e.closest("[aria-hidden=true], button, a"),
  };
  return Object.entries(described).flatMap(([selector, says]) =>
    [...document.querySelectorAll(selector)].filter((element) => !says(element)).map((element) => element.outerHTML.slice(0, 100)));
}

/** Faults of the layout of the page that is open. */
export async function misfits(page) {
  return (await page.evaluate(overflowing)).map((out) => `sticks out of the page: ${out}`);
}

/** Parts of a page on paper that would be cut or stay folded: paper neither scrolls nor unfolds. */
function lost() {
  const shown = (selector) => [...document.querySelectorAll(selector)].filter((element) => element.getClientRects().length);
  const edge = document.documentElement.clientWidth;
  const wide = shown("main :is(pre, pre > code, .table-wrapper, .formula)").filter((element) => element.scrollWidth > element.clientWidth + 1);
  const out = shown("main :is(pre, table, figure, img, svg)").filter((element) => element.getBoundingClientRect().right > edge + 1);
  const folded = [...document.querySelectorAll("main details > :not(summary)")].filter((element) => !element.checkVisibility());
  return [...new Set([...wide, ...out, ...folded])].map((element) => element.outerHTML.slice(0, 100));
}

/** Faults of the page that is open for readers who do not see it, or see it badly; maybe only of its colours. */
export async function barriers(page, onlyColours = false) {
  const silent = (await page.evaluate(undescribed)).map((html) => `has no description: ${html}`);
  if (!(await page.evaluate("window.axe !== undefined"))) await page.evaluate(`${AXE}; 0`);
  const violations = await page.evaluate(async (onlyColours) => {
    // All default rules. `preload` would load style sheets and media again, for rules about media.
    const rules = onlyColours ? { runOnly: ["color-contrast", "link-in-text-block"] } : {};
    const { violations } = await window.axe.run(document, { resultTypes: ["violations"], preload: false, ...rules });
    return violations.map(({ id, help, nodes }) => ({ id, help, html: nodes.map(({ html }) => html.slice(0, 160)) }));
  }, onlyColours);
  const told = violations.map(({ id, help, html }) => `axe: ${id} (${help}), ${html.length} times, such as ${html[0]}`);
  return [...silent, ...told];
}

/** Changes the theme of the page that is open, as its menu does. */
async function paint(page, theme) {
  await page.evaluate((theme) => {
    const button = document.getElementById(`mdbook-theme-${theme}`);
    if (button) button.click();
    // Pages of sources have no menu, and follow the theme when they are opened.
    else document.documentElement.dataset.theme = theme === "light" ? "light" : "dark";
  }, theme);
  // Each theme has a style sheet of its own for listings.
  await until(page, () => [...document.querySelectorAll("link[rel=stylesheet]")].every((link) => link.disabled || link.sheet));
}

/** Looks at a page in every form. */
async function look(page, address, name, fail) {
  await page.setViewport(NARROW);
  await visit(page, `${address}/${name}`);
  for (const size of [NARROW, WIDE]) {
    await page.setViewport(size);
    // Wide pages have the table of contents beside them.
    if (size === WIDE) await page.evaluate(() => document.getElementById("mdbook-sidebar-toggle")?.click());
    for (const theme of THEMES) {
      const where = `${name}, ${theme} at ${size.width}`;
      await paint(page, theme);
      for (const misfit of await misfits(page)) fail(where, misfit);
      // A theme changes nothing but colours, and these are the same at any width.
      const onlyColours = theme !== THEMES[0];
      if (name === FRAMED || (onlyColours && size === WIDE)) continue;
      for (const barrier of await barriers(page, onlyColours)) fail(where, barrier);
    }
  }
  // From a dark page, too, sheets are light.
  await page.emulateMediaType("print");
  await page.setViewport(SHEET);
  for (const html of await page.evaluate(lost)) fail(`${name} on paper`, `is cut or folded: ${html}`);
  await page.emulateMediaType(null);
  for (const fault of page.faults) fail(name, fault);
}

/** Counts the sheets of the summary card. */
export async function card(browser, address, fail) {
  const page = await tab(browser, WIDE);
  await visit(page, `${address}/summary.html`);
  const pdf = Buffer.from(await page.pdf({ preferCSSPageSize: true })).toString("latin1");
  const sheets = pdf.match(/\/Type \/Page\b/g)?.length;
  if (sheets !== 1) fail("summary.html", `is printed on ${sheets} sheets, not on one`);
  await shut(page);
}

/** Tries every page; returns the names of those with interactive figures. */
export async function everyPage(browser, address, folder, fail) {
  const waiting = files(folder).sort();
  const count = waiting.length;
  const withFigures = [];
  await Promise.all(Array.from({ length: TABS }, async () => {
    const page = await tab(browser, NARROW);
    // What slides or fades is where it will be.
    await page.evaluateOnNewDocument(() => addEventListener("DOMContentLoaded", () => {
      const style = document.createElement("style");
      style.textContent = "* { transition: none !important }";
      document.head.append(style);
    }));
    for (let name; (name = waiting.shift()); ) {
      await look(page, address, name, fail);
      if (await page.$("figure.qrt-interactive[data-figure]")) withFigures.push(name);
    }
    await shut(page);
  }));
  console.log(`${count} pages`);
  return withFigures.sort();
}
