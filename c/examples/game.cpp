// A hero runs into a wall: which overlaps begin and end, what a ray hits, and what an error looks like.
#include <cstdio>
#include <sweep_and_prune.hpp>

int main() {
    sap::world2f world;
    const sap::id hero = world.insert({{0, 0}, {1, 2}});
    const sap::id wall = world.insert({{5, -9}, {6, 9}}, sap::filter{1, 0xffffffff, 0, true});

    for (int frame = 0; frame < 8; frame++) {
        const float x = static_cast<float>(frame);
        world.set(hero, {{x, 0}, {x + 1, 2}});
        const auto changes = world.update();
        for ([[maybe_unused]] const auto &pair : changes.begun) std::printf("frame %d: the hero touches the wall\n", frame);
        for ([[maybe_unused]] const auto &pair : changes.ended) std::printf("frame %d: the hero is past it\n", frame);
    }

    // What does the hero see, looking back? The ray begins in its own box, so the query leaves that out.
    sap::query query;
    query.excluded = sap::span<const sap::id>(&hero, 1);
    if (const auto hit = world.cast(world.ray({7.5f, 1}, {-1, 0}, 100), query); hit && hit->id == wall)
        std::printf("the wall is %.1f away\n", hit->t);

    world.remove(wall);
    try {
        world.remove(wall);
    } catch (const sap::error &error) {
        std::printf("%s\n", sap_status_name(error.status()));
    }
}
