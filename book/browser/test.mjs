// Tries the built book in a browser: its pages, its figures and its playground. `test` beside it says
// how it is run.

import { launch } from "./browser.mjs";
import { figures, stills } from "./figures.mjs";
import { card, everyPage } from "./pages.mjs";
import { playground } from "./playground.mjs";
import { CHROMIUM, fail, failures, folder } from "./report.mjs";
import { serve } from "./serve.mjs";

const PLAYGROUND = "playground.html";
const started = performance.now();
const seconds = () => ((performance.now() - started) / 1000).toFixed(0);

const { server, address } = await serve(folder);
const browser = await launch(CHROMIUM);
try {
  const withFigures = process.env.ONLY ? [process.env.ONLY] : await everyPage(browser, address, folder, fail);
  console.log(`figures on ${withFigures.length} pages (${seconds()} s so far)`);
  for (const name of withFigures) {
    await figures(browser, address, name);
    if (name === PLAYGROUND) await playground(browser, address, name);
    console.log(`${name}: figures (${seconds()} s so far)`);
  }
  await stills(browser, address);
  await card(browser, address, fail);
} catch (error) {
  fail("the test", error.stack);
} finally {
  await browser.close();
  server.close();
}
if (failures.length) {
  console.error(`\n${failures.length} failures, ${seconds()} s`);
  process.exit(1);
}
console.log(`all of it holds, ${seconds()} s`);
