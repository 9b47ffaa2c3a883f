// Phaser with another broad phase for overlaps of groups: one line to switch, and the same hits. In a browser.
import * as Phaser from "phaser";
import { init } from "sweep-and-prune";
import { replaceBroadPhase } from "sweep-and-prune/phaser";

await init();

/** The hits of each of 60 steps, in which 300 bullets fly through 2,000 rocks. */
function fly(isReplaced) {
  return new Promise((done) => {
    class Level extends Phaser.Scene {
      create() {
        if (isReplaced) replaceBroadPhase(this); // the line to switch
        const bullets = this.physics.add.group();
        const rocks = this.physics.add.group();
        const add = (group, x, y, size) => group.add(this.add.rectangle(x, y, size, size).setName(`${group === rocks ? "rock" : "bullet"} ${group.getLength()}`));
        for (let i = 0; i < 300; i++) add(bullets, (i * 37) % 800, (i * 53) % 600, 4);
        for (let i = 0; i < 2000; i++) add(rocks, (i * 61) % 800, (i * 83) % 600, 4 + (i % 9));
        bullets.getChildren().forEach(({ body }, i) => body.setVelocity((i % 41) * 10 - 200, (i % 31) * 10 - 150));
        rocks.getChildren().forEach(({ body }, i) => i % 5 === 0 && body.setCircle(body.halfWidth));

        let hits = [];
        this.physics.add.overlap(bullets, rocks, (bullet, rock) => hits.push(`${bullet.name} hits ${rock.name}`));
        const steps = [];
        for (let step = 0; step < 60; step++) {
          this.physics.world.singleStep();
          steps.push(hits.sort());
          hits = [];
        }
        done(steps);
        this.game.destroy(true);
      }
    }
    new Phaser.Game({ type: Phaser.HEADLESS, width: 800, height: 600, scene: Level, physics: { default: "arcade" }, banner: false });
  });
}

const own = await fly(false);
const other = await fly(true);
console.log(own.flat().length > 9_000, own.join() === other.join()); // true true
