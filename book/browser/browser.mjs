// Chromium without a window, driven by puppeteer-core, and what goes wrong in its pages.

import puppeteer from "puppeteer-core";

export const WIDE = { width: 1280, height: 900 };
/** A window as narrow as a phone. */
export const NARROW = { width: 375, height: 740 };
/** A phone. */
export const PHONE = { ...NARROW, isMobile: true, hasTouch: true, deviceScaleFactor: 2 };
/** A sheet of A4 within its margins, in CSS pixels: see theme/print.css. */
export const SHEET = { width: 665, height: 970 };
/** A light theme and a dark one. */
export const THEMES = ["light", "navy"];
/** Forms in which figures are tried: their layout does not depend on the theme, nor their colours on the size. */
export const FORMS = [[THEMES[0], WIDE], [THEMES[1], PHONE]];

/** Starts the browser. Its sandbox does not work for the superuser, who runs tests in containers. */
export function launch(executablePath) {
  const args = ["--disable-gpu", "--mute-audio"];
  if (process.getuid?.() === 0) args.push("--no-sandbox");
  return puppeteer.launch({ executablePath, args, defaultViewport: null });
}

/** Keeps the page's faults since its last visit in `page.faults`. */
function watch(page) {
  page.faults = new Set();
  page.on("pageerror", (error) => page.faults.add(`exception: ${error?.stack ?? error}`));
  page.on("console", (message) => {
    if (["error", "warn", "assert"].includes(message.type())) {
      page.faults.add(`console: ${message.text()} ${message.location()?.url ?? ""}`);
    }
  });
  page.on("requestfailed", (request) => {
    const error = request.failure()?.errorText;
    // A page that is left while it loads takes nothing more.
    if (error !== "net::ERR_ABORTED") page.faults.add(`failed: ${request.url()} ${error}`);
  });
  page.on("request", (request) => {
    const url = new URL(request.url());
    const own = url.host === page.host || ["data:", "blob:", "about:"].includes(url.protocol);
    if (page.host && !own) page.faults.add(`a request to another host: ${url.href}`);
  });
}

/**
 * Opens a tab of `size` with storage of its own. The book's pages begin in `theme`, other pages follow
 * its colour scheme.
 */
export async function tab(browser, size, theme = THEMES[0]) {
  const context = await browser.createBrowserContext();
  const page = await context.newPage();
  watch(page);
  await page.setViewport(size);
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: theme === THEMES[0] ? "light" : "dark" }]);
  await page.evaluateOnNewDocument((theme) => {
    if (location.protocol.startsWith("http")) localStorage.setItem("mdbook-theme", theme);
  }, theme);
  return page;
}

/** Opens an address in a tab, and waits until what the page asks for is there. */
export async function visit(page, address) {
  page.host = new URL(address).host;
  page.faults.clear();
  await page.goto(address, { waitUntil: "load" });
}

export const shut = (page) => page.browserContext().close();

/** Waits until a function in the page returns a true value, for `patience` milliseconds at most. */
export function until(page, condition, args = [], patience = 20_000) {
  return page.waitForFunction(condition, { polling: 20, timeout: patience }, ...args).catch((error) => {
    throw new Error(`waited in vain: ${condition} ${JSON.stringify(args)}: ${error.message}`);
  });
}

/** Writes a screenshot of the element `selector` to `path`. */
export async function screenshot(page, selector, path) {
  await (await page.$(selector)).screenshot({ path });
}
