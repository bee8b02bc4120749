// The playground by itself, served by `qrt playground`.

import { start } from "./playground.js";

const dark = matchMedia("(prefers-color-scheme: dark)");
const theme = () => (document.documentElement.className = dark.matches ? "navy" : "light");
dark.addEventListener("change", theme);
theme();

const figure = document.querySelector("figure");
const body = document.createElement("div");
body.className = "qrt-body";
body.setAttribute("role", "group");
body.setAttribute("aria-label", "playground");
figure.append(body);
const scene = await fetch("interactive/scene.yaml");
if (scene.status === 200) figure.dataset.scene = await scene.text();
try {
  await start(body, figure);
  figure.dataset.state = "ready";
} catch (error) {
  figure.dataset.state = "static";
  body.append(`The playground does not work here: ${error.message}.`);
}
