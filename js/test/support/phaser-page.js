// Phaser's arcade physics with another broad phase, beside its own in a scene in which the same happens.
import * as Phaser from "phaser";
import { init } from "sweep-and-prune";
import { replaceBroadPhase } from "sweep-and-prune/phaser";
import { random } from "./boxes.js";

await init();

let seen = 0;

/** The hits of each step, in which anything changes. What an overlap calls back is told, but decides nothing: the order of hits differs. */
function play(isReplaced, useTree) {
  return new Promise((done) => {
    class Level extends Phaser.Scene {
      create() {
        if (isReplaced) replaceBroadPhase(this);
        const next = random(5);
        const below = (limit) => Math.floor(next() * limit);
        const { physics } = this;
        const groups = { bullets: physics.add.group(), rocks: physics.add.group(), coins: physics.add.group(), walls: physics.add.staticGroup() };
        let made = 0;
        const add = (name) => {
          const object = this.add.rectangle(below(400), below(300), 2 + below(20), 2 + below(20)).setName(`${name} ${made++}`);
          groups[name].add(object);
          if (name === "walls") return;
          object.body.setVelocity(below(200) - 100, below(200) - 100);
          if (below(3) === 0) object.body.setCircle(object.body.halfWidth);
        };
        for (const [name, count] of Object.entries({ bullets: 80, rocks: 150, coins: 40, walls: 40 })) for (let i = 0; i < count; i++) add(name);

        groups.coins.collisionMask = 2; // the group could not meet itself, but some of its bodies can
        groups.coins.getChildren().forEach(({ body }, i) => body.setCollisionCategory(1 + (i % 2)).setCollidesWith([1, 2]));

        let hits = [];
        const note = (what) => (a, b) => hits.push(`${what}: ${a.name} ${b.name}`);
        const context = { name: "the context" };
        physics.add.overlap(groups.bullets, groups.rocks, note("rocks"));
        physics.add.overlap(groups.bullets, groups.walls, note("walls"));
        physics.add.overlap(groups.rocks, groups.rocks, note("among rocks"));
        physics.add.overlap(groups.coins, groups.coins, note("among coins"));
        physics.add.overlap(groups.rocks, undefined, note("each two rocks once"));
        physics.add.overlap(groups.bullets, this.add.group(groups.rocks.getChildren().slice(0, 20)), note("a group without physics"));
        physics.add.overlap(groups.bullets, groups.bullets, function (a, b) { note(this.name)(a, b); }, (a) => Number(a.name.split(" ")[1]) % 2 === 0, context);
        physics.add.overlap(this.add.rectangle(200, 150, 100, 100).setName("a sprite"), groups.rocks, note("nothing: it has no body"));

        const steps = [];
        const any = (name) => groups[name].getChildren()[below(groups[name].getLength())];
        const changes = {
          add: () => add(["bullets", "rocks", "walls"][below(3)]),
          destroy: () => any("rocks").destroy(),
          disable: () => (any("rocks").body.enable = below(2) === 0),
          untouchable: () => (any("bullets").body.checkCollision.none = below(2) === 0),
          category: () => any("bullets").body.setCollisionCategory(1 + below(3)),
          mask: () => any("rocks").body.setCollidesWith([1, 2]),
          jump: () => any("bullets").body.reset(below(400), below(300)),
          leave: () => groups.rocks.remove(any("rocks")),
        };
        for (let step = 0; step < 150; step++) {
          for (let i = 0; i < 3; i++) Object.values(changes)[below(8)]();
          physics.world.singleStep();
          const flags = groups.bullets.getChildren().map(({ body }) => [body.embedded, body.touching.none].join());
          const isAny = physics.overlap(groups.bullets, groups.walls);
          steps.push([...hits.sort(), ...flags, String(isAny)]);
          seen += hits.length;
          hits = [];
        }

        // What a callback destroys, or takes out of its group, is hit no more.
        for (const name of ["bullets", "rocks"]) for (const { body } of groups[name].getChildren()) body.reset(200 + below(30), 150 + below(30));
        const gone = new Set();
        let late = 0;
        physics.add.overlap(groups.bullets, groups.rocks, (bullet, rock) => {
          if (gone.has(bullet) || gone.has(rock)) late++;
          gone.add(rock);
          if (gone.size % 2) rock.destroy();
          else {
            groups.rocks.remove(rock);
            rock.body.enable = true; // as if it were in another group now
          }
          if (gone.size % 3 === 0) gone.add(bullet) && bullet.destroy();
        });
        physics.world.singleStep();
        done({ steps, gone: gone.size, late });
        this.game.destroy(true);
      }
    }
    new Phaser.Game({ type: Phaser.HEADLESS, scene: Level, physics: { default: "arcade", arcade: { useTree } }, banner: false });
  });
}

const own = await play(false, true);
const differences = [];
const results = [];
for (const useTree of [true, false]) {
  const other = await play(true, useTree);
  results.push(other);
  other.steps.forEach((hits, at) => JSON.stringify(hits) === JSON.stringify(own.steps[at]) || differences.push(`step ${at}: ${hits.filter((hit) => !own.steps[at].includes(hit)).slice(0, 3)} instead of ${own.steps[at].filter((hit) => !hits.includes(hit)).slice(0, 3)}`));
}
globalThis.result = { differences: differences.slice(0, 5), steps: own.steps.length, gone: results.map(({ gone }) => gone), late: results.map(({ late }) => late), hits: seen };
