// What figures are made of: labelled controls, readouts, drawings.

/** An element with attributes and children. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/** An element of a drawing. */
export function shape(tag, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/** A box of controls; each is put into it as it is made. */
export class Controls {
  constructor(body, changed) {
    this.box = element("div", { class: "qrt-controls" });
    this.changed = changed;
    body.append(this.box);
  }

  place(label, input, ...more) {
    const text = element("span", { class: "qrt-label" }, label);
    this.box.append(element("label", {}, text, input, ...more));
    input.addEventListener("input", () => this.changed(input));
    return input;
  }

  /** A slider; `told` says what its value means. */
  slider(name, label, { min, max, step = 1, value, told = String }) {
    const input = element("input", { type: "range", name, min, max, step, value });
    const shown = element("span", { class: "qrt-value" });
    const tell = () => {
      shown.textContent = told(Number(input.value));
      input.setAttribute("aria-valuetext", shown.textContent);
    };
    input.addEventListener("input", tell);
    input.tell = tell;
    tell();
    return this.place(label, input, shown);
  }

  number(name, label, { min, max, value }) {
    return this.place(label, element("input", { type: "number", name, min, max, value }));
  }

  /** A choice among `options`: pairs of a value and its words. */
  choice(name, label, options) {
    const made = options.map(([value, words]) => element("option", { value }, words));
    return this.place(label, element("select", { name }, ...made));
  }

  check(name, label) {
    return this.place(label, element("input", { type: "checkbox", name }));
  }

  text(name, label, value) {
    const attributes = { type: "text", name, value, spellcheck: "false", autocomplete: "off" };
    return this.place(label, element("input", attributes));
  }

  /** Buttons side by side: pairs of words and what they do. */
  buttons(...pairs) {
    const made = pairs.map(([name, words, action]) => {
      const button = element("button", { type: "button", name }, words);
      button.addEventListener("click", action);
      return button;
    });
    this.box.append(element("div", { class: "qrt-buttons" }, ...made));
    return made;
  }
}

/** The whole number that an input holds, within its bounds. */
export function whole(input) {
  const value = Math.round(Number(input.value));
  const bounded = Math.min(Math.max(value, Number(input.min)), Number(input.max));
  return Number.isFinite(bounded) ? bounded : Number(input.min);
}

/** Numbers in words, each also as `data-value` with all its digits. */
export class Readouts {
  constructor(body) {
    this.box = element("output", { class: "qrt-readouts", "aria-live": "polite" });
    body.append(this.box);
  }

  /** Shows `entries`: name, words, value, and how it is told. */
  show(entries) {
    this.box.replaceChildren(
      ...entries.map(([name, words, value, told]) => {
        const number = element("b", {}, told === undefined ? String(value) : told);
        return element("span", { "data-name": name, "data-value": String(value) }, `${words} `, number);
      }),
    );
  }
}

/** A number with so many significant digits, without an exponent where that can be read. */
export function digits(value, count = 4) {
  if (value === 0 || !Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  return size >= 1e-4 && size < 1e7 ? String(Number(value.toPrecision(count))) : value.toExponential(count - 1);
}

/** With spaces between thousands. */
export const grouped = (value) => Math.round(value).toLocaleString("en-GB").replaceAll(",", "\u202f");

/** 2 to that power, as it is written. */
export const powerOfTwo = (power) => `2${String(power).replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit])}`;

/** Calls `draw(width)` now and whenever the element's width or the page's theme changes. */
export function whenResized(box, draw) {
  let last = 0;
  const redraw = (force) => {
    const width = Math.floor(box.clientWidth);
    if (width > 0 && (force || width !== last)) {
      last = width;
      draw(width);
    }
  };
  new ResizeObserver(() => redraw(false)).observe(box);
  const themes = new MutationObserver(() => redraw(true));
  themes.observe(document.documentElement, { attributes: true, attributeFilter: ["class"] });
  redraw(true);
}

/** A canvas's context in CSS pixels, sharp on this screen. */
export function sharp(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.width = `${width}px`;
  canvas.style.height = `${height}px`;
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return context;
}

/** The page's colour of that name. */
export const colour = (box, name) => getComputedStyle(box).getPropertyValue(name).trim();

// Viridis, in nine steps: it grows lighter evenly, and is told apart by the colour-blind.
const VIRIDIS = [
  [68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
  [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37],
];

/** The colour at a place in [0, 1] of the scale. */
export function viridis(place) {
  const at = Math.min(Math.max(place, 0), 1) * (VIRIDIS.length - 1);
  const low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  const mixed = VIRIDIS[low].map((part, k) => Math.round(part + (at - low) * (VIRIDIS[low + 1][k] - part)));
  return `rgb(${mixed.join(" ")})`;
}
