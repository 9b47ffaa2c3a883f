// Which meshes of a scene overlap, by their boxes in world coordinates.
import { Box3, BoxGeometry, Mesh, Scene } from "three";
import { findPairs, init } from "sweep-and-prune";

await init();

const scene = new Scene();
const geometry = new BoxGeometry(1, 1, 1);
for (const x of [0, 0.9, 5]) {
  const mesh = new Mesh(geometry);
  mesh.name = `crate at ${x}`;
  mesh.position.x = x;
  scene.add(mesh);
}
scene.updateMatrixWorld();

const box = new Box3();
const corners = scene.children.flatMap((mesh) => {
  box.setFromObject(mesh);
  return [...box.min, ...box.max]; // minX, minY, minZ, maxX, maxY, maxZ
});
const pairs = findPairs(new Float32Array(corners), { dimensions: 3 });
for (let i = 0; i < pairs.length; i += 2) {
  const [a, b] = [scene.children[pairs[i]], scene.children[pairs[i + 1]]];
  console.log(`${a.name} meets ${b.name}`); // crate at 0 meets crate at 0.9
}

// findPairs takes a Box3 too: simpler, and slower.
console.log(findPairs(scene.children.map((mesh) => new Box3().setFromObject(mesh)), { dimensions: 3 }).join()); // 0,1
