import { AABB, BroadPhase, Settings } from "planck";
import { Candidates } from "./candidates.js";
import { PairList } from "./pair-list.js";
import { isAtRest, meanWidth } from "./rows.js";

// The broad phase of its world. It reports a pair once for each of its boxes that is new or has
// left its fattened AABB.
export async function create({ isMoving, rows: first }) {
  const aabb = new AABB();
  const write = (rows, at) => {
    aabb.lowerBound.x = rows[at];
    aabb.lowerBound.y = rows[at + 1];
    aabb.upperBound.x = rows[at + 2];
    aabb.upperBound.y = rows[at + 3];
    return aabb;
  };
  if (!isMoving) return atRest(write);

  // Its margin is a tenth of a metre; what a metre is it has to be told: a box.
  Settings.aabbExtension = 0.1;
  Settings.lengthUnitsPerMeter = meanWidth(first, 2);
  const broadPhase = new BroadPhase();
  const candidates = new Candidates(2, first.length / 4);
  const add = (a, b) => candidates.add(a, b);
  const stay = (a, b) => broadPhase.testOverlap(proxies[a], proxies[b]);
  const proxies = [];
  for (let at = 0; at < first.length; at += 4) proxies.push(broadPhase.createProxy(write(first, at), proxies.length));
  broadPhase.updatePairs(add);
  const before = first.slice();
  const way = { x: 0, y: 0 };
  return {
    find(rows) {
      for (let i = 0, at = 0; i < proxies.length; i++, at += 4) {
        if (isAtRest(rows, before, at, 4)) continue;
        way.x = rows[at] - before[at];
        way.y = rows[at + 1] - before[at + 1];
        broadPhase.moveProxy(proxies[i], write(rows, at), way);
      }
      before.set(rows);
      broadPhase.updatePairs(add);
      candidates.keep(stay);
      return candidates.exact(rows);
    },
  };
}

function atRest(write) {
  const pairs = new PairList();
  Settings.aabbExtension = 0;
  return {
    find(rows) {
      const broadPhase = new BroadPhase();
      for (let at = 0; at < rows.length; at += 4) broadPhase.createProxy(write(rows, at), at / 4);
      pairs.clear();
      // Both boxes of a pair are new, so each is reported twice in the same way; the tree is asked
      // here as updatePairs asks it, and the half of the answers that repeat is left out.
      const { m_tree: tree } = broadPhase;
      let box = 0;
      const each = (proxy) => {
        const other = tree.getUserData(proxy);
        if (other > box) pairs.push(box, other);
        return true;
      };
      for (let at = 0; at < rows.length; at += 4, box++) tree.query(write(rows, at), each);
      return pairs.pairs;
    },
  };
}
