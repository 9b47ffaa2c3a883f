// sweep-and-prune as a broad phase of the physics engine Bullet:
//
//     sap::bullet_broadphase broadphase;
//     btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
//
// Pairs are those whose AABBs overlap, as Bullet set them, and change in btBroadphaseInterface::calculateOverlappingPairs, once a
// step, in an order that is the same on every platform. Errors are exceptions: a box that is NaN or inverted, which Bullet itself does
// not set.
//
// A group or mask that is changed in a proxy counts from the next time on that Bullet sets its box. The filter callback of the pair
// cache is asked once for each overlap that begins, and for all again when it is replaced. A pair that is taken out of the cache comes
// back in the next step if its boxes still overlap.
//
// Between two changes several threads may call rayTest and aabbTest at the same time, as btDiscreteDynamicsWorldMt does.
#ifndef SWEEP_AND_PRUNE_BULLET_HPP
#define SWEEP_AND_PRUNE_BULLET_HPP

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <type_traits>
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
        int known_group = 0, known_mask = 0; // those that the world has
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
        made.known_group = group;
        made.known_mask = mask;
        are_queries_due = true;
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
        const int pairs = cache.getNumOverlappingPairs();
        cache.removeOverlappingPairsContainingProxy(proxy, dispatcher);
        cached_pairs -= pairs - cache.getNumOverlappingPairs();
        world.remove(gone.id);
        are_queries_due = true;
        gone.id = no_id;
    }

    void setAabb(btBroadphaseProxy *proxy, const btVector3 &min, const btVector3 &max, btDispatcher *) override {
        auto &moved = static_cast<proxy_type &>(*proxy);
        if (moved.known_group != moved.m_collisionFilterGroup || moved.known_mask != moved.m_collisionFilterMask) read_filter(moved);
        // Bullet sets all boxes in each step, those of bodies at rest too.
        if (proxy->m_aabbMin == min && proxy->m_aabbMax == max) return;
        if (!(min[0] <= max[0] && min[1] <= max[1] && min[2] <= max[2])) {
            // The world refuses it at once: among those that are set later it would be in the way of all others.
            world.set(moved.id, box_of(min, max));
        }
        proxy->m_aabbMin = min;
        proxy->m_aabbMax = max;
        moved_ids.push_back(moved.id);
        moved_boxes.push_back(box_of(min, max));
    }

    void getAabb(btBroadphaseProxy *proxy, btVector3 &min, btVector3 &max) const override {
        min = proxy->m_aabbMin;
        max = proxy->m_aabbMax;
    }

    void calculateOverlappingPairs(btDispatcher *dispatcher) override {
        btOverlapFilterCallback *const callback = cache.getOverlapFilterCallback();
        // A callback decides instead of groups and masks, so with one no pair may be left out because of them.
        if ((callback != nullptr) != ignores_masks) {
            ignores_masks = callback != nullptr;
            for_each_proxy([&](proxy_type &proxy) { read_filter(proxy); });
        }
        flush();
        const auto changes = world.update();
        are_queries_due = true;
        // Something else than this broad phase took pairs out.
        const bool any_missing = cache.getNumOverlappingPairs() < cached_pairs;
        for_each_pair(changes.ended, [&](proxy_type *a, proxy_type *b) { cache.removeOverlappingPair(a, b, dispatcher); });
        for_each_pair(changes.begun, [&](proxy_type *a, proxy_type *b) { cache.addOverlappingPair(a, b); });
        if (any_missing || callback != last_callback) {
            for_each_pair(world.pairs(), [&](proxy_type *a, proxy_type *b) {
                if (!cache.addOverlappingPair(a, b)) cache.removeOverlappingPair(a, b, dispatcher);
            });
        }
        last_callback = callback;
        cached_pairs = cache.getNumOverlappingPairs();
    }

    void rayTest(const btVector3 &from, const btVector3 &to, btBroadphaseRayCallback &callback,
                 const btVector3 &min = btVector3(0, 0, 0), const btVector3 &max = btVector3(0, 0, 0)) override {
        world_type::cast_type cast{};
        for (int axis = 0; axis < 3; axis++) {
            // A moving box is rounded outwards.
            cast.from.min[axis] = min[axis] == 0 ? from[axis] : down(from[axis] + min[axis]);
            cast.from.max[axis] = max[axis] == 0 ? from[axis] : up(from[axis] + max[axis]);
            cast.direction[axis] = to[axis] - from[axis];
        }
        cast.limit = 1;
        for (const auto &hit : ask([&] { return world.cast_all(cast); })) process(hit.id, callback);
    }

    void aabbTest(const btVector3 &min, const btVector3 &max, btBroadphaseAabbCallback &callback) override {
        for (const sap::id id : ask([&] { return world.overlapping(box_of(min, max)); })) process(id, callback);
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
        are_queries_due = true;
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
            for (proxy_type &proxy : *block)
                if (proxy.id != no_id) call(proxy);
    }
    /// Calls back with the proxies of each pair, but for those that were destroyed, whose pairs were removed then.
    template <class Pairs, class Call>
    void for_each_pair(const Pairs &pairs, Call call) const {
        for (const auto &pair : pairs) {
            proxy_type *const a = find(pair.a), *const b = find(pair.b);
            if (a && b) call(a, b);
        }
    }
    /// Has the world use the group and mask of a proxy as they are now.
    void read_filter(proxy_type &proxy) {
        world.set_filter(proxy.id, filter_of(proxy));
        are_queries_due = true;
        proxy.known_group = proxy.m_collisionFilterGroup;
        proxy.known_mask = proxy.m_collisionFilterMask;
    }
    /// Calls back with a proxy that a query found, unless an earlier call destroyed it.
    template <class Callback>
    void process(sap::id id, Callback &callback) const {
        if (const proxy_type *const found = find(id)) callback.process(found);
    }
    /// What a query finds in the world, which several threads may ask at the same time.
    template <class Query>
    std::invoke_result_t<Query> ask(Query query) {
        for (;;) {
            {
                std::shared_lock<std::shared_mutex> lock(asking);
                if (moved_ids.empty() && !are_queries_due) return query();
            }
            std::unique_lock<std::shared_mutex> lock(asking);
            flush();
            if (are_queries_due) world.prepare_queries();
            are_queries_due = false;
        }
    }
    /// Sets the boxes that Bullet set: all at once takes less time than one by one.
    void flush() {
        if (moved_ids.empty()) return;
        world.set_many(moved_ids, moved_boxes);
        are_queries_due = true;
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
    int last_unique_id = 0;
    btOverlapFilterCallback *last_callback = nullptr;
    bool ignores_masks = false; // as the last callback wants
    int cached_pairs = 0;       // in the cache, if nothing else takes any out
    std::shared_mutex asking; // alone: while the world is prepared for queries
    bool are_queries_due = false;
};

} // namespace sap

#endif
