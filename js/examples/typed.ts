// What a user's compiler sees of the engines beside the entries for them.
import * as CANNON from "cannon-es";
import * as ex from "excalibur";
import Matter from "matter-js";
import * as Phaser from "phaser";
import { Sprite } from "pixi.js";
import { BroadPhase } from "sweep-and-prune/broad-phase";
import { replaceBroadPhase as inCannon } from "sweep-and-prune/cannon-es";
import { replaceBroadPhase as inExcalibur } from "sweep-and-prune/excalibur";
import { replaceBroadPhase as inMatter } from "sweep-and-prune/matter-js";
import { replaceBroadPhase as inPhaser } from "sweep-and-prune/phaser";
import * as pixi from "sweep-and-prune/pixi";
import * as three from "sweep-and-prune/three";
import { Group, type Intersection, Mesh, type Object3D, Raycaster } from "three";

inMatter(Matter);
inMatter({ Bounds: Matter.Bounds, Collision: Matter.Collision, Detector: Matter.Detector });
inCannon(new CANNON.World({ broadphase: new CANNON.NaiveBroadphase() }));
inExcalibur(new ex.Scene(), ex);
const { BodyComponent, CollisionGroup, Pair } = ex;
inExcalibur(new ex.Engine().currentScene, { BodyComponent, CollisionGroup, Pair });
class Level extends Phaser.Scene {
  create(): void {
    inPhaser(this);
  }
}

const world = new BroadPhase({ dimensions: 3 });
const ids: Float64Array = three.insertObjects(world, [new Mesh(), new Group()], { category: 2 });
three.moveObjects(world);
const hit: Intersection<Object3D> | undefined = three.pick(world, new Raycaster(), (id) => id !== ids[0]);
const meshes = new BroadPhase<3, Mesh>({ dimensions: 3 });
three.insertObjects(meshes, [new Mesh()], [{ mask: 1 }]);
three.moveObjects(meshes);
const sprites = new BroadPhase<2, Sprite>({ dimensions: 2 });
pixi.insertObjects(sprites, [new Sprite()]);
pixi.moveObjects(sprites);
const sprite: Sprite | undefined = sprites.data(0);

// @ts-expect-error an engine is not the module
inMatter(Matter.Engine.create());
// @ts-expect-error a scene of another engine
inCannon(new ex.Scene());
// @ts-expect-error the module is missing
inExcalibur(new ex.Scene());
// @ts-expect-error a game is not a scene
inPhaser(new Phaser.Game());
// @ts-expect-error other dimensions
three.insertObjects(sprites, [new Mesh()]);
// @ts-expect-error not a mesh
three.insertObjects(meshes, [new Group()]);
// @ts-expect-error not a sprite
pixi.insertObjects(sprites, [new Mesh()]);
export default [hit, sprite, Level];
