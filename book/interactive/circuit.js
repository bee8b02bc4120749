// A tiny scene's oracle, operation by operation: registers of one basis state, signs of all.

import { Controls, Readouts, digits, element, grouped, shape, whole } from "./parts.js";

// Milliseconds an operation is shown while the program plays.
const PACE = 450;

export function start(body, qrt, figure) {
  const about = qrt("circuit");
  if (about.error) throw new Error(about.error);
  const list = (text) => text.split("\n");
  const [names, types, roles, steps, blocks] = ["names", "types", "roles", "steps", "blocks"].map((k) => list(about[k]));
  const ids = 2 ** about.id_bits;
  const comparators = 2 ** about.comparator_bits;
  figure.dataset.qubits = about.qubits;
  figure.dataset.toffolis = about.toffolis.reduce((a, b) => a + b);
  let before = null;
  let timer = null;

  const controls = new Controls(body, update);
  const id = controls.slider("id", "path index", { min: 0, max: ids - 1, value: 5 });
  const comparator = controls.slider("comparator", "comparator", { min: 0, max: comparators - 1, value: 2 });
  const step = controls.slider("step", "operations run", {
    min: 0, max: about.operations, value: 0, told: (n) => `${n} of ${about.operations}`,
  });
  const [, play] = controls.buttons(
    ["back", "◂ back", () => go(whole(step) - 1)],
    ["play", "play", () => (timer ? stop() : run())],
    ["forward", "forward ▸", () => go(whole(step) + 1)],
  );

  const phases = element("div", { class: "qrt-phases", "aria-hidden": "true" });
  for (const [words, from, to] of [
    ["compute", 0, about.computed], ["flip", about.computed, about.flipped], ["uncompute", about.flipped, about.operations],
  ]) {
    phases.append(element("span", { style: `flex-grow:${to - from}`, "data-from": from, "data-to": to }, words));
  }
  const told = element("p", { class: "qrt-told" });
  const rows = names.map((name, place) => {
    const cells = ["bits", "integer", "real"].map((kind) => element("td", { class: `qrt-${kind}` }));
    const depth = about.depths[place] < 0 ? "" : about.depths[place];
    const row = element("tr", { "data-register": name },
      element("th", { scope: "row" }, name), element("td", {}, depth), element("td", {}, roles[place]),
      element("td", { class: "qrt-type" }, types[place]), ...cells);
    return { row, cells };
  });
  const heads = ["register", "depth", "role", "type", "bits", "integer", "real"];
  const table = element("table", {},
    element("caption", {}, "Registers of the chosen basis state"),
    element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", { scope: "col", class: `qrt-${head}` }, head)))),
    element("tbody", {}, ...rows.map(({ row }) => row)));
  const signs = element("div", { class: "qrt-signs" });
  const scene = element("details", { class: "qrt-scene" }, element("summary", {}, "the scene"), element("pre", {}, about.scene));
  const scroll = element("div", { class: "qrt-scroll", tabindex: "0", role: "region", "aria-label": "registers" }, table);
  body.append(phases, told, element("div", { class: "qrt-beside" }, scroll, element("div", {}, signs, scene)));
  const readouts = new Readouts(body);
  const cells = drawSigns();

  function go(position) {
    step.value = Math.min(Math.max(position, 0), about.operations);
    step.tell();
    update();
  }

  function run() {
    if (whole(step) === about.operations) go(0);
    play.textContent = "pause";
    timer = setInterval(() => {
      go(whole(step) + 1);
      if (whole(step) === about.operations) stop();
    }, PACE);
  }

  function stop() {
    clearInterval(timer);
    timer = null;
    play.textContent = "play";
  }

  /** A square for every basis state: path indices from left to right, comparators from below. */
  function drawSigns() {
    const size = 14;
    const [width, height] = [ids * size, comparators * size];
    const svg = shape("svg", { viewBox: `-18 -16 ${width + 20} ${height + 34}`, role: "img", "aria-label": "the sign of every basis state" });
    svg.append(shape("text", { x: 0, y: -5, class: "qrt-title" }, "sign of every (path index, comparator)"));
    const made = [];
    for (let y = 0; y < comparators; y++) {
      for (let x = 0; x < ids; x++) {
        const cell = shape("rect", { x: x * size + 1, y: (comparators - 1 - y) * size + 1, width: size - 2, height: size - 2, rx: 2 });
        cell.addEventListener("click", () => {
          id.value = x;
          comparator.value = y;
          id.tell();
          comparator.tell();
          update();
        });
        svg.append(cell);
        made.push(cell);
      }
    }
    svg.append(shape("text", { x: width / 2, y: height + 14, class: "qrt-tick", "text-anchor": "middle" }, "path index →"));
    svg.append(shape("text", { x: -6, y: height / 2, class: "qrt-tick", "text-anchor": "middle", transform: `rotate(-90 -6 ${height / 2})` }, "comparator →"));
    signs.append(svg);
    return made;
  }

  function update() {
    const position = whole(step);
    const now = qrt("circuit_step", [whole(id), whole(comparator), position]);
    const bits = now.bits.split("\n");
    rows.forEach(({ row, cells: [binary, integer, real] }, place) => {
      const held = now.computed[place] === 1;
      const scratch = roles[place] === "scratch";
      row.classList.toggle("qrt-empty", !held);
      row.classList.toggle("qrt-changed", before !== null && before.computed[place] !== now.computed[place]);
      row.dataset.held = held ? "1" : "0";
      row.dataset.value = now.values[place];
      binary.textContent = held && !scratch ? bits[place] : "";
      integer.textContent = !held ? "0" : scratch ? `${now.values[place]} of ${types[place].match(/\d+/)} set` : now.values[place];
      real.textContent = held && about.fractions[place] > 0 ? digits(now.values[place] / 2 ** about.fractions[place], 6) : "";
    });
    const changed = table.querySelector(".qrt-changed");
    if (changed) scroll.scrollTop = changed.offsetTop - scroll.clientHeight / 2;
    before = now;
    const chosen = whole(id) + whole(comparator) * ids;
    cells.forEach((cell, place) => {
      cell.setAttribute("class", `${now.signs[place] ? "qrt-minus" : "qrt-plus"}${place === chosen ? " qrt-chosen" : ""}`);
    });
    const last = position - 1;
    for (const phase of phases.children) {
      phase.classList.toggle("qrt-now", last >= Number(phase.dataset.from) && last < Number(phase.dataset.to));
    }
    told.textContent = position === 0
      ? "Before the first operation: all path indices and comparators in superposition, every other qubit zero."
      : `Operation ${position}, in ${blocks[last]}: ${steps[last]}. Gates: ${grouped(about.gates[last])}, of which Toffolis: ${grouped(about.toffolis[last])}.`;
    const ancillas = now.held - about.id_bits - about.comparator_bits;
    const flipped = now.signs.reduce((sum, sign) => sum + sign, 0);
    readouts.show([
      ["negative", "sign of this state", now.negative, now.negative ? "−" : "+"],
      ["flipped", "states with a flipped phase", flipped, `${flipped} of ${ids * comparators}`],
      ["held", "qubits in use besides path index and comparator", ancillas, `${ancillas} of ${grouped(about.qubits - about.id_bits - about.comparator_bits)}`],
      ["unowned_are_zero", "all others looked at, on every state:", now.unowned_are_zero, now.unowned_are_zero ? "zero" : "not zero"],
      ["position", "operations run", now.position, `${now.position} of ${about.operations}`],
    ]);
  }

  update();
}
