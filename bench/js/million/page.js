// Draws some of the boxes that the worker moves, sixty times a second if nothing keeps it, and
// writes down when each frame was.
const canvas = document.querySelector("canvas");
const context = canvas.getContext("2d");
let shown = new Float32Array(0);
const record = { frames: [], updates: [], ready: false, failed: "" };
window.record = record;

const question = new URLSearchParams(location.search);
const worker = new Worker("/million/worker.js", { type: "module" });
worker.postMessage(Object.fromEntries(question));
worker.addEventListener("message", ({ data }) => {
  if (data.failed) record.failed = data.failed;
  record.ready = true;
  record.updates.push({ at: performance.now(), ...data.update });
  shown = data.shown;
});
worker.addEventListener("error", ({ message }) => (record.failed = message || "the worker did not start"));

function frame(now) {
  record.frames.push(now);
  context.clearRect(0, 0, 600, 600);
  const width = Number(question.get("dimensions")) * 2;
  for (let at = 0; at < shown.length; at += width) context.fillRect(600 * shown[at], 600 * shown[at + 1], 2, 2);
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);
