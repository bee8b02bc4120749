// A folder over HTTP, on this machine alone.

import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";

const KINDS = {
  ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css",
  ".svg": "image/svg+xml", ".png": "image/png", ".woff2": "font/woff2", ".wasm": "application/wasm",
  ".json": "application/json",
};

/** Serves `folder`; gives the server and its address. */
export async function serve(folder) {
  const server = createServer(async (request, response) => {
    const { pathname } = new URL(request.url, "http://localhost");
    // Browsers ask for it by themselves where a page names no icon.
    if (pathname === "/favicon.ico") return response.writeHead(204).end();
    const path = normalize(decodeURIComponent(pathname.endsWith("/") ? `${pathname}index.html` : pathname));
    try {
      const content = await readFile(join(folder, path));
      const kind = KINDS[extname(path)] ?? "application/octet-stream";
      // A page's parts are those of the others: style sheets, scripts and fonts.
      response.writeHead(200, { "Content-Type": kind, "Cache-Control": kind.startsWith("text/html") ? "no-store" : "max-age=600" });
      response.end(content);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { server, address: `http://127.0.0.1:${server.address().port}` };
}
