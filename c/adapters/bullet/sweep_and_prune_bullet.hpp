// sweep-and-prune as a broad phase of the physics engine Bullet:
//
//     sap::bullet_broadphase broadphase;
//     btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
//
// Pairs are those whose AABBs overlap, as Bullet set them, and change in btBroadphaseInterface::calculateOverlappingPairs, once a
// step, in an order that is the same on every platform. Errors are exceptions: a box that is NaN or inverted, which Bullet itself does
// not set.
#ifndef SWEEP_AND_PRUNE_BULLET_HPP
#define SWEEP_AND_PRUNE_BULLET_HPP

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <sweep_and_prune.hpp>

namespace sap {

class bullet_broadphase : public btBroadphaseInterface {
    using world_type = sap::world<3, btScalar>;
    using aabb = world_type::aabb;

    struct proxy_type : btBroadphaseProxy {
        using btBroadphaseProxy::btBroadphaseProxy;
        sap::id id = no_id;
        std::size_t index = 0; // in `proxies`
    };

public:
    /// Uses at most this many threads in updates in which most bodies move.
    explicit bullet_broadphase(std::uint32_t threads = 1) : world(options(threads)), threads(threads) {}
    ~bullet_broadphase() override = default;
    bullet_broadphase(const bullet_broadphase &) = delete;
    bullet_broadphase &operator=(const bullet_broadphase &) = delete;

    btBroadphaseProxy *createProxy(const btVector3 &min, const btVector3 &max, int, void *object, int group, int mask,
                                   btDispatcher *) override {
        auto made = std::make_unique<proxy_type>(min, max, object, group, mask);
        made->id = world.insert(box_of(min, max), filter_of(*made));
        made->m_uniqueId = ++last_unique_id;
        made->index = proxies.size();
        if (by_slot.size() <= slot(made->id)) by_slot.resize(slot(made->id) + 1, nullptr);
        by_slot[slot(made->id)] = made.get();
        proxies.push_back(std::move(made));
        return proxies.back().get();
    }

    void destroyProxy(btBroadphaseProxy *proxy, btDispatcher *dispatcher) override {
        auto &gone = static_cast<proxy_type &>(*proxy);
        flush();
        cache.removeOverlappingPairsContainingProxy(proxy, dispatcher);
        world.remove(gone.id);
        by_slot[slot(gone.id)] = nullptr;
        const std::size_t index = gone.index;
        std::swap(proxies[index], proxies.back());
        proxies[index]->index = index;
        proxies.pop_back();
    }

    void setAabb(btBroadphaseProxy *proxy, const btVector3 &min, const btVector3 &max, btDispatcher *) override {
        // Bullet sets all boxes in each step, those of bodies at rest too.
        if (proxy->m_aabbMin == min && proxy->m_aabbMax == max) return;
        proxy->m_aabbMin = min;
        proxy->m_aabbMax = max;
        moved_ids.push_back(static_cast<proxy_type *>(proxy)->id);
        moved_boxes.push_back(box_of(min, max));
    }

    void getAabb(btBroadphaseProxy *proxy, btVector3 &min, btVector3 &max) const override {
        min = proxy->m_aabbMin;
        max = proxy->m_aabbMax;
    }

    void calculateOverlappingPairs(btDispatcher *dispatcher) override {
        // A callback decides instead of groups and masks, so with one no pair may be left out because of them.
        const bool wants_all = cache.getOverlapFilterCallback() != nullptr;
        if (wants_all != ignores_masks) {
            ignores_masks = wants_all;
            for (const auto &proxy : proxies) world.set_filter(proxy->id, filter_of(*proxy));
        }
        flush();
        const auto changes = world.update();
        for (const auto &pair : changes.ended) {
            // The pairs of a proxy that was destroyed were removed then.
            proxy_type *const a = find(pair.a), *const b = find(pair.b);
            if (a && b) cache.removeOverlappingPair(a, b, dispatcher);
        }
        for (const auto &pair : changes.begun) cache.addOverlappingPair(find(pair.a), find(pair.b));
    }

