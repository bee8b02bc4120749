// qrt, compiled to WebAssembly: calls and their answers. See book/widgets/src/boundary.rs.

import { decode } from "./answer.js";

const compiled = new Map();

/** An instance of its own for a figure of that name: a function `call(name, arguments, text)`. */
export async function instance(figure) {
  if (!compiled.has(figure)) compiled.set(figure, compile(figure));
  const { exports } = await WebAssembly.instantiate(await compiled.get(figure));
  const bytes = (start, length) => new Uint8Array(exports.memory.buffer, start, length);

  /** Calls the export `qrt_<name>`; `text` is what it reads, if it reads one. */
  return function call(name, args = [], text = null) {
    if (text !== null) {
      const encoded = new TextEncoder().encode(text);
      bytes(exports.qrt_input(encoded.length), encoded.length).set(encoded);
    }
    exports[`qrt_${name}`](...args);
    const index = bytes(exports.qrt_index(), exports.qrt_index_length());
    const numbers = new Float64Array(
      exports.memory.buffer,
      exports.qrt_numbers(),
      exports.qrt_numbers_length(),
    );
    return decode(index, numbers);
  };
}

async function compile(figure) {
  const response = await fetch(new URL(`qrt_${figure}.wasm`, import.meta.url));
  if (!response.ok) throw new Error(`its program is not there (${response.status})`);
  if (response.headers.get("Content-Type") === "application/wasm") {
    return WebAssembly.compileStreaming(response);
  }
  return WebAssembly.compile(await response.arrayBuffer());
}
