// Turns each <figure class="qrt-interactive" data-figure="NAME"> of a page into the interactive one.
//
// What figures show is computed by qrt itself, compiled to WebAssembly (book/widgets). A figure is
// loaded when it comes near the viewport; until then, and wherever WebAssembly or scripts do not
// run, its static picture stays.

import { instance } from "./library.js";

const FIGURES = {
  counting: () => import("./counting.js"),
  map: () => import("./map.js"),
  circuit: () => import("./circuit.js"),
  picture: () => import("./picture.js"),
  playground: () => import("./playground.js"),
};

// Those that bring what answers them along.
const ALONE = new Set(["playground"]);

/** What a figure shows where scripts do not run, but for its caption. */
const stills = (figure) => [...figure.children].filter((child) => child.tagName !== "FIGCAPTION");

async function start(figure) {
  const name = figure.dataset.figure;
  const load = FIGURES[name];
  if (!load || figure.dataset.state) return;
  figure.dataset.state = "loading";
  const begun = performance.now();
  try {
    const [figureModule, qrt] = await Promise.all([load(), ALONE.has(name) ? null : instance(name)]);
    const body = document.createElement("div");
    body.className = "qrt-body";
    body.setAttribute("role", "group");
    body.setAttribute("aria-label", `interactive figure: ${name}`);
    // The static picture's place, before anything is drawn: sizes are measured in the page.
    for (const child of stills(figure)) child.hidden = true;
    figure.prepend(body);
    await (qrt ? figureModule.start(body, qrt, figure) : figureModule.start(body, figure));
    figure.dataset.state = "ready";
    performance.mark("qrt-figure-ready", { detail: name });
    performance.measure(`qrt-figure:${name}`, { start: begun, end: performance.now() });
  } catch (error) {
    figure.querySelector(".qrt-body")?.remove();
    for (const child of stills(figure)) child.hidden = false;
    figure.dataset.state = "static";
    const note = document.createElement("p");
    note.className = "qrt-note";
    note.textContent = `This figure is a still picture here: ${error.message}.`;
    figure.append(note);
  }
}

const near = new IntersectionObserver(
  (entries) => {
    for (const { isIntersecting, target } of entries) {
      if (isIntersecting) {
        near.unobserve(target);
        start(target);
      }
    }
  },
  { rootMargin: "400px" },
);

for (const figure of document.querySelectorAll("figure.qrt-interactive")) near.observe(figure);
