import { init, PairFinder } from "sweep-and-prune";

export async function create({ dimensions }) {
  await init();
  const finder = new PairFinder({ dimensions, views: true });
  return { find: (rows) => finder.find(rows) };
}
