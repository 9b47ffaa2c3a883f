// Picking in three.js: which of 5,000 moving meshes is under the pointer.
import { Mesh, Raycaster, Scene, SphereGeometry, Vector3 } from "three";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";
import { insertObjects, moveObjects, pick } from "sweep-and-prune/three";

await init();

const scene = new Scene();
const geometry = new SphereGeometry(0.5, 8, 6);
const meshes = Array.from({ length: 5000 }, (_, i) => {
  const mesh = new Mesh(geometry);
  mesh.position.set(i % 20, Math.floor(i / 20) % 25, Math.floor(i / 500)).multiplyScalar(1.5);
  scene.add(mesh);
  return mesh;
});

const world = new BroadPhase({ dimensions: 3 });
insertObjects(world, meshes);

// As three.js finds it among all meshes.
let [picked, same] = [0, 0];
for (let frame = 0; frame < 20; frame++) {
  meshes.forEach((mesh, i) => mesh.position.setZ(mesh.position.z + Math.sin(i + frame)));
  moveObjects(world); // once a frame, before anything is asked
  const raycaster = new Raycaster(new Vector3(14, 18, -50), new Vector3(Math.sin(frame) / 5, Math.cos(3 * frame) / 5, 1).normalize());
  const [hit, expected] = [pick(world, raycaster), raycaster.intersectObjects(meshes)[0]];
  if (hit) picked++;
  if (hit?.object === expected?.object) same++;
}
console.log(picked > 10, same); // true 20
