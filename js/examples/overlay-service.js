// A GeoJSON service: which parcels lie in which flood zones, sent as the pairs are found, no faster than the client reads.
import { once } from "node:events";
import { createServer, get } from "node:http";
import { pipeline } from "node:stream/promises";
import { init, PairFinder } from "sweep-and-prune";

await init();

/** A feature with a rectangle; yours are read from a file. */
const feature = (id, x, y, size) => ({
  type: "Feature",
  id,
  geometry: { type: "Polygon", coordinates: [[[x, y], [x + size, y], [x + size, y + size], [x, y + size], [x, y]]] },
});
const parcels = Array.from({ length: 40_000 }, (_, i) => feature(`parcel ${i}`, (i % 200) * 3, Math.floor(i / 200) * 3, 2));
const zones = Array.from({ length: 2_000 }, (_, i) => feature(`zone ${i}`, (i % 50) * 12, Math.floor(i / 50) * 15, 7));

/** The boxes of features, one row each. */
function boxesOf(features) {
  const boxes = new Float64Array(4 * features.length);
  features.forEach(({ geometry }, i) => {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (const [x, y] of geometry.coordinates.flat()) {
      box[0] = Math.min(box[0], x);
      box[1] = Math.min(box[1], y);
      box[2] = Math.max(box[2], x);
      box[3] = Math.max(box[3], y);
    }
    boxes.set(box, 4 * i);
  });
  return boxes;
}

const [parcelBoxes, zoneBoxes] = [boxesOf(parcels), boxesOf(zones)];
const finder = new PairFinder({ dimensions: 2 });

/** The pairs, a line of JSON for each, chunk by chunk. */
function* lines() {
  for (const pairs of finder.chunks(parcelBoxes, zoneBoxes)) {
    let text = "";
    for (let i = 0; i < pairs.length; i += 2) {
      // Boxes overlap; for polygons that are no rectangles, test here whether they do.
      text += JSON.stringify({ parcel: parcels[pairs[i]].id, zone: zones[pairs[i + 1]].id }) + "\n";
    }
    yield text;
  }
}

const server = createServer((request, response) => {
  response.writeHead(200, { "content-type": "application/x-ndjson" });
  // Waits until the client has read. If it goes away, the search ends, and so does this.
  pipeline(lines, response).catch(() => {});
});

server.listen(0, "127.0.0.1");
await once(server, "listening");
const [response] = await once(get({ port: server.address().port, host: "127.0.0.1" }), "response");
let body = "";
for await (const part of response) body += part;
server.close();

// As one search finds them.
console.log(body.trim().split("\n").length === finder.countBetween(parcelBoxes, zoneBoxes)); // true
console.log(body.includes('{"parcel":"parcel 0","zone":"zone 0"}')); // true
