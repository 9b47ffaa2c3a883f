// Worlds of each engine, with its own broad phase and with another.
import * as CANNON from "cannon-es";
import * as ex from "excalibur";
import Matter from "matter-js";
import * as Phaser from "phaser";
import { init } from "sweep-and-prune";
import { init as initBroadPhase } from "sweep-and-prune/broad-phase";
import * as forCannon from "sweep-and-prune/cannon-es";
import * as forExcalibur from "sweep-and-prune/excalibur";
import * as forMatter from "sweep-and-prune/matter-js";
import * as forPhaser from "sweep-and-prune/phaser";
import { random } from "../../test/support/boxes.js";

await Promise.all([init(), initBroadPhase()]);

const own = Matter.Detector.collisions;
forMatter.replaceBroadPhase(Matter);
const replaced = Matter.Detector.collisions;

const MS = 1000 / 60;

/**
 * By engine: the names of its broad phases, its own first, its scenes if not a gas and a pile, and how a world of one is made: a
 * function that does a step and returns the number of contacts.
 */
export const engines = {
  matter: {
    broadPhases: ["its own", "sweep-and-prune"],
    create(scene, count, broadPhase) {
      const engine = Matter.Engine.create({ gravity: { y: scene === "pile" ? 1 : 0 } });
      const next = random(count);
      const side = 30 * Math.sqrt(count);
      const wall = (x, y, width, height) => Matter.Bodies.rectangle(x, y, width, height, { isStatic: true, restitution: 1 });
      const walls = [wall(side / 2, -50, side + 200, 100), wall(side / 2, side + 50, side + 200, 100), wall(-50, side / 2, 100, side), wall(side + 50, side / 2, 100, side)];
      const flies = scene === "gas";
      const bodies = Array.from({ length: count }, () => {
        const body = Matter.Bodies.circle(next() * side, next() * side, flies ? 5 : 10, flies ? { restitution: 1, friction: 0, frictionAir: 0, slop: 0 } : {});
        if (flies) Matter.Body.setVelocity(body, { x: 6 * next() - 3, y: 6 * next() - 3 });
        return body;
      });
      Matter.Composite.add(engine.world, [...walls, ...bodies]);
      return () => {
        Matter.Detector.collisions = broadPhase === "its own" ? own : replaced;
        Matter.Engine.update(engine, MS);
        return engine.pairs.collisionActive.length + engine.pairs.collisionStart.length;
      };
    },
  },
  cannon: {
    broadPhases: ["its sweep", "its default", "sweep-and-prune"],
    create(scene, count, broadPhase) {
      const flies = scene === "gas";
      const world = new CANNON.World({ gravity: new CANNON.Vec3(0, flies ? 0 : -9.82, 0) });
      if (broadPhase === "its sweep") world.broadphase = new CANNON.SAPBroadphase(world);
      if (broadPhase === "sweep-and-prune") forCannon.replaceBroadPhase(world);
      world.solver.iterations = 5;
      const next = random(count);
      const side = (flies ? 4 : 2.5) * Math.cbrt(count);
      const wall = (axis, sign) => {
        const body = new CANNON.Body({ mass: 0, shape: new CANNON.Plane() });
        if (axis === "x") body.quaternion.setFromEuler(0, sign > 0 ? Math.PI / 2 : -Math.PI / 2, 0);
        if (axis === "y") body.quaternion.setFromEuler(sign > 0 ? -Math.PI / 2 : Math.PI / 2, 0, 0);
        if (axis === "z" && sign < 0) body.quaternion.setFromEuler(Math.PI, 0, 0);
        body.position[axis] = sign > 0 ? 0 : side;
        world.addBody(body);
      };
      for (const axis of ["x", "y", "z"]) for (const sign of [1, -1]) wall(axis, sign);
      for (let i = 0; i < count; i++) {
        const position = new CANNON.Vec3(next() * side, next() * side, next() * side);
        const body = new CANNON.Body({ mass: 1, shape: new CANNON.Sphere(0.5 + 0.3 * next()), linearDamping: flies ? 0 : 0.01, position });
        if (flies) body.velocity.set(20 * next() - 10, 20 * next() - 10, 20 * next() - 10);
        world.addBody(body);
      }
      return () => {
        world.step(1 / 60);
        return world.contacts.length;
      };
    },
  },
  excalibur: {
    broadPhases: ["its own", "sweep-and-prune"],
    async create(scene, count, broadPhase) {
      const flies = scene === "gas";
      const engine = new ex.Engine({
        width: 400, height: 300, suppressPlayButton: true, suppressConsoleBootMessage: true,
        physics: { solver: flies ? ex.SolverStrategy.Arcade : ex.SolverStrategy.Realistic, gravity: ex.vec(0, flies ? 0 : 500) },
      });
      await engine.start();
      engine.clock.stop();
      const world = engine.currentScene;
      if (broadPhase !== "its own") forExcalibur.replaceBroadPhase(world, ex);
      const next = random(count);
      const side = 30 * Math.sqrt(count);
      const wall = (x, y, width, height) => world.add(new ex.Actor({ x, y, width, height, collisionType: ex.CollisionType.Fixed }));
      wall(side / 2, -50, side + 200, 100), wall(side / 2, side + 50, side + 200, 100), wall(-50, side / 2, 100, side), wall(side + 50, side / 2, 100, side);
      for (let i = 0; i < count; i++) {
        const vel = flies ? ex.vec(400 * next() - 200, 400 * next() - 200) : ex.vec(0, 0);
        // What flies is told of contacts and goes on, as bullets and triggers do.
        world.add(new ex.Actor({ x: next() * side, y: next() * side, radius: 10, vel, collisionType: flies ? ex.CollisionType.Passive : ex.CollisionType.Active }));
      }
      let contacts = 0;
      const processor = world.physics.collisionProcessor;
      const narrowphase = processor.narrowphase.bind(processor);
      processor.narrowphase = (pairs, stats) => {
        const found = narrowphase(pairs, stats);
        contacts = found.length;
        return found;
      };
      return () => {
        contacts = 0;
        world.world.update(ex.SystemType.Update, MS);
        return contacts;
      };
    },
  },
  phaser: {
    broadPhases: ["its own", "its own without a tree", "sweep-and-prune", "sweep-and-prune without a tree"],
    // Arcade physics does not stack bodies.
    scenes: ["gas"],
    create: (_scene, count, broadPhase) =>
      new Promise((created) => {
        const side = 30 * Math.sqrt(count);
        class Level extends Phaser.Scene {
          create() {
            if (broadPhase.startsWith("sweep-and-prune")) forPhaser.replaceBroadPhase(this);
            const { world } = this.physics;
            world.setBounds(0, 0, side, side);
            const next = random(count);
            const [bullets, rocks] = [this.physics.add.group(), this.physics.add.group()];
            const add = (group, size, speed) => {
              const sprite = this.add.rectangle(next() * side, next() * side, size, size);
              group.add(sprite);
              sprite.body.setCollideWorldBounds(true, 1, 1).setVelocity(2 * speed * next() - speed, 2 * speed * next() - speed);
            };
            // One of eleven is a bullet.
            for (let i = 0; i < count; i++) add(...(i % 11 === 0 ? [bullets, 6, 400] : [rocks, 20, 100]));
            let contacts = 0;
            this.physics.add.overlap(bullets, rocks, () => contacts++);
            // The game itself makes no steps.
            this.scene.pause();
            created(() => {
              contacts = 0;
              world.singleStep();
              return contacts;
            });
          }
        }
        const arcade = { useTree: !broadPhase.endsWith("without a tree") };
        new Phaser.Game({ type: Phaser.HEADLESS, width: 800, height: 600, scene: Level, physics: { default: "arcade", arcade }, banner: false });
      }),
  },
};
