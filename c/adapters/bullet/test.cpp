// The adapter beside Bullet's own broad phases: the same pairs, rays and regions in each step of falling boxes; proxies that come
// and go; groups, masks and a filter callback.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>
#include <thread>

#include "../../tests/check.h"
#include "scene.hpp"
#include "sweep_and_prune_bullet.hpp"

using pairs = std::set<std::pair<const void *, const void *>>;

static bool overlap(const btBroadphaseProxy &a, const btBroadphaseProxy &b) {
    return TestAabbAgainstAabb2(a.m_aabbMin, a.m_aabbMax, b.m_aabbMin, b.m_aabbMax);
}

// The pairs of a cache by their objects. Those of the alternatives also hold pairs that are only near each other.
static pairs pairs_in(btBroadphaseInterface &broadphase, bool all) {
    pairs found;
    auto &list = broadphase.getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < list.size(); i++) {
        const auto &a = *list[i].m_pProxy0, &b = *list[i].m_pProxy1;
        if (!all && !overlap(a, b)) continue;
        const void *x = a.m_clientObject, *y = b.m_clientObject;
        CHECK(found.insert(std::minmax(x, y)).second);
    }
    return found;
}

// What a ray or a region finds, without what is only near it.
struct seen : btBroadphaseRayCallback {
    std::set<const void *> objects;
    btVector3 from, to, min, max;
    bool is_ray;
    bool process(const btBroadphaseProxy *proxy) override {
        if (is_ray) {
            btScalar fraction = 1;
            btVector3 normal;
            // From Bullet's own test of a segment and a box, which is not exact: a box that it hits barely may not count.
            if (!btRayAabb(from, to, proxy->m_aabbMin, proxy->m_aabbMax, fraction, normal)) return true;
        } else if (!TestAabbAgainstAabb2(min, max, proxy->m_aabbMin, proxy->m_aabbMax)) {
            return true;
        }
        objects.insert(proxy->m_clientObject);
        return true;
    }
};

static std::set<const void *> ray(btBroadphaseInterface &broadphase, const btVector3 &from, const btVector3 &to) {
    seen seen;
    seen.is_ray = true;
    seen.from = from;
    seen.to = to;
    const btVector3 way = (to - from).normalized();
    for (int axis = 0; axis < 3; axis++) {
        seen.m_rayDirectionInverse[axis] = way[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / way[axis];
        seen.m_signs[axis] = seen.m_rayDirectionInverse[axis] < 0;
    }
    seen.m_lambda_max = way.dot(to - from);
    broadphase.rayTest(from, to, seen);
    return seen.objects;
}

static std::set<const void *> region(btBroadphaseInterface &broadphase, const btVector3 &min, const btVector3 &max) {
    seen seen;
    seen.is_ray = false;
    seen.min = min;
    seen.max = max;
    broadphase.aabbTest(min, max, seen);
    return seen.objects;
}

// A broad phase that gets the boxes of another one, step by step.
struct mirror {
    btBroadphaseInterface &broadphase;
    btDispatcher &dispatcher;
    std::vector<btBroadphaseProxy *> proxies;

    void copy(scene &scene) {
        for (std::size_t i = 0; i < scene.bodies.size(); i++) {
            const auto &from = *scene.bodies[i]->getBroadphaseHandle();
            if (i == proxies.size())
                proxies.push_back(broadphase.createProxy(from.m_aabbMin, from.m_aabbMax, BOX_SHAPE_PROXYTYPE, from.m_clientObject,
                                                         from.m_collisionFilterGroup, from.m_collisionFilterMask, &dispatcher));
            broadphase.setAabb(proxies[i], from.m_aabbMin, from.m_aabbMax, &dispatcher);
        }
        broadphase.calculateOverlappingPairs(&dispatcher);
    }
    void clear() {
        for (auto *proxy : proxies) broadphase.destroyProxy(proxy, &dispatcher);
        proxies.clear();
    }
};

// One world moves the boxes; all broad phases see the same, so that no order of contacts makes them differ.
static void falling_boxes(btBroadphaseInterface &driver, int moving, int fixed, int steps) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    scene scene(driver, moving, fixed);
    btDbvtBroadphase tree;
    btAxisSweep3 sweep(btVector3(-1100, -100, -1100), btVector3(1100, 300, 1100), 16000);
    sap::bullet_broadphase third;
    mirror mirrors[] = {{tree, dispatcher, {}}, {sweep, dispatcher, {}}, {third, dispatcher, {}}};
    std::mt19937 random(1);
    std::uniform_real_distribution<float> anywhere(-12, 12), height(0, 8);
    std::size_t most = 0;
    for (int step = 0; step < steps; step++) {
        scene.step();
        for (auto &mirror : mirrors) mirror.copy(scene);
        pairs expected; // brute force
        const auto &bodies = scene.bodies;
        for (std::size_t a = 0; step % 10 == 0 && a < bodies.size(); a++)
            for (std::size_t b = a + 1; b < bodies.size(); b++) {
                if (bodies[a]->isStaticObject() && bodies[b]->isStaticObject()) continue;
                const void *x = bodies[a].get(), *y = bodies[b].get();
                if (overlap(*bodies[a]->getBroadphaseHandle(), *bodies[b]->getBroadphaseHandle())) expected.insert(std::minmax(x, y));
            }
        const pairs found = pairs_in(third, true);
        CHECK(step % 10 != 0 || found == expected);
        CHECK(found == pairs_in(tree, false) && found == pairs_in(sweep, false));
        most = std::max(most, found.size());

        const btVector3 from(anywhere(random), height(random), anywhere(random)), to(anywhere(random), height(random), anywhere(random));
        const auto hit = ray(third, from, to);
        CHECK(hit == ray(tree, from, to));
        btVector3 min = from, max = from;
        min.setMin(to);
        max.setMax(to);
        CHECK(region(third, min, max) == region(tree, min, max));
    }
    CHECK(most > std::size_t(moving)); // they lie on each other
    btVector3 min, max;
    third.getBroadphaseAabb(min, max);
    CHECK(min[0] < -999 && max[0] > 999);
    for (auto &mirror : mirrors) mirror.clear();
    CHECK(third.getOverlappingPairCache()->getNumOverlappingPairs() == 0);
}

