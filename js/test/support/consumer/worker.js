import { countPairs, init } from "sweep-and-prune";

// Not `await` at the top: Vite builds workers as scripts unless told otherwise.
init().then(() => postMessage(countPairs(new Float32Array(20), { dimensions: 1 })));
