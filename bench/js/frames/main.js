// Whole frames of four programs, with this package, with rbush, with flatbush, and by hand:
//
//   node bench/js/frames/main.js [SCENE...]
import { init } from "sweep-and-prune";
import { init as initBroadPhase } from "sweep-and-prune/broad-phase";
import { measure } from "./measure.js";
import { scenes } from "./scenes.js";

await Promise.all([init(), initBroadPhase()]);
const wanted = process.argv.slice(2);
for (const [name, scene] of Object.entries(scenes)) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  const { found, forms } = measure(scene);
  const least = Math.min(...forms.map(({ ms }) => ms));
  console.log(`${name}: ${found.toFixed(0)} found in a frame`);
  for (const { name, ms } of forms) console.log(`  ${name}: ${ms.toFixed(2)} ms (${(ms / least).toFixed(2)})`);
}