    void rayTest(const btVector3 &from, const btVector3 &to, btBroadphaseRayCallback &callback,
                 const btVector3 &min = btVector3(0, 0, 0), const btVector3 &max = btVector3(0, 0, 0)) override {
        flush();
        world_type::cast_type cast{};
        for (int axis = 0; axis < 3; axis++) {
            // A moving box is rounded outwards.
            cast.from.min[axis] = min[axis] == 0 ? from[axis] : down(from[axis] + min[axis]);
            cast.from.max[axis] = max[axis] == 0 ? from[axis] : up(from[axis] + max[axis]);
            cast.direction[axis] = to[axis] - from[axis];
        }
        cast.limit = 1;
        std::vector<world_type::hit> found = std::move(hits); // the callback may ask, too
        world.cast_all(cast, found);
        for (const auto &hit : found) callback.process(find(hit.id));
        hits = std::move(found);
    }

    void aabbTest(const btVector3 &min, const btVector3 &max, btBroadphaseAabbCallback &callback) override {
        flush();
        std::vector<sap::id> found = std::move(ids); // the callback may ask, too
        world.overlapping(box_of(min, max), found);
        for (const sap::id id : found) callback.process(find(id));
        ids = std::move(found);
    }

    btOverlappingPairCache *getOverlappingPairCache() override { return &cache; }
    const btOverlappingPairCache *getOverlappingPairCache() const override { return &cache; }

    /// The smallest box that contains all boxes. Takes O(n) time.
    void getBroadphaseAabb(btVector3 &min, btVector3 &max) const override {
        min.setValue(0, 0, 0);
        max.setValue(0, 0, 0);
        if (proxies.empty()) return;
        min = proxies[0]->m_aabbMin;
        max = proxies[0]->m_aabbMax;
        for (const auto &proxy : proxies) {
            min.setMin(proxy->m_aabbMin);
            max.setMax(proxy->m_aabbMax);
        }
    }

    /// Makes an empty broad phase as good as new, so that the same scene gives the same pairs in the same order.
    void resetPool(btDispatcher *) override {
        if (!proxies.empty()) return;
        world = world_type(options(threads));
        by_slot.clear();
        last_unique_id = 0;
    }

    void printStats() override {}

private:
    static world_type::options options(std::uint32_t threads) {
        world_type::options options{};
        options.threads = threads;
        return options;
    }
    static aabb box_of(const btVector3 &min, const btVector3 &max) {
        return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
    }
    static btScalar down(btScalar at) { return std::nextafter(at, -std::numeric_limits<btScalar>::infinity()); }
    static btScalar up(btScalar at) { return std::nextafter(at, std::numeric_limits<btScalar>::infinity()); }
    static std::size_t slot(sap::id id) { return static_cast<std::uint32_t>(id); }

    /// Bullet's groups and masks pair as categories and masks do.
    sap::filter filter_of(const btBroadphaseProxy &proxy) const {
        if (ignores_masks) return {};
        return {static_cast<std::uint32_t>(proxy.m_collisionFilterGroup), static_cast<std::uint32_t>(proxy.m_collisionFilterMask), 0, false};
    }
    /// The proxy of an id, or null if it was destroyed. A slot of a body that an update knew is free only after the next one.
    proxy_type *find(sap::id id) const { return by_slot[slot(id)]; }
    /// Sets the boxes that Bullet set: all at once takes less time than one by one.
    void flush() {
        if (moved_ids.empty()) return;
        world.set_many(moved_ids, moved_boxes);
        moved_ids.clear();
        moved_boxes.clear();
    }

    world_type world;
    std::uint32_t threads;
    btHashedOverlappingPairCache cache;
    std::vector<std::unique_ptr<proxy_type>> proxies;
    std::vector<proxy_type *> by_slot;
    std::vector<sap::id> moved_ids;
    std::vector<aabb> moved_boxes;
    std::vector<sap::id> ids;
    std::vector<world_type::hit> hits;
    int last_unique_id = 0;
    bool ignores_masks = false;
};

} // namespace sap

#endif
