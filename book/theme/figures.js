// Figures that move without a server: they need no WebAssembly, and run in a page that is opened
// as a file, too. Each is a <figure class="qrt-still" data-still="NAME"> with a still picture.

(() => {
  const SVG = "http://www.w3.org/2000/svg";
  /** Milliseconds for which a step is shown. */
  const PACE = 900;

  /** An element with attributes, holding children. */
  const element = (name, attributes = {}, ...children) => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  };

  /** A slider under its words; `told` says what its value means. */
  function slider(into, words, { min, max, value, told }, changed) {
    const output = element("span");
    const input = element("input", { type: "range", min, max, value, step: 1 });
    const label = element("label", {}, element("span", {}, `${words} `, output), input);
    const tell = () => {
      output.textContent = told(Number(input.value));
      input.setAttribute("aria-valuetext", output.textContent);
    };
    input.addEventListener("input", () => { tell(); changed(); });
    into.append(label);
    tell();
    return { input, tell, get value() { return Number(input.value); } };
  }

  /** One oracle call, stage by stage: the drawing has a state for each fragment #s0, #s1, ... */
  function call(figure) {
    const still = figure.querySelector("img");
    const STEPS = Number(figure.dataset.steps);
    const stage = element("div", { class: "qrt-stage" });
    const images = [still];
    still.replaceWith(stage);
    stage.append(still);
    for (let step = 1; step <= STEPS; step++) {
      const image = element("img", { src: `${still.getAttribute("src")}#s${step}`, alt: `The call after stage ${step}` });
      images.push(image);
      stage.append(image);
    }
    const controls = element("div", { class: "qrt-steps" });
    const play = element("button", { type: "button" }, "play");
    controls.append(play);
    const told = (step) => (step ? `${step} of ${STEPS}` : "all");
    const step = slider(controls, "stage", { min: 0, max: STEPS, value: 0, told }, show);
    stage.after(controls);
    let timer = null;
    function show() {
      images.forEach((image, k) => image.classList.toggle("qrt-shown", k === step.value));
    }
    function stop() {
      clearInterval(timer);
      timer = null;
      play.textContent = "play";
    }
    function go(to) {
      step.input.value = to;
      step.tell();
      show();
    }
    function start() {
      if (step.value === STEPS) go(0);
      play.textContent = "pause";
      timer = setInterval(() => {
        go(step.value + 1);
        if (step.value === STEPS) stop();
      }, PACE);
    }
    play.addEventListener("click", () => (timer ? stop() : start()));
    show();
    // By itself it runs once, when it is first seen, for those who have nothing against motion.
    if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches) {
      const seen = new IntersectionObserver(([entry]) => {
        if (entry.isIntersecting) {
          seen.disconnect();
          if (!timer && step.value === 0) start();
        }
      }, { threshold: 0.9 });
      seen.observe(stage);
    }
  }

  /** The state in the plane of good and bad indices. */
  function grover(figure) {
    const still = figure.querySelector("img");
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("viewBox", "0 0 560 300");
    svg.setAttribute("role", "img");
    const said = element("p", { "aria-live": "polite", style: "text-align:center;margin:0.3em 0" });
    const controls = element("div", { class: "qrt-steps" });
    const BITS = 6;
    const total = 2 ** BITS;
    const good = slider(controls, "good indices S", { min: 0, max: total, value: 3, told: (s) => `${s} of ${total}` }, draw);
    const iterates = slider(controls, "iterates k", { min: 0, max: 24, value: 1, told: (k) => `${k}` }, draw);
    const shape = (name, attributes, text = "") => {
      const made = document.createElementNS(SVG, name);
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
      made.textContent = text;
      svg.append(made);
    };
    const [ox, oy, radius] = [280, 160, 118];
    const at = (angle, r = radius) => [ox + r * Math.cos(angle), oy - r * Math.sin(angle)];
    function arrow(angle, colour, name) {
      const [x, y] = at(angle);
      shape("line", { x1: ox, y1: oy, x2: x, y2: y, stroke: colour, "stroke-width": 2.4 });
      shape("circle", { cx: x, cy: y, r: 4, fill: colour });
      const [tx, ty] = at(angle, radius + 17);
      shape("text", { x: tx, y: ty + 4, "text-anchor": Math.cos(angle) < -0.3 ? "end" : Math.cos(angle) > 0.3 ? "start" : "middle" }, name);
    }
    function draw() {
      const phi = Math.asin(Math.sqrt(good.value / total));
      const angle = (2 * iterates.value + 1) * phi;
      svg.replaceChildren();
      shape("title", {}, "The state in the plane of good and bad indices");
      shape("circle", { cx: ox, cy: oy, r: radius, fill: "none", stroke: "currentColor", opacity: 0.3 });
      shape("line", { x1: ox - radius - 12, y1: oy, x2: ox + radius + 12, y2: oy, stroke: "currentColor", opacity: 0.5 });
      shape("line", { x1: ox, y1: oy - radius - 12, x2: ox, y2: oy + radius + 12, stroke: "currentColor", opacity: 0.5 });
      shape("text", { x: ox + 8, y: oy - radius - 18 }, "good");
      shape("text", { x: ox + radius + 18, y: oy + 18 }, "bad");
      const [, y] = at(angle);
      const [x] = at(angle);
      shape("line", { x1: x, y1: y, x2: ox, y2: y, stroke: "#b3500a", "stroke-dasharray": "4 3" });
      arrow(phi, "#b3500a", iterates.value ? "|s⟩" : "");
      arrow(angle, "#4c8fd0", iterates.value ? `after ${iterates.value}` : "|s⟩");
      const degrees = (a) => (a * 180 / Math.PI).toFixed(1);
      const probability = Math.sin(angle) ** 2;
      said.textContent = `Each iterate turns by ${degrees(2 * phi)}°. The state stands at ${degrees(angle)}°, and a measured index is good with ${(100 * probability).toFixed(1)} %.`;
      figure.dataset.probability = probability;
    }
    still.replaceWith(svg);
    svg.after(said, controls);
    draw();
  }

  // The others need a web server, which a page that is opened as a file has not.
  if (location.protocol === "file:") {
    for (const figure of document.querySelectorAll("figure.qrt-interactive")) {
      figure.dataset.state = "static";
      const told = "A still picture of an interactive figure, which needs a web server: cargo book serve.";
      figure.querySelector("img")?.after(element("p", { class: "qrt-note" }, told));
    }
  }

  const FIGURES = { call, grover };
  for (const figure of document.querySelectorAll("figure.qrt-still")) FIGURES[figure.dataset.still]?.(figure);
})();
