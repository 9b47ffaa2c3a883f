// A page whose worker finds pairs: the boxes and the pairs are in memory that both share.
const boxes = new Float32Array(new SharedArrayBuffer(16 * 10_000)); // up to 10,000 boxes: minX, minY, maxX, maxY
const pairs = new Uint32Array(new SharedArrayBuffer(8 * 50_000)); // up to 50,000 pairs of indices

const worker = new Worker(new URL("./pairs-worker.js", import.meta.url), { type: "module" });
worker.postMessage({ boxes, pairs });

/** Finds the pairs of the first `count` boxes. Resolves to how many there are: until then, write no boxes and find no others. */
function find(count) {
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = ({ message }) => reject(new Error(message));
    worker.postMessage(count);
  });
}

async function frame() {
  boxes.set([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]);
  const count = await find(3);
  console.log(count, pairs.subarray(0, 2 * count).join()); // 1 0,2
}

frame();
