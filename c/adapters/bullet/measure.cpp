// How long Bullet's broad phases and the adapter take, in processor time of one thread, per step.
//
//     measure MOVING FIXED STEPS
//
// `search`: one world moves the boxes; each broad phase then gets all boxes, as Bullet sets them in each step, and searches for
// pairs, in turn. `step`: each has a world of its own, and the whole step is measured. Medians over all steps but the first
// ten.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "../timing.hpp"
#include "scene.hpp"
#include "sweep_and_prune_bullet.hpp"

struct entry {
    std::string name;
    std::unique_ptr<btBroadphaseInterface> broadphase, driver; // what is searched beside, and what a world of its own has
    std::unique_ptr<scene> own;
    std::vector<btBroadphaseProxy *> proxies;
    std::vector<double> search, step;
};

static std::unique_ptr<btBroadphaseInterface> make(const std::string &name) {
    if (name == "sweep-and-prune") return std::make_unique<sap::bullet_broadphase>();
    if (name == "btDbvtBroadphase") return std::make_unique<btDbvtBroadphase>();
    return std::make_unique<bt32BitAxisSweep3>(btVector3(-1100, -100, -1100), btVector3(1100, 1000, 1100), 30000);
}

int main(int count, char **arguments) {
    const auto argument = [&](int at, int otherwise) { return count > at ? std::atoi(arguments[at]) : otherwise; };
    const int moving = argument(1, 1000), fixed = argument(2, 0), steps = argument(3, 200);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    std::vector<entry> entries;
    for (const char *name : {"sweep-and-prune", "btDbvtBroadphase", "bt32BitAxisSweep3"}) {
        // It inserts one proxy in time proportional to those that it has.
        if (moving + fixed > 20000 && std::string(name) == "bt32BitAxisSweep3") continue;
        entries.push_back({name, make(name), make(name), nullptr, {}, {}, {}});
        entries.back().own = std::make_unique<scene>(*entries.back().driver, moving, fixed);
    }
    btDbvtBroadphase tree;
    scene source(tree, moving, fixed);
    for (auto &entry : entries)
        for (const auto &body : source.bodies) {
            const auto &from = *body->getBroadphaseHandle();
            entry.proxies.push_back(entry.broadphase->createProxy(from.m_aabbMin, from.m_aabbMax, BOX_SHAPE_PROXYTYPE, body.get(),
                                                                  from.m_collisionFilterGroup, from.m_collisionFilterMask, &dispatcher));
        }
    for (int step = 0; step < steps; step++) {
        source.step();
        for (std::size_t turn = 0; turn < entries.size(); turn++) {
            auto &entry = entries[(turn + std::size_t(step)) % entries.size()];
            double begun = now();
            for (std::size_t i = 0; i < source.bodies.size(); i++) {
                const auto &from = *source.bodies[i]->getBroadphaseHandle();
                entry.broadphase->setAabb(entry.proxies[i], from.m_aabbMin, from.m_aabbMax, &dispatcher);
            }
            entry.broadphase->calculateOverlappingPairs(&dispatcher);
            const double searched = now() - begun;
            begun = now();
            entry.own->step();
            const double stepped = now() - begun;
            if (step < 10) continue;
            entry.search.push_back(searched);
            entry.step.push_back(stepped);
        }
    }
    std::printf("%d moving, %d static, %d steps\n", moving, fixed, steps);
    for (auto &entry : entries) {
        std::printf("  %-18s search %8.3f ms   step %8.3f ms   %d pairs\n", entry.name.c_str(), median(entry.search), median(entry.step),
                    entry.broadphase->getOverlappingPairCache()->getNumOverlappingPairs());
        for (auto *proxy : entry.proxies) entry.broadphase->destroyProxy(proxy, &dispatcher);
    }
}
