// Picking in three.js: which of 5,000 moving meshes is under the pointer.
import { Box3, Mesh, Raycaster, Scene, SphereGeometry, Vector3 } from "three";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";

await init();

const scene = new Scene();
const geometry = new SphereGeometry(0.5, 8, 6);
geometry.computeBoundingBox();
const meshes = Array.from({ length: 5000 }, (_, i) => {
  const mesh = new Mesh(geometry);
  mesh.position.set(i % 20, Math.floor(i / 20) % 25, Math.floor(i / 500)).multiplyScalar(1.5);
  scene.add(mesh);
  return mesh;
});

const world = new BroadPhase({ dimensions: 3 });
const boxes = new Float32Array(6 * meshes.length);
const ids = world.insertMany(boxes, {}, meshes);
const box = new Box3();

/** Takes over where the meshes are: once a frame, before anything is asked. */
function moveBodies() {
  scene.updateMatrixWorld();
  meshes.forEach((mesh, i) => {
    box.copy(mesh.geometry.boundingBox).applyMatrix4(mesh.matrixWorld);
    box.min.toArray(boxes, 6 * i);
    box.max.toArray(boxes, 6 * i + 3);
  });
  world.setMany(ids, boxes);
}

/** The first mesh that a ray hits. Boxes come nearest first; a ray can hit a box and miss the mesh in it. */
function pick(raycaster) {
  let first;
  for (const { id, t } of world.rayCastAll(raycaster.ray.origin, raycaster.ray.direction)) {
    if (first && first.distance < t) break; // all other meshes are behind it
    const [hit] = raycaster.intersectObject(world.data(id));
    if (hit && !(hit.distance >= first?.distance)) first = hit;
  }
  return first;
}

// As three.js finds it among all meshes.
let [picked, same] = [0, 0];
for (let frame = 0; frame < 20; frame++) {
  meshes.forEach((mesh, i) => mesh.position.setZ(mesh.position.z + Math.sin(i + frame)));
  moveBodies();
  const raycaster = new Raycaster(new Vector3(14, 18, -50), new Vector3(Math.sin(frame) / 5, Math.cos(3 * frame) / 5, 1).normalize());
  const [hit, expected] = [pick(raycaster), raycaster.intersectObjects(meshes)[0]];
  if (hit) picked++;
  if (hit?.object === expected?.object) same++;
}
console.log(picked > 10, same); // true 20
