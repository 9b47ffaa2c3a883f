// Bullet: its tree bare, its tree as the broad phase that it recommends, and its incremental sweep
// and prune, which has to be told the bounds of the world and compares rounded coordinates.
#include "peers.h"

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

void fill(btBroadphaseInterface &broadphase, const Boxes &boxes) {
    for (std::size_t id = 0; id < boxes.count; ++id) {
        broadphase.createProxy(min_corner(boxes, id), max_corner(boxes, id), BOX_SHAPE_PROXYTYPE,
                               as_pointer(id), btBroadphaseProxy::DefaultFilter,
                               btBroadphaseProxy::AllFilter, nullptr);
    }
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
    const unsigned most = static_cast<unsigned>(boxes->count) + 1;
    std::unique_ptr<btBroadphaseInterface> broadphase;
    // 16 bits are the default, and enough for 16,384 boxes.
    if (most < 16384) {
        broadphase = std::make_unique<btAxisSweep3>(low, high, static_cast<unsigned short>(most),
                                                    nullptr, true);
    } else {
        broadphase = std::make_unique<bt32BitAxisSweep3>(low, high, most, nullptr, true);
    }
    fill(*broadphase, *boxes);
    broadphase->calculateOverlappingPairs(nullptr);
    collect(*broadphase, *boxes, *pairs);
}
