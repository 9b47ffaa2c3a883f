import Flatbush from "flatbush";
import { RBush3D } from "rbush-3d";
import { PairFinder } from "sweep-and-prune";
import { BroadPhase } from "sweep-and-prune/broad-phase";
import { insertObjects, moveObjects } from "sweep-and-prune/three";
import { Box3, Mesh, Scene, SphereGeometry } from "three";
import { random } from "../../../js/test/support/boxes.js";
import { keysOf, keysOfWorld } from "./keys.js";

/** @typedef {import("./measure.js").Form} Form */

/** 5,000 meshes that move: which boxes overlap? With the matrices that a renderer needs anyway. */
export function meshes() {
  const COUNT = 5000;

  function createMeshes() {
    const next = random(1);
    const [scene, geometry] = [new Scene(), new SphereGeometry(0.5, 8, 6)];
    geometry.computeBoundingBox();
    const all = Array.from({ length: COUNT }, () => {
      const mesh = new Mesh(geometry);
      mesh.position.set(next(), next(), next()).multiplyScalar(25);
      scene.add(mesh);
      return mesh;
    });
    scene.updateMatrixWorld();
    const move = (/** @type {number} */ step) => {
      all.forEach((mesh, at) => mesh.position.set(mesh.position.x + Math.sin(at + step / 9) / 20, mesh.position.y + Math.cos(at + step / 7) / 20, mesh.position.z));
      scene.updateMatrixWorld();
    };
    const [box, rows] = [new Box3(), new Float64Array(6 * COUNT)];
    /** The boxes of the meshes, as rows. */
    const boxes = () => {
      all.forEach((mesh, at) => {
        const { min, max } = box.copy(/** @type {Box3} */ (geometry.boundingBox)).applyMatrix4(mesh.matrixWorld);
        min.toArray(rows, 6 * at);
        max.toArray(rows, 6 * at + 3);
      });
      return rows;
    };
    return { all, boxes, move };
  }
  const apart = (/** @type {Float64Array} */ rows, /** @type {number} */ a, /** @type {number} */ b, /** @type {number} */ axis) =>
    rows[6 * a + axis] > rows[6 * b + 3 + axis] || rows[6 * b + axis] > rows[6 * a + 3 + axis];

  /** A form that finds pairs in rows. @type {(find: (rows: Float64Array) => ArrayLike<number>) => Form} */
  const form = (find) => {
    const { boxes, move } = createMeshes();
    /** @type {ArrayLike<number>} */
    let pairs = [];
    return { frame: (step) => (move(step), (pairs = find(boxes()))), found: () => keysOf(pairs) };
  };

  /** @type {Record<string, () => Form>} */
  const forms = {
    "BroadPhase, which reports events": () => {
      const { all, move } = createMeshes();
      const world = new BroadPhase({ dimensions: 3, precision: "double" });
      insertObjects(world, all);
      return { frame: (step) => (move(step), moveObjects(world), world.update()), found: () => keysOfWorld(world) };
    },
    PairFinder: () => {
      const finder = new PairFinder({ dimensions: 3 });
      return form((rows) => finder.find(rows));
    },
    "rbush-3d": () => {
      const tree = new RBush3D();
      const items = Array.from({ length: COUNT }, (_, at) => ({ minX: 0.5, minY: 0.5, minZ: 0.5, maxX: 0.5, maxY: 0.5, maxZ: 0.5, at }));
      return form((rows) => {
        for (const item of items) [item.minX, item.minY, item.minZ, item.maxX, item.maxY, item.maxZ] = rows.subarray(6 * item.at);
        tree.clear();
        tree.load(items);
        const pairs = [];
        for (const item of items) for (const { at } of /** @type {typeof items} */ (tree.search(item))) if (at > item.at) pairs.push(item.at, at);
        return pairs;
      });
    },
    "flatbush, and z by hand": () =>
      form((rows) => {
        const index = new Flatbush(COUNT);
        for (let at = 0; at < rows.length; at += 6) index.add(rows[at], rows[at + 1], rows[at + 3], rows[at + 4]);
        index.finish();
        /** @type {number[]} */
        const pairs = [];
        for (let a = 0; a < COUNT; a++) {
          index.search(rows[6 * a], rows[6 * a + 1], rows[6 * a + 3], rows[6 * a + 4], (b) => {
            if (b > a && !apart(rows, a, b, 2)) pairs.push(a, b);
            return false;
          });
        }
        return pairs;
      }),
    "two loops": () =>
      form((rows) => {
        const pairs = [];
        for (let a = 0; a < COUNT; a++) for (let b = a + 1; b < COUNT; b++) if (!apart(rows, a, b, 0) && !apart(rows, a, b, 1) && !apart(rows, a, b, 2)) pairs.push(a, b);
        return pairs;
      }),
  };
  return forms;
}
