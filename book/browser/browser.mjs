// A browser without a window, driven through a pipe: nothing but Node's own modules.
//
// The protocol is the one of Chromium's developer tools. Messages are JSON, ended by a zero byte, on
// file descriptors 3 (to the browser) and 4 (from it).

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** Milliseconds until an answer is given up. */
const PATIENCE = 60_000;

export class Browser {
  static async start(command) {
    const profile = mkdtempSync(join(tmpdir(), "qrt-book-"));
    const options = [
      "--headless=new", "--remote-debugging-pipe", `--user-data-dir=${profile}`,
      "--no-first-run", "--no-default-browser-check", "--disable-background-networking",
      "--disable-component-update", "--disable-default-apps", "--disable-extensions",
      "--disable-sync", "--mute-audio", "--hide-scrollbars", "--disable-gpu",
    ];
    // Chromium's sandbox is not for the superuser, which is who tests run as in containers.
    if (process.getuid?.() === 0) options.push("--no-sandbox");
    const child = spawn(command, [...options, "about:blank"], { stdio: ["ignore", "ignore", "pipe", "pipe", "pipe"] });
    return new Browser(child, profile);
  }

  constructor(child, profile) {
    Object.assign(this, { child, profile, next: 1, waiting: new Map(), listeners: new Set() });
    this.said = "";
    child.stderr.on("data", (data) => (this.said = (this.said + data).slice(-4000)));
    this.ended = new Promise((resolve) => {
      child.on("exit", () => resolve(this.fail(new Error(`the browser ended\n${this.said}`))));
      child.on("error", (error) => resolve(this.fail(error)));
    });
    child.stdio[3].on("error", () => {});
    let rest = Buffer.alloc(0);
    child.stdio[4].on("data", (data) => {
      rest = Buffer.concat([rest, data]);
      for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1)) {
        this.take(JSON.parse(rest.subarray(0, end).toString()));
      }
    });
  }

  fail(error) {
    for (const { reject } of this.waiting.values()) reject(error);
    this.waiting.clear();
  }

  take({ id, result, error, method, params, sessionId }) {
    if (id === undefined) {
      for (const listener of [...this.listeners]) listener(method, params, sessionId);
      return;
    }
    const waiting = this.waiting.get(id);
    this.waiting.delete(id);
    if (error) waiting?.reject(new Error(`${waiting.method}: ${error.message}`));
    else waiting?.resolve(result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`${method}: no answer`)), PATIENCE);
      const done = (end) => (value) => (clearTimeout(timer), end(value));
      this.waiting.set(id, { method, resolve: done(resolve), reject: done(reject) });
      this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    });
  }

  /** A page of its own. */
  async page() {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, sessionId);
    for (const domain of ["Page", "Runtime", "Network", "Log"]) await page.send(`${domain}.enable`);
    return page;
  }

  async stop() {
    this.waiting.clear();
    this.send("Browser.close").catch(() => {});
    const timer = setTimeout(() => this.child.kill("SIGKILL"), 5000);
    await this.ended;
    clearTimeout(timer);
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

const KEYS = {
  Tab: [9], Enter: [13, "\r"], " ": [32, " "], ArrowLeft: [37], ArrowUp: [38], ArrowRight: [39],
  ArrowDown: [40], End: [35], Home: [36], Backspace: [8],
};

export class Page {
  constructor(browser, session) {
    Object.assign(this, { browser, session });
    /** What went wrong since the last visit. */
    this.complaints = [];
    /** Bytes by address, since the last visit. */
    this.loaded = new Map();
    this.requests = new Map();
    browser.listeners.add((method, params, sessionId) => {
      if (sessionId === session) this.notice(method, params);
    });
  }

  send(method, params) {
    return this.browser.send(method, params, this.session);
  }

  notice(method, params) {
    switch (method) {
      case "Runtime.exceptionThrown": {
        const { text, exception } = params.exceptionDetails;
        this.complaints.push(`exception: ${exception?.description ?? text}`);
        break;
      }
      case "Runtime.consoleAPICalled":
        if (["error", "warning", "assert"].includes(params.type)) {
          this.complaints.push(`console: ${params.args.map((a) => a.value ?? a.description).join(" ")}`);
        }
        break;
      case "Log.entryAdded":
        if (params.entry.level === "error") this.complaints.push(`log: ${params.entry.text} ${params.entry.url ?? ""}`);
        break;
      case "Network.requestWillBeSent": {
        const url = new URL(params.request.url);
        this.requests.set(params.requestId, url.href);
        const own = url.origin === this.origin || ["data:", "blob:", "about:"].includes(url.protocol);
        if (this.origin && !own) this.complaints.push(`a request to another host: ${url.href}`);
        break;
      }
      case "Network.responseReceived":
        if (params.response.status >= 400) this.complaints.push(`${params.response.status}: ${params.response.url}`);
        break;
      case "Network.loadingFinished":
        this.loaded.set(this.requests.get(params.requestId), params.encodedDataLength);
        break;
      case "Network.loadingFailed":
        if (!params.canceled) this.complaints.push(`failed: ${this.requests.get(params.requestId)} ${params.errorText}`);
        break;
      default:
    }
  }

  /** The value of an expression in the page. */
  async value(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", {
      expression, awaitPromise: true, returnByValue: true, userGesture: true,
    });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Calls a function in the page. */
  call(work, ...args) {
    return this.value(`(${work})(${args.map((arg) => JSON.stringify(arg)).join(",")})`);
  }

  /** Waits until a function in the page says yes; asks in vain for `patience` milliseconds at most. */
  async until(work, args = [], patience = 20_000) {
    for (const end = Date.now() + patience; ; ) {
      const found = await this.call(work, ...args);
      if (found) return found;
      if (Date.now() > end) throw new Error(`waited in vain: ${work} ${JSON.stringify(args)}`);
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }

  async size(width, height, mobile) {
    await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: mobile ? 2 : 1, mobile });
  }

  /** Opens an address, and waits until it and all that it asks for are there. */
  async visit(address) {
    this.origin = new URL(address).origin;
    this.complaints = [];
    this.loaded.clear();
    const there = new Promise((resolve) => {
      const listener = (method, _, sessionId) => {
        if (sessionId === this.session && method === "Page.loadEventFired") {
          this.browser.listeners.delete(listener);
          resolve();
        }
      };
      this.browser.listeners.add(listener);
    });
    const { errorText } = await this.send("Page.navigate", { url: address });
    if (errorText) throw new Error(`${address}: ${errorText}`);
    await there;
  }

  async key(name) {
    const [code, text] = KEYS[name] ?? [name.toUpperCase().charCodeAt(0), name];
    const event = { key: name, code: name === " " ? "Space" : name, windowsVirtualKeyCode: code };
    await this.send("Input.dispatchKeyEvent", { type: text ? "keyDown" : "rawKeyDown", text, ...event });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", ...event });
  }

  async picture(path, clip) {
    const { data } = await this.send("Page.captureScreenshot", { format: "png", clip, captureBeyondViewport: Boolean(clip) });
    const { writeFileSync } = await import("node:fs");
    writeFileSync(path, Buffer.from(data, "base64"));
  }
}
