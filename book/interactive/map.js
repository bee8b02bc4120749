// A lattice in the unit square, where a map takes it on the hemisphere, and its Jacobian.

import { Controls, Readouts, colour, digits, element, grouped, sharp, viridis, whenResized, whole } from "./parts.js";

const OWN = "2";
// Milliseconds without typing before a map of the reader's own is checked.
const PAUSE = 250;

export function start(body, qrt) {
  let answer;
  let waiting;

  const controls = new Controls(body, (input) => {
    if (input === turn || input === tilt) return draw();
    clearTimeout(waiting);
    if (input.type === "text") waiting = setTimeout(update, PAUSE);
    else update();
  });
  const map = controls.choice("map", "map φ", [
    ["0", "uniform hemisphere"], ["1", "cosine hemisphere"], [OWN, "my own"],
  ]);
  const bits = controls.slider("bits", "bits of u and of v", {
    min: 1, max: 6, value: 4, told: (n) => `${n}: ${grouped(4 ** n)} points`,
  });
  const turn = controls.slider("turn", "turn", { min: 0, max: 360, step: 5, value: 30, told: (n) => `${n}°` });
  const tilt = controls.slider("tilt", "tilt", { min: 0, max: 90, step: 5, value: 60, told: (n) => `${n}°` });
  const own = [
    controls.text("x", "x(u, v) =", "sqrt(1 - u^2) * cos(2*pi*v)"),
    controls.text("y", "y(u, v) =", "sqrt(1 - u^2) * sin(2*pi*v)"),
    controls.text("z", "z(u, v) =", "u"),
  ];

  const square = element("canvas", { role: "img", "aria-label": "the lattice in the unit square" });
  const sphere = element("canvas", { role: "img", "aria-label": "its directions on the hemisphere" });
  const pair = element("div", { class: "qrt-pair" }, square, sphere);
  const wrong = element("pre", { class: "qrt-wrong", role: "alert", hidden: true });
  const legend = element("div", { class: "qrt-legend" });
  body.append(pair, legend, wrong);
  const readouts = new Readouts(body);

  function update() {
    const mine = map.value === OWN;
    for (const input of own) input.closest("label").hidden = !mine;
    const found = qrt("map", [Number(map.value), whole(bits)], own.map((input) => input.value).join("\n"));
    wrong.hidden = !found.error;
    wrong.textContent = found.error ?? "";
    pair.classList.toggle("qrt-stale", Boolean(found.error));
    readouts.box.hidden = Boolean(found.error);
    if (found.error) return;
    answer = found;
    const [least, most] = range();
    const told = (value) => digits(value, 4);
    const scale = [told(least), element("span", { class: "qrt-scale" }), told(most)];
    legend.replaceChildren("J = |φᵤ × φᵥ|: ", ...(most / least > 1 + 1e-9 ? scale : [`${told(most)} everywhere`]));
    readouts.show([
      ["points", "points", answer.points, grouped(answer.points)],
      ["multiplied", "∫ cos over the hemisphere, multiplied by J:", answer.multiplied, answer.multiplied.toFixed(4)],
      ["divided", "divided by J, as the paper has it:", answer.divided, answer.divided.toFixed(4)],
      ["jacobian", "J =", answer.jacobian_formula],
    ]);
    draw();
  }

  function range() {
    const finite = answer.jacobian.filter(Number.isFinite);
    return [Math.min(...finite), Math.max(...finite)];
  }

  function draw() {
    if (!answer) return;
    const all = Math.floor(pair.clientWidth);
    if (all <= 0) return;
    const side = Math.min(all < 480 ? Math.min(all, 320) : Math.floor((all - 16) / 2), 340);
    const [least, most] = range();
    const span = Math.log(most / least);
    const paint = Array.from(answer.jacobian, (j) => viridis(span > 1e-9 ? Math.log(j / least) / span : 0.5));
    const radius = Math.max(1.4, Math.min(5, 0.22 * side / 2 ** whole(bits)));
    const ink = colour(body, "--qrt-grid");
    drawSquare(sharp(square, side, side), side, paint, radius, ink);
    drawSphere(sharp(sphere, side, side), side, paint, radius, ink);
  }

  function dot(context, x, y, radius) {
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fill();
  }

  function drawSquare(context, side, paint, radius, ink) {
    const edge = 18;
    const inner = side - 2 * edge;
    context.strokeStyle = ink;
    context.strokeRect(edge, edge, inner, inner);
    context.fillStyle = colour(body, "--qrt-muted");
    context.font = "italic 14px serif";
    context.fillText("u", side / 2 - 3, side - 4);
    context.fillText("v", 4, side / 2);
    for (let k = 0; k < paint.length; k++) {
      context.fillStyle = paint[k];
      dot(context, edge + answer.u[k] * inner, side - edge - answer.v[k] * inner, radius);
    }
  }

  function drawSphere(context, side, paint, radius, ink) {
    const scale = side / 2 - 14;
    const below = answer.z.some((z) => z < -1e-9);
    const [sin, cos] = [Math.sin, Math.cos].map((f) => f((Number(turn.value) * Math.PI) / 180));
    const [lift, flat] = [Math.sin, Math.cos].map((f) => f((Number(tilt.value) * Math.PI) / 180));
    // Seen along the horizon at a tilt of 0, and from above at 90 degrees.
    const middle = below ? side / 2 : side / 2 + 0.42 * scale * flat;
    const project = (x, y, z) => {
      const [across, away] = [x * cos - y * sin, x * sin + y * cos];
      return [side / 2 + scale * across, middle - scale * (away * lift + z * flat), z * lift - away * flat];
    };
    context.strokeStyle = ink;
    context.beginPath();
    context.ellipse(side / 2, middle, scale, Math.max(scale * lift, 0.01), 0, 0, 2 * Math.PI);
    context.stroke();
    context.beginPath();
    context.arc(side / 2, middle, scale, below ? 0 : Math.PI, 2 * Math.PI);
    context.stroke();
    const points = Array.from(paint, (_, k) => [...project(answer.x[k], answer.y[k], answer.z[k]), k]);
    points.sort((a, b) => a[2] - b[2]);
    for (const [x, y, depth, k] of points) {
      context.globalAlpha = depth < 0 ? 0.35 : 1;
      context.fillStyle = paint[k];
      dot(context, x, y, radius);
    }
    context.globalAlpha = 1;
  }

  update();
  whenResized(pair, draw);
}