// Proxies come, move and go in random order; groups and masks decide, which change, or callbacks, which are replaced. Pairs are
// taken out of the cache.
static void random_calls(bool has_callback) {
    struct only_with_rest : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy *a, btBroadphaseProxy *b) const override {
            return (a->getUid() + b->getUid()) % 2 == rest;
        }
        int rest = 0;
    } callbacks[2];
    callbacks[1].rest = 1;
    const btOverlapFilterCallback *callback = nullptr;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    sap::bullet_broadphase broadphase;
    auto &cache = *broadphase.getOverlappingPairCache();
    std::vector<btBroadphaseProxy *> proxies;
    std::mt19937 random(2);
    const auto below = [&](unsigned limit) { return int(random() % limit); };
    const auto place = [&](btVector3 &min, btVector3 &max) {
        min.setValue(btScalar(below(12)), btScalar(below(12)), btScalar(below(12)));
        max = min + btVector3(btScalar(below(4)), btScalar(below(4)), btScalar(below(4)));
    };
    for (int call = 0; call < 20000; call++) {
        btVector3 min, max;
        place(min, max);
        const int what = below(10);
        if (what < 2 && proxies.size() < 150) {
            proxies.push_back(broadphase.createProxy(min, max, 0, nullptr, 1 + below(4), below(4), &dispatcher));
            proxies.back()->m_clientObject = proxies.back();
        } else if (what == 2 && !proxies.empty()) {
            std::swap(proxies[std::size_t(below(unsigned(proxies.size())))], proxies.back());
            broadphase.destroyProxy(proxies.back(), &dispatcher);
            proxies.pop_back();
        } else if (what == 3 && has_callback && below(20) == 0) {
            const int which = below(3);
            cache.setOverlapFilterCallback(which < 2 ? &callbacks[which] : nullptr);
            callback = which < 2 ? &callbacks[which] : nullptr;
        } else if (what == 3 && cache.getNumOverlappingPairs() > 0) {
            if (below(2)) cache.removeOverlappingPairsContainingProxy(cache.getOverlappingPairArrayPtr()->m_pProxy0, &dispatcher);
        } else if (what < 9 && !proxies.empty()) {
            auto *proxy = proxies[std::size_t(below(unsigned(proxies.size())))];
            if (what == 4) {
                proxy->m_collisionFilterGroup = 1 + below(4);
                proxy->m_collisionFilterMask = below(4);
                if (below(2)) broadphase.getAabb(proxy, min, max); // it rests
            }
            broadphase.setAabb(proxy, min, max, &dispatcher);
            broadphase.getAabb(proxy, min, max);
            CHECK(min == proxy->m_aabbMin && max == proxy->m_aabbMax);
        } else {
            broadphase.calculateOverlappingPairs(&dispatcher);
            pairs expected;
            for (auto *a : proxies)
                for (auto *b : proxies) {
                    const bool allowed = callback ? callback->needBroadphaseCollision(a, b)
                                                  : (a->m_collisionFilterGroup & b->m_collisionFilterMask) &&
                                                        (b->m_collisionFilterGroup & a->m_collisionFilterMask);
                    const void *x = a, *y = b;
                    if (a < b && allowed && overlap(*a, *b)) expected.insert({x, y});
                }
            CHECK(pairs_in(broadphase, true) == expected);
        }
    }
    while (!proxies.empty()) {
        broadphase.destroyProxy(proxies.back(), &dispatcher);
        proxies.pop_back();
    }
    broadphase.resetPool(&dispatcher);
    btVector3 min, max;
    broadphase.getBroadphaseAabb(min, max);
    CHECK(min == max);
    CHECK(region(broadphase, btVector3(-99, -99, -99), btVector3(99, 99, 99)).empty());
}

