import { init, PairFinder } from "sweep-and-prune";

export async function create({ dimensions }) {
  await init();
  const finder = new PairFinder({ dimensions });
  return { find: (rows) => finder.find(rows) };
}
