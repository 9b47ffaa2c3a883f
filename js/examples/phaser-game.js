// A game in Phaser: which bullets hit which rocks. In a browser.
import * as Phaser from "phaser";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";

await init();

class Shooter extends Phaser.Scene {
  world = new BroadPhase({ dimensions: 2 });
  hits = 0;

  create() {
    for (let i = 0; i < 5; i++) this.track(this.add.rectangle(300, 40 * i, 30, 30), { category: 1, mask: 2 });
    this.bullets = [0, 1, 2].map((i) => this.track(this.add.rectangle(0, 40 * i, 4, 4), { category: 2, mask: 1 }));
  }

  /** Gives the object a body, and returns its id. */
  track(object, filter) {
    return this.world.insert(object.getBounds(), { ...filter, data: object });
  }

  update() {
    for (const id of this.bullets.filter((id) => this.world.contains(id))) {
      const bullet = this.world.data(id);
      const before = bullet.getBounds();
      bullet.x += 50; // more than its own size: its whole path counts
      this.world.setSwept(id, before, bullet.getBounds());
    }
    const { begun } = this.world.update();
    this.hits += begun.length / 2;
    for (const id of new Set(begun)) { // a set: a bullet that hits two rocks is in two pairs
      this.world.data(id).destroy();
      this.world.remove(id);
    }
    if (this.hits === this.bullets.length) {
      console.log(`${this.hits} hits, ${this.world.size} rocks left`); // 3 hits, 2 rocks left
      this.game.destroy(true);
    }
  }
}

new Phaser.Game({ type: Phaser.HEADLESS, width: 400, height: 200, scene: Shooter, banner: false });
