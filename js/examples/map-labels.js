// Labels on a map: the most important first, each only if it overlaps none that is already shown.
import { findPairs, init } from "sweep-and-prune";

await init();

const places = [
  { name: "Paris", x: 100, y: 100, rank: 1 },
  { name: "Versailles", x: 90, y: 106, rank: 3 },
  { name: "Saint-Denis", x: 103, y: 94, rank: 4 },
  { name: "Chartres", x: 40, y: 130, rank: 2 },
  { name: "Meaux", x: 160, y: 92, rank: 5 },
];
places.sort((a, b) => a.rank - b.rank);
const labels = places.map(({ name, x, y }) => ({ minX: x - 3 * name.length, minY: y - 7, maxX: x + 3 * name.length, maxY: y + 7 }));

const blockers = places.map(() => []);
const pairs = findPairs(labels, { dimensions: 2 }); // indices
for (let i = 0; i < pairs.length; i += 2) blockers[pairs[i + 1]].push(pairs[i]); // the smaller index, which is first, is more important

const shown = [];
for (let i = 0; i < places.length; i++) shown[i] = blockers[i].every((other) => !shown[other]);
console.log(places.filter((_, i) => shown[i]).map(({ name }) => name).join(", ")); // Paris, Chartres, Meaux
