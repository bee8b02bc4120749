// A worker with a playground of its own, compiled to WebAssembly: see book/widgets/playground.

import { decode } from "./answer.js";

const module = fetch(new URL("qrt_playground.wasm", import.meta.url)).then(async (response) => {
  if (!response.ok) throw new Error(`its program is not there (${response.status})`);
  const { exports } = await WebAssembly.instantiate(await response.arrayBuffer()).then(({ instance }) => instance);
  return exports;
});
// Who calls is told; nobody else waits for it.
module.catch(() => {});

const encoder = new TextEncoder();

function call(exports, name, numbers, text) {
  const bytes = encoder.encode(`${name}\n${text}`);
  // Room is asked for first: it may move the memory.
  const input = exports.qrt_input(bytes.length);
  const given = exports.qrt_arguments(numbers.length);
  new Uint8Array(exports.memory.buffer, input, bytes.length).set(bytes);
  new Float64Array(exports.memory.buffer, given, numbers.length).set(numbers);
  exports.qrt_call();
  const { buffer } = exports.memory;
  const index = new Uint8Array(buffer, exports.qrt_index(), exports.qrt_index_length());
  return decode(index, new Float64Array(buffer, exports.qrt_numbers(), exports.qrt_numbers_length()));
}

self.onmessage = async ({ data: { id, name, numbers, text } }) => {
  try {
    self.postMessage({ id, answer: call(await module, name, numbers, text) });
  } catch (error) {
    self.postMessage({ id, error: String(error?.message ?? error) });
  }
};
