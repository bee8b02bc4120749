// Who answers the playground's questions: qrt in workers of the page, or qrt behind the page.
//
// Both take the calls of qrt_lab::playground, and give their answers.

import { decode } from "./answer.js";

/** A worker of the page; what it is asked, it does one after another. */
class PageWorker {
  constructor() {
    this.waiting = new Map();
    this.next = 0;
    this.start();
  }

  start() {
    this.worker = new Worker(new URL("playground-worker.js", import.meta.url), { type: "module" });
    this.worker.onmessage = ({ data: { id, answer, error } }) => {
      const { resolve, reject } = this.waiting.get(id) ?? {};
      this.waiting.delete(id);
      if (error) reject?.(new Error(error));
      else resolve?.(answer);
    };
    this.worker.onerror = (event) => this.fail(new Error(event.message ?? "a worker failed"));
  }

  fail(error) {
    for (const { reject } of this.waiting.values()) reject(error);
    this.waiting.clear();
  }

  call(name, numbers = [], text = "") {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, name, numbers, text });
    });
  }

  /** Ends what it is doing, if it does anything; it forgets its picture. */
  interrupt() {
    if (this.waiting.size === 0) return;
    this.worker.terminate();
    this.fail(new Interrupted());
    this.start();
  }
}

/** The same behind the page: `qrt playground` keeps a playground for each session. */
class ServedWorker {
  constructor() {
    this.session = crypto.randomUUID();
    this.last = Promise.resolve();
    this.current = new AbortController();
  }

  call(name, numbers = [], text = "") {
    const { signal } = this.current;
    const ask = async () => {
      if (signal.aborted) throw new Interrupted();
      const body = [this.session, name, numbers.join(" "), text].join("\n");
      const response = await fetch(new URL("../call", import.meta.url), { method: "POST", body, signal });
      if (!response.ok) throw new Error(`qrt playground answers ${response.status}`);
      const bytes = await response.arrayBuffer();
      const length = Number(new DataView(bytes).getBigUint64(0, true));
      const index = new Uint8Array(bytes, 8, length);
      return decode(index, new Float64Array(bytes, 8 + Math.ceil(length / 8) * 8));
    };
    const asked = this.last.then(ask, ask);
    this.last = asked.catch(() => {});
    return asked.catch((error) => {
      throw signal.aborted ? new Interrupted() : error;
    });
  }

  interrupt() {
    this.current.abort();
    this.current = new AbortController();
  }
}

/** What a call ends with that nobody waits for any more. */
export class Interrupted extends Error {}

/** So many who share the picture, one who checks, one who reckons costs and one who looks at pixels. */
export function engines(served) {
  const make = () => (served ? new ServedWorker() : new PageWorker());
  const cores = navigator.hardwareConcurrency || 2;
  const painters = Array.from({ length: Math.min(Math.max(cores, 1), 8) }, make);
  return { painters, checker: make(), reckoner: make(), looker: make() };
}
