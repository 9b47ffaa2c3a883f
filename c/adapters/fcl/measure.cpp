// How long FCL's managers and the adapter take, in processor time of one thread.
//
//     measure COUNT SHARE STEPS [LONGEST]
//
// COUNT objects fill a quarter of a cube; one of SHARE moves in each step (0: none), and one in 50 is LONGEST times as long as the
// others. `update and pairs` reads the objects that moved and calls back with all pairs; `queries` asks for what overlaps each of
// 1,000 other objects; `distance` asks for the least distance of 100 of them. Callbacks only count. The managers take turns in each
// step; medians over all steps but the first five. (FCL's interval tree and spatial hash take much longer than these, and the
// interval tree of FCL 0.7 may end the process if some of its objects are updated.)
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>

#include "../timing.hpp"
#include "scene.hpp"
#include "sweep_and_prune_fcl.hpp"

using S = double;
using object = fcl::CollisionObject<S>;

static bool count(object *a, object *b, void *data) {
    *static_cast<std::size_t *>(data) += a->getAABB().overlap(b->getAABB()) && a != b;
    return false;
}
static bool measure(object *a, object *b, void *, S &least) {
    least = std::min(least, a->getAABB().distance(b->getAABB()));
    return least <= 0;
}

struct entry {
    std::string name;
    std::unique_ptr<fcl::BroadPhaseCollisionManager<S>> manager;
    std::vector<double> pairs{}, queries{}, distance{};
};

int main(int argument_count, char **arguments) {
    const auto argument = [&](int at, int otherwise) { return argument_count > at ? std::atoi(arguments[at]) : otherwise; };
    const auto size = std::size_t(argument(1, 1000)), share = std::size_t(argument(2, 1)), steps = std::size_t(argument(3, 50));
    const S longest = argument(4, 1);
    scene<S> all(size, 1, S(0.25), longest, 1), others(1000, 1, S(0.25) * 1000 / S(size), longest, 2);
    std::vector<entry> entries;
    entries.push_back({"sweep-and-prune", std::make_unique<sap::fcl_manager<S>>()});
    entries.push_back({"DynamicAABBTree", std::make_unique<fcl::DynamicAABBTreeCollisionManager<S>>()});
    entries.push_back({"DynamicAABBTree_Array", std::make_unique<fcl::DynamicAABBTreeCollisionManager_Array<S>>()});
    entries.push_back({"SaP", std::make_unique<fcl::SaPCollisionManager<S>>()});
    entries.push_back({"SSaP", std::make_unique<fcl::SSaPCollisionManager<S>>()});
    for (auto &entry : entries) {
        const double begun = now();
        entry.manager->registerObjects(all.objects);
        entry.manager->setup();
        std::printf("%-22s register and set up %8.3f ms\n", entry.name.c_str(), now() - begun);
    }
    for (std::size_t step = 0; step < steps + 5; step++) {
        std::vector<object *> moved;
        for (std::size_t i = step; share > 0 && i < size; i += share) {
            all.move(i, S(0.05));
            moved.push_back(all.objects[i]);
        }
        std::size_t expected = 0;
        for (auto &entry : entries) {
            auto &manager = *entry.manager;
            std::size_t pairs = 0, hits = 0;
            const double begun = now();
            if (share == 1) manager.update();
            if (share > 1) manager.update(moved);
            manager.collide(&pairs, count);
            const double paired = now();
            for (object *other : others.objects) manager.collide(other, &hits, count);
            const double asked = now();
            for (std::size_t i = 0; i < 100; i++) manager.distance(others.objects[i], nullptr, measure);
            const double measured = now();
            if (&entry == &entries.front()) expected = pairs + hits;
            if (pairs + hits != expected) {
                std::fprintf(stderr, "%s: %zu pairs instead of %zu\n", entry.name.c_str(), pairs + hits, expected);
                return 1;
            }
            if (step < 5) continue;
            entry.pairs.push_back(paired - begun);
            entry.queries.push_back(asked - paired);
            entry.distance.push_back(measured - asked);
        }
    }
    for (const auto &entry : entries)
        std::printf("%-22s update and pairs %9.3f   queries %9.3f   distance %9.3f ms\n", entry.name.c_str(), median(entry.pairs),
                    median(entry.queries), median(entry.distance));
}
