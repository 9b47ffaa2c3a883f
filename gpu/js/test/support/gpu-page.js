// A page in headless Chromium whose WebGPU is SwiftShader, which computes in software.
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { chromium } from "playwright-core";

const flags = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"];

/**
 * A page that can import the built package from `/index.js` and fetch what `files` has by then, and what closes it.
 *
 * @param {{ hasGpu: boolean, files?: Map<string, Uint8Array> }} options
 */
export async function openPage({ hasGpu, files = new Map() }) {
  const server = createServer((request, response) => {
    const file = files.get(request.url ?? "");
    const isModule = request.url === "/index.js";
    response.writeHead(200, { "content-type": isModule ? "text/javascript" : "text/html" });
    if (isModule) response.end(readFileSync(new URL("../../dist/index.js", import.meta.url)));
    else response.end(file ?? "<!doctype html><title>Pairs</title>");
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-background-networking", "--disable-component-update", ...(hasGpu ? flags : ["--disable-gpu"])],
  });
  const page = await browser.newPage();
  await page.goto(`http://localhost:${port}/`);
  const close = async () => {
    await browser.close();
    server.close();
  };
  return { page, close };
}
