// Next's edge runtime, which compiles no bytes: it takes the module that `?module` imports.
import wasm from "../../node_modules/sweep-and-prune/dist/sweep-and-prune.simd.wasm?module";
import { countPairs, init } from "sweep-and-prune";

export const runtime = "edge";

export async function GET() {
  await init({ wasm, simd: true });
  return Response.json({ pairs: countPairs([0, 1, 1, 2], { dimensions: 1 }) });
}