/// A box that is NaN is refused at once, and is in the way of no other.
static void bad_boxes() {
    sap::bullet_broadphase broadphase;
    const btVector3 low(0, 0, 0), high(1, 1, 1), far(9, 9, 9), nan(std::nanf(""), 0, 0);
    auto *bad = broadphase.createProxy(low, high, 0, nullptr, 1, -1, nullptr);
    auto *good = broadphase.createProxy(far, far, 0, nullptr, 1, -1, nullptr);
    bool is_refused = false;
    try {
        broadphase.setAabb(bad, nan, high, nullptr);
    } catch (const sap::error &) {
        is_refused = true;
    }
    CHECK(is_refused);
    broadphase.setAabb(good, low, high, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    CHECK(broadphase.getOverlappingPairCache()->getNumOverlappingPairs() == 1);
    broadphase.destroyProxy(bad, nullptr);
    broadphase.destroyProxy(good, nullptr);
}

/// Several threads ask at the same time, the first of them after a change; a callback may destroy what is found.
static void queries_of_threads() {
    sap::bullet_broadphase broadphase;
    std::mt19937 random(3);
    const auto anywhere = [&] { return btVector3(btScalar(random() % 40), btScalar(random() % 40), btScalar(random() % 40)); };
    std::vector<btBroadphaseProxy *> proxies;
    for (int i = 0; i < 3000; i++) {
        const btVector3 at = anywhere();
        proxies.push_back(broadphase.createProxy(at, at + btVector3(1, 1, 1), 0, nullptr, 1, -1, nullptr));
        proxies.back()->m_clientObject = proxies.back();
    }
    for (int round = 0; round < 20; round++) {
        for (int i = 0; i < 100; i++) {
            const btVector3 at = anywhere();
            broadphase.setAabb(proxies[random() % proxies.size()], at, at + btVector3(2, 2, 2), nullptr);
        }
        if (round % 2) broadphase.calculateOverlappingPairs(nullptr);
        std::vector<std::thread> threads;
        std::atomic<int> wrong{0}, begun{0};
        for (int thread = 0; thread < 4; thread++)
            threads.emplace_back([&, thread] {
                for (begun++; begun < 4;) std::this_thread::yield();
                for (int i = 0; i < 20; i++) {
                    const btVector3 min(btScalar(i), btScalar(thread), 5), max = min + btVector3(3, 3, 3);
                    std::set<const void *> expected;
                    for (const auto *proxy : proxies)
                        if (TestAabbAgainstAabb2(min, max, proxy->m_aabbMin, proxy->m_aabbMax)) expected.insert(proxy);
                    if (region(broadphase, min, max) != expected) wrong++;
                    const auto hit = ray(broadphase, min, max);
                    if (!std::includes(expected.begin(), expected.end(), hit.begin(), hit.end())) wrong++;
                }
            });
        for (auto &thread : threads) thread.join();
        CHECK(wrong == 0);
    }
    struct : btBroadphaseAabbCallback {
        sap::bullet_broadphase *from;
        std::vector<btBroadphaseProxy *> *proxies;
        std::size_t calls = 0;
        bool process(const btBroadphaseProxy *) override {
            calls++;
            for (auto *proxy : *proxies) from->destroyProxy(proxy, nullptr);
            proxies->clear();
            return true;
        }
    } destroy_all;
    destroy_all.from = &broadphase;
    destroy_all.proxies = &proxies;
    broadphase.aabbTest(btVector3(0, 0, 0), btVector3(40, 40, 40), destroy_all);
    CHECK(destroy_all.calls == 1);
}

int main(int count, char **arguments) {
    const int steps = count > 1 ? std::atoi(arguments[1]) : 150;
    btDbvtBroadphase tree;
    sap::bullet_broadphase broadphase(2);
    falling_boxes(tree, 300, 60, steps);
    falling_boxes(broadphase, 300, 60, steps);
    random_calls(false);
    random_calls(true);
    bad_boxes();
    queries_of_threads();
}
