// Bullet: its tree bare, its tree as the broad phase that it recommends, and its incremental sweep
// and prune, which has to be told the bounds of the world and compares rounded coordinates.
#include "libraries.h"

#include <algorithm>
#include <memory>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

namespace {

btVector3 min_corner(const Boxes &boxes, std::size_t id) {
    return {boxes.min(id, 0), boxes.min(id, 1), boxes.min(id, 2)};
}

btVector3 max_corner(const Boxes &boxes, std::size_t id) {
    return {boxes.max(id, 0), boxes.max(id, 1), boxes.max(id, 2)};
}

void *as_pointer(std::size_t id) { return reinterpret_cast<void *>(id); }

std::uint32_t as_id(const void *pointer) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::size_t>(pointer));
}

btBroadphaseProxy *create_proxy(btBroadphaseInterface &broadphase, const Boxes &boxes,
                                std::size_t id, bool is_static = false) {
    // As `btCollisionWorld::addCollisionObject` filters the two kinds of bodies.
    using Filter = btBroadphaseProxy;
    return broadphase.createProxy(
        min_corner(boxes, id), max_corner(boxes, id), BOX_SHAPE_PROXYTYPE, as_pointer(id),
        is_static ? Filter::StaticFilter : Filter::DefaultFilter,
        is_static ? Filter::AllFilter ^ Filter::StaticFilter : Filter::AllFilter, nullptr);
}

void fill(btBroadphaseInterface &broadphase, const Boxes &boxes) {
    for (std::size_t id = 0; id < boxes.count; ++id) create_proxy(broadphase, boxes, id);
}

// An incremental sweep in a world of these bounds.
std::unique_ptr<btBroadphaseInterface> make_sweep(const btVector3 &low, const btVector3 &high,
                                                  std::size_t count) {
    const unsigned most = static_cast<unsigned>(count) + 1;
    // 16 bits are the default, and enough for 16,384 boxes.
    if (most < 16384) {
        return std::make_unique<btAxisSweep3>(low, high, static_cast<unsigned short>(most),
                                              nullptr, true);
    }
    return std::make_unique<bt32BitAxisSweep3>(low, high, most, nullptr, true);
}

void collect(btBroadphaseInterface &broadphase, const Boxes &boxes, Pairs &pairs) {
    const btBroadphasePairArray &found =
        broadphase.getOverlappingPairCache()->getOverlappingPairArray();
    for (int at = 0; at < found.size(); ++at) {
        const std::uint32_t a = as_id(found[at].m_pProxy0->m_clientObject);
        const std::uint32_t b = as_id(found[at].m_pProxy1->m_clientObject);
        if (boxes.overlap(a, b)) pairs.push_back({a, b});
    }
}

} // namespace

extern "C" void bench_bullet_tree(const Boxes *boxes, Pairs *pairs) {
    struct Keep final : btDbvt::ICollide {
        Pairs &pairs;
        explicit Keep(Pairs &pairs) : pairs(pairs) {}
        using btDbvt::ICollide::Process;
        void Process(const btDbvtNode *a, const btDbvtNode *b) override {
            pairs.push_back({as_id(a->data), as_id(b->data)});
        }
    };
    btDbvt tree;
    for (std::size_t id = 0; id < boxes->count; ++id) {
        tree.insert(btDbvtVolume::FromMM(min_corner(*boxes, id), max_corner(*boxes, id)),
                    as_pointer(id));
    }
    Keep keep(*pairs);
    tree.collideTT(tree.m_root, tree.m_root, keep);
}

extern "C" void bench_bullet_broadphase(const Boxes *boxes, Pairs *pairs) {
    btDbvtBroadphase broadphase;
    // Overlaps are looked for once at the end and not for each box as it comes.
    broadphase.m_deferedcollide = true;
    fill(broadphase, *boxes);
    broadphase.calculateOverlappingPairs(nullptr);
    collect(broadphase, *boxes, *pairs);
}

extern "C" void bench_bullet_sweep(const Boxes *boxes, Pairs *pairs) {
    btVector3 low(0, 0, 0), high(0, 0, 0);
    for (std::size_t id = 0; id < boxes->count; ++id) {
        low.setMin(min_corner(*boxes, id));
        high.setMax(max_corner(*boxes, id));
    }
    const auto broadphase = make_sweep(low, high, boxes->count);
    fill(*broadphase, *boxes);
    broadphase->calculateOverlappingPairs(nullptr);
    collect(*broadphase, *boxes, *pairs);
}

// A broad phase that is kept from frame to frame.
struct BulletWorld {
    std::unique_ptr<btBroadphaseInterface> broadphase;
    std::vector<btBroadphaseProxy *> proxies;
};

extern "C" BulletWorld *bench_bullet_world_new(const Boxes *boxes, std::size_t movers, bool sweep) {
    btVector3 low(0, 0, 0), high(0, 0, 0), width(0, 0, 0);
    for (std::size_t id = 0; id < boxes->count; ++id) {
        low.setMin(min_corner(*boxes, id));
        high.setMax(max_corner(*boxes, id));
        width += max_corner(*boxes, id) - min_corner(*boxes, id);
    }
    width /= static_cast<btScalar>(std::max<std::size_t>(boxes->count, 1));
    auto world = std::make_unique<BulletWorld>();
    if (sweep) {
        // Boxes that move stay within these bounds.
        world->broadphase = make_sweep(low - width, high + width, boxes->count);
    } else {
        gDbvtMargin = 0.05f * width.x();
        auto tree = std::make_unique<btDbvtBroadphase>();
        // Overlaps are looked for once at the end and not for each box as it comes.
        tree->m_deferedcollide = true;
        world->broadphase = std::move(tree);
    }
    for (std::size_t id = 0; id < boxes->count; ++id) {
        world->proxies.push_back(create_proxy(*world->broadphase, *boxes, id, id >= movers));
    }
    world->broadphase->calculateOverlappingPairs(nullptr);
    return world.release();
}

extern "C" void bench_bullet_world_delete(BulletWorld *world) { delete world; }

extern "C" void bench_bullet_world_step(BulletWorld *world, const Boxes *boxes,
                                        const std::uint32_t *moved, std::size_t count) {
    for (std::size_t at = 0; at < count; ++at) {
        const std::uint32_t id = moved[at];
        world->broadphase->setAabb(world->proxies[id], min_corner(*boxes, id),
                                   max_corner(*boxes, id), nullptr);
    }
    world->broadphase->calculateOverlappingPairs(nullptr);
}

extern "C" void bench_bullet_world_pairs(const BulletWorld *world, Pairs *pairs) {
    const btBroadphasePairArray &found =
        world->broadphase->getOverlappingPairCache()->getOverlappingPairArray();
    for (int at = 0; at < found.size(); ++at) {
        pairs->push_back({as_id(found[at].m_pProxy0->m_clientObject),
                          as_id(found[at].m_pProxy1->m_clientObject)});
    }
}
