// A thread of Node that finds pairs: the boxes and the pairs are in memory that both threads share.
import { once } from "node:events";
import { isMainThread, parentPort, Worker, workerData } from "node:worker_threads";
import { init, PairFinder } from "sweep-and-prune";

if (isMainThread) {
  const boxes = new Float32Array(new SharedArrayBuffer(16 * 10_000)); // up to 10,000 boxes: minX, minY, maxX, maxY
  const pairs = new Uint32Array(new SharedArrayBuffer(8 * 50_000)); // up to 50,000 pairs of indices
  const worker = new Worker(new URL(import.meta.url), { workerData: { boxes, pairs } });

  /** Finds the pairs of the first `count` boxes. Resolves to how many there are: until then, write no boxes and find no others. */
  const find = async (count) => {
    worker.postMessage(count);
    const [found] = await once(worker, "message"); // rejects if the thread fails
    return found;
  };

  boxes.set([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]);
  const count = await find(3);
  console.log(count, pairs.subarray(0, 2 * count).join()); // 1 0,2
  await worker.terminate();
} else {
  await init(); // in each thread
  const finder = new PairFinder({ dimensions: 2 });
  const { boxes, pairs } = workerData;
  parentPort.on("message", (count) => parentPort.postMessage(finder.findInto(boxes.subarray(0, 4 * count), pairs)));
}
