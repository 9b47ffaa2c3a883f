// A page that runs modules with the libraries of the examples.
import { once } from "node:events";
import { createServer } from "node:http";
import { basename } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

/** The libraries that the examples are used beside. */
const nodePaths = [fileURLToPath(new URL("../../examples/node_modules", import.meta.url))];
/**
 * esbuild does not copy the files that a module names: the inline entries carry them.
 *
 * @type {esbuild.Plugin}
 */
const inline = {
  name: "inline",
  setup({ onResolve, resolve }) {
    onResolve({ filter: /^sweep-and-prune(\/broad-phase)?$/ }, ({ path, ...how }) => resolve(`${path}/inline`, how));
  },
};

/**
 * A server of a page that runs the first of these modules; all of them are bundled with what they import.
 *
 * @param {string[]} modules
 */
export async function serve(modules) {
  const { outputFiles } = await esbuild.build({ entryPoints: modules, bundle: true, format: "esm", write: false, outdir: "/", plugins: [inline], nodePaths, logLevel: "error" });
  const files = new Map(outputFiles.map(({ path, contents }) => [path.slice(path.lastIndexOf("/")), contents]));
  const server = createServer((request, response) => {
    // A page with shared memory, which has a finer clock, too.
    const isolated = { "cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp" };
    const isPage = request.url === "/";
    response.writeHead(200, { "content-type": isPage ? "text/html" : "text/javascript", ...isolated });
    response.end(isPage ? `<!doctype html><script type="module" src="/${basename(modules[0] ?? "")}"></script>` : files.get(request.url ?? ""));
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  return { server, address: `http://127.0.0.1:${port}/` };
}
