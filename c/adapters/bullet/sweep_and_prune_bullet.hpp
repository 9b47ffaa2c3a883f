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

#include <array>
#include <cmath>
#include <limits>
#include <memory>
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
        sap::id id = no_id; // of a proxy that exists
    };

public:
    /// Uses at most this many threads in updates in which most bodies move.
    explicit bullet_broadphase(std::uint32_t threads = 1) : world(options(threads)), threads(threads) {}
    ~bullet_broadphase() override = default;
    bullet_broadphase(const bullet_broadphase &) = delete;
    bullet_broadphase &operator=(const bullet_broadphase &) = delete;

    btBroadphaseProxy *createProxy(const btVector3 &min, const btVector3 &max, int, void *object, int group, int mask,
                                   btDispatcher *) override {
        proxy_type made(min, max, object, group, mask);
        made.id = world.insert(box_of(min, max), filter_of(made));
        made.m_uniqueId = ++last_unique_id;
        try {
            while (blocks.size() <= slot(made.id) / block_size) blocks.push_back(std::make_unique<block>());
        } catch (...) {
            world.remove(made.id);
            throw;
        }
        return &(at(slot(made.id)) = made);
    }

    void destroyProxy(btBroadphaseProxy *proxy, btDispatcher *dispatcher) override {
        auto &gone = static_cast<proxy_type &>(*proxy);
        flush();
        cache.removeOverlappingPairsContainingProxy(proxy, dispatcher);
        world.remove(gone.id);
        gone.id = no_id;
    }

    void setAabb(btBroadphaseProxy *proxy, const btVector3 &min, const btVector3 &max, btDispatcher *) override {
        // Bullet sets all boxes in each step, those of bodies at rest too.
        if (proxy->m_aabbMin == min && proxy->m_aabbMax == max) return;
        if (!(min[0] <= max[0] && min[1] <= max[1] && min[2] <= max[2])) {
            // The world refuses it at once: among those that are set later it would be in the way of all others.
            world.set(static_cast<proxy_type *>(proxy)->id, box_of(min, max));
        }
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
            for_each_proxy([&](const proxy_type &proxy) { world.set_filter(proxy.id, filter_of(proxy)); });
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
        if (world.size() == 0) {
            min.setValue(0, 0, 0);
            max.setValue(0, 0, 0);
            return;
        }
        constexpr btScalar infinity = std::numeric_limits<btScalar>::infinity();
        min.setValue(infinity, infinity, infinity);
        max.setValue(-infinity, -infinity, -infinity);
        for_each_proxy([&](const proxy_type &proxy) {
            min.setMin(proxy.m_aabbMin);
            max.setMax(proxy.m_aabbMax);
        });
    }

    /// Makes an empty broad phase as good as new, so that the same scene gives the same pairs in the same order.
    void resetPool(btDispatcher *) override {
        if (world.size() > 0) return;
        world = world_type(options(threads));
        blocks.clear();
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
    /// The proxy of a slot, or where it will be.
    proxy_type &at(std::size_t slot) const { return (*blocks[slot / block_size])[slot % block_size]; }
    /// The proxy of an id, or null if it was destroyed.
    proxy_type *find(sap::id id) const {
        proxy_type &proxy = at(slot(id));
        return proxy.id == id ? &proxy : nullptr;
    }
    template <class Call>
    void for_each_proxy(Call call) const {
        for (const auto &block : blocks)
            for (const proxy_type &proxy : *block)
                if (proxy.id != no_id) call(proxy);
    }
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
    /// The proxies by slot: they keep their addresses. Close to each other, because Bullet sets all boxes in each step.
    static constexpr std::size_t block_size = 256;
    using block = std::array<proxy_type, block_size>;
    std::vector<std::unique_ptr<block>> blocks;
    std::vector<sap::id> moved_ids;
    std::vector<aabb> moved_boxes;
    std::vector<sap::id> ids;
    std::vector<world_type::hit> hits;
    int last_unique_id = 0;
    bool ignores_masks = false;
};

} // namespace sap

#endif
