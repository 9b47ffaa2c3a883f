"""A game loop: a hero, monsters, coins and walls, and what begins to touch what. It prints instead of drawing."""

import sweep_and_prune as sap

HERO, MONSTER, COIN, WALL = 1, 2, 4, 8

world = sap.BroadPhase(dimensions=2)
names: dict[int, str] = {}


def add(name: str, x: float, y: float, size: float, filter: sap.Filter) -> int:
    id = world.insert([x, y, x + size, y + size], filter)
    names[id] = name
    return id


# Coins and walls stand still. Only the hero can take coins, and monsters walk through each other.
hero = add("hero", 0, 0, 1, sap.Filter(HERO))
monsters = [add(f"monster {i}", 20 - 4 * i, 0, 1, sap.Filter(MONSTER, mask=HERO | WALL)) for i in range(2)]
for i in range(3):
    add(f"coin {i}", 3 + 3 * i, 0, 0.5, sap.Filter(COIN, mask=HERO, is_static=True))
add("wall", 14, -5, 2, sap.Filter(WALL, is_static=True))

score = 0
for frame in range(12):
    world.set(hero, [frame, 0, frame + 1, 1])
    for i, monster in enumerate(monsters):
        world.set(monster, [20 - 4 * i - frame, 0, 21 - 4 * i - frame, 1])
    begun, ended = world.update()
    for a, b in begun.tolist():
        print(f"frame {frame}: {names[a]} meets {names[b]}")
        if names[b].startswith("coin"):
            score += 1
            world.remove(b)
    for a, b in ended.tolist():
        if names[b].startswith("monster"):
            print(f"frame {frame}: {names[a]} got away from {names[b]}")
sight = world.ray_cast(origin=[12.5, 0.5], direction=[-1, 0], filter=sap.Filter(HERO, mask=MONSTER))
print(f"{score} coins; behind the hero: {names[sight.id] if sight else 'nothing'}")
