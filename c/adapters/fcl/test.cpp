// The adapter beside FCL's own managers and brute force: pairs, queries, pairs of two managers, least distances, while objects come,
// move and go.
//
//     test STEPS
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <thread>

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_interval_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/halfspace.h>

#include "../../tests/check.h"
#include "scene.hpp"
#include "sweep_and_prune_fcl.hpp"

// Some of FCL's managers leak.
extern "C" const char *__lsan_default_suppressions() { return "leak:libfcl"; }

using S = double;
using object = fcl::CollisionObject<S>;
using manager = fcl::BroadPhaseCollisionManager<S>;
using pairs = std::set<std::pair<object *, object *>>;

// Notes the pairs that overlap. The alternatives also give pairs that are only near each other, and those of an object with itself.
struct noted {
    pairs found;
    bool is_ordered = false; // whether (a, b) and (b, a) differ
    bool is_exact = false;   // whether each pair has to overlap and come once
    std::size_t left = std::numeric_limits<std::size_t>::max();
};
static bool note(object *a, object *b, void *data) {
    auto &noted = *static_cast<struct noted *>(data);
    const bool overlaps = a != b && a->getAABB().overlap(b->getAABB());
    CHECK(overlaps || !noted.is_exact);
    if (!overlaps) return false;
    const bool is_new = noted.found.insert(noted.is_ordered || a < b ? std::make_pair(a, b) : std::make_pair(b, a)).second;
    CHECK(is_new || !noted.is_exact);
    return --noted.left == 0;
}

template <class Ask> static pairs pairs_of(bool is_exact, bool is_ordered, Ask ask) {
    noted noted;
    noted.is_exact = is_exact;
    noted.is_ordered = is_ordered;
    ask(&noted);
    return noted.found;
}

// The least distance of pairs, and how often it was asked for. A distance is that of two AABBs, of two shapes, or one that is larger.
enum class distance_of { aabbs, shapes, farther, nothing };
struct nearest {
    distance_of kind;
    S least = std::numeric_limits<S>::max();
    pairs asked{};
};
static bool measure(object *a, object *b, void *data, S &least) {
    auto &nearest = *static_cast<struct nearest *>(data);
    CHECK(a != b && nearest.asked.insert(std::minmax({a, b})).second);
    const S between = a->getAABB().distance(b->getAABB());
    fcl::DistanceResult<S> result;
    switch (nearest.kind) {
    case distance_of::aabbs: least = std::min(least, between); break;
    case distance_of::shapes: least = std::min(least, fcl::distance(a, b, fcl::DistanceRequest<S>(), result)); break;
    case distance_of::farther: least = std::min(least, 3 * between + 1); break;
    case distance_of::nothing: return false;
    }
    nearest.least = least;
    return least <= 0;
}

static void check_least(distance_of kind, const std::vector<object *> &a, const std::vector<object *> &b,
                        const std::function<void(nearest &)> &ask) {
    nearest expected{kind}, found{kind};
    S least = std::numeric_limits<S>::max();
    for (object *x : a)
        for (object *y : b)
            if (x != y && !expected.asked.count(std::minmax({x, y}))) measure(x, y, &expected, least);
    ask(found);
    // Where shapes overlap, FCL says -1 or how deep they do, and the search stops at the first.
    CHECK(found.least == expected.least || (found.least <= 0 && expected.least <= 0));
    // Without a distance, all pairs are asked for; with one, those alone that may be nearer than the nearest so far.
    if (kind == distance_of::nothing) CHECK(found.asked == expected.asked);
    if (kind == distance_of::aabbs && expected.asked.size() > 1000) CHECK(found.asked.size() <= expected.asked.size() / 4);
}

// Objects that move are the same for all managers.
static void moving_objects(std::size_t count, S density, S longest, std::size_t steps, unsigned seed) {
    scene<S> all(count, 1, density, longest, seed), others(count / 4, 1, density / 4, longest, seed + 1);
    auto &objects = all.objects;
    sap::fcl_manager<S> adapter, second(2);
    fcl::NaiveCollisionManager<S> naive;
    fcl::SSaPCollisionManager<S> simple;
    fcl::SaPCollisionManager<S> sweep;
    fcl::IntervalTreeCollisionManager<S> intervals;
    fcl::DynamicAABBTreeCollisionManager<S> tree;
    fcl::DynamicAABBTreeCollisionManager_Array<S> array;
    const std::vector<manager *> managers{&adapter, &naive, &simple, &sweep, &intervals, &tree, &array};
    for (auto *manager : managers) {
        manager->registerObjects(objects);
        manager->setup();
    }
    second.registerObjects(others.objects);
    std::size_t most = 0;
    for (std::size_t step = 0; step < steps; step++) {
        // All, a few, or none.
        const std::size_t share = step % 3 == 0 ? 1 : step % 3 == 1 ? 20 : count;
        for (std::size_t i = step; i < count; i += share) step % 10 == 9 ? all.place(i) : all.move(i, S(0.2));
        for (auto *manager : managers) manager->update();
        pairs expected;
        for (std::size_t a = 0; a < count; a++)
            for (std::size_t b = a + 1; b < count; b++)
                if (objects[a]->getAABB().overlap(objects[b]->getAABB())) expected.insert(std::minmax(objects[a], objects[b]));
        most = std::max(most, expected.size());
        for (auto *manager : managers)
            CHECK(pairs_of(manager == &adapter, false, [&](noted *data) { manager->collide(data, note); }) == expected);

        // The same contacts.
        std::vector<std::size_t> contacts;
        for (auto *manager : {managers.front(), managers.back()}) {
            fcl::DefaultCollisionData<S> data;
            data.request.num_max_contacts = 100000;
            data.request.enable_contact = true;
            manager->collide(&data, fcl::DefaultCollisionFunction<S>);
            contacts.push_back(data.result.numContacts());
        }
        CHECK(contacts[0] == contacts[1]);

        // One object, of the manager's own or another.
        object *const asked = step % 2 ? objects[all.below(count)] : others.objects[step % others.objects.size()];
        pairs met;
        for (object *one : objects)
            if (one != asked && one->getAABB().overlap(asked->getAABB())) met.insert({one, asked});
        for (auto *manager : managers) {
            // The order of the two is not the same in all of FCL's managers.
            if (manager == &adapter) {
                CHECK(pairs_of(true, true, [&](noted *data) { manager->collide(asked, data, note); }) == met);
            } else {
                CHECK(pairs_of(false, false, [&](noted *data) { manager->collide(asked, data, note); }).size() == met.size());
            }
        }

        // Two managers.
        pairs between;
        for (object *a : objects)
            for (object *b : others.objects)
                if (a->getAABB().overlap(b->getAABB())) between.insert({a, b});
        CHECK(pairs_of(true, true, [&](noted *data) { adapter.collide(&second, data, note); }) == between);
        CHECK(pairs_of(true, true, [&](noted *data) { second.collide(&adapter, data, note); }).size() == between.size());
        fcl::SSaPCollisionManager<S> foreign;
        foreign.registerObjects(others.objects);
        foreign.setup();
        CHECK(pairs_of(true, true, [&](noted *data) { adapter.collide(&foreign, data, note); }) == between);
        CHECK(pairs_of(true, false, [&](noted *data) { adapter.collide(&adapter, data, note); }) == expected);

        for (const auto kind : {distance_of::aabbs, distance_of::shapes, distance_of::farther, distance_of::nothing}) {
            if (kind != distance_of::aabbs && step % 10) continue; // which takes long by brute force
            check_least(kind, objects, {asked}, [&](nearest &data) { adapter.distance(asked, &data, measure); });
            check_least(kind, objects, objects, [&](nearest &data) { adapter.distance(&data, measure); });
            check_least(kind, objects, others.objects, [&](nearest &data) { adapter.distance(&second, &data, measure); });
            check_least(kind, others.objects, objects, [&](nearest &data) { second.distance(&adapter, &data, measure); });
            if (kind != distance_of::nothing) // each pair of them may come again
                check_least(kind, objects, others.objects, [&](nearest &data) { adapter.distance(&foreign, &data, measure); });
        }

        // Callbacks stop it.
        noted first;
        first.left = 1;
        adapter.collide(&first, note);
        CHECK(first.found.size() == std::min<std::size_t>(1, expected.size()));
    }
    CHECK(most > count / 10);
}

// Objects come, move and go in random order, and are known or not.
static void random_calls(std::size_t calls) {
    scene<S> all(60, 1, S(0.5), 4, 3);
    sap::fcl_manager<S> manager, others;
    std::vector<object *> listed;
    std::map<object *, fcl::AABB<S>> known; // as the manager has to know it
    others.registerObjects({all.objects.begin(), all.objects.begin() + 30});
    for (std::size_t call = 0; call < calls; call++) {
        object *const one = all.objects[all.below(all.objects.size())];
        const auto index = std::size_t(std::find(all.objects.begin(), all.objects.end(), one) - all.objects.begin());
        switch (all.below(9)) {
        case 0: case 1: manager.registerObject(one); known.emplace(one, one->getAABB()); break;
        case 2: manager.registerObjects({one, all.objects[0], one}); known.emplace(one, one->getAABB()); known.emplace(all.objects[0], all.objects[0]->getAABB()); break;
        case 3: manager.unregisterObject(one); known.erase(one); break;
        case 4: all.place(index); manager.update(one); if (known.count(one)) known[one] = one->getAABB(); break;
        case 5: all.place(index); break; // seen at the next update
        case 6: manager.update(); for (auto &[object, box] : known) box = object->getAABB(); break;
        case 7: if (all.below(50) == 0) { manager.clear(); known.clear(); } break;
        default: {
            std::set<std::pair<object *, object *>> expected, found;
            for (const auto &[a, x] : known)
                for (const auto &[b, y] : known)
                    if (a < b && x.overlap(y)) expected.insert({a, b});
            manager.collide(&found, [](object *a, object *b, void *data) {
                CHECK(static_cast<pairs *>(data)->insert(std::minmax(a, b)).second);
                return false;
            });
            CHECK(found == expected);
            expected.clear();
            found.clear();
            for (const auto &[a, x] : known)
                if (a != one && x.overlap(one->getAABB())) expected.insert({a, one});
            manager.collide(one, &found, [](object *a, object *b, void *data) {
                CHECK(static_cast<pairs *>(data)->insert({a, b}).second);
                return false;
            });
            CHECK(found == expected);
            manager.getObjects(listed);
            CHECK(listed.size() == known.size() && manager.size() == known.size() && manager.empty() == known.empty());
            for (object *object : listed) CHECK(known.count(object));
        }
        }
    }
    // A callback may change the manager that calls it.
    struct changing { sap::fcl_manager<S> *manager; std::size_t called = 0; } changing{&others};
    others.update();
    others.collide(&changing, [](object *a, object *b, void *data) {
        auto &changing = *static_cast<struct changing *>(data);
        changing.manager->collide(a, nullptr, [](object *, object *, void *) { return true; });
        changing.manager->unregisterObject(b);
        return ++changing.called == 1;
    });
    CHECK(changing.called == 1 && others.size() == 29);
}

// Several threads may ask; the first of them prepares.
static void threads() {
    scene<S> all(500, 1, 1, 4, 4);
    sap::fcl_manager<S> manager;
    manager.registerObjects(all.objects);
    for (int round = 0; round < 20; round++) {
        for (std::size_t i = 0; i < all.objects.size(); i++) all.move(i, 1);
        manager.update();
        pairs expected;
        for (object *a : all.objects)
            for (object *b : all.objects)
                if (a < b && a->getAABB().overlap(b->getAABB())) expected.insert({a, b});
        std::vector<pairs> found(4);
        std::vector<std::thread> running;
        std::atomic<bool> are_pairs_found{false};
        for (std::size_t thread = 0; thread < found.size(); thread++)
            running.emplace_back([&, thread] {
                found[thread] = pairs_of(false, false, [&](noted *data) {
                    do {
                        for (object *one : all.objects) manager.collide(one, data, note);
                        if (thread == 0) manager.collide(data, note);
                        if (thread == 0) are_pairs_found = true;
                    } while (!are_pairs_found);
                });
            });
        for (auto &thread : running) thread.join();
        for (const auto &pairs : found) CHECK(pairs == expected);
    }
}

// What cannot be searched is refused, and what is infinite is not.
static void extremes() {
    scene<S> all(3, 1, 1, 1, 5);
    object empty{std::shared_ptr<fcl::CollisionGeometry<S>>()};
    object ground(std::make_shared<fcl::Halfspace<S>>(fcl::Vector3<S>(0, 0, 1), 100));
    ground.computeAABB();
    sap::fcl_manager<S> manager;
    manager.registerObjects(all.objects);
    try {
        manager.registerObjects({&ground, &empty});
        CHECK(!"an AABB without points was accepted");
    } catch (const sap::error &error) {
        CHECK(error.status() == SAP_ERROR_INVALID_BOX && error.index() == 1);
    }
    CHECK(manager.size() == 3);
    manager.registerObject(&ground);
    CHECK(pairs_of(true, true, [&](noted *data) { manager.collide(&ground, data, note); }).size() == 3);
    nearest nearest{distance_of::aabbs};
    manager.distance(&ground, &nearest, measure);
    CHECK(nearest.least == 0 && nearest.asked.size() == 1);
    // Turned, its AABB is infinite.
    ground.setQuatRotation(fcl::Quaternion<S>(1, S(0.2), S(0.1), 0).normalized());
    ground.computeAABB();
    CHECK(std::isinf(ground.getAABB().min_[0]));
    for (const bool is_asked : {true, false}) {
        struct nearest found{distance_of::aabbs};
        if (is_asked) manager.distance(&ground, &found, measure);
        else manager.distance(&found, measure);
        CHECK(found.least == 0);
        manager.update(&ground);
    }
    sap::fcl_manager<S> none;
    none.collide(&ground, nullptr, note);
    none.collide(nullptr, note);
    none.distance(&ground, nullptr, measure);
    none.distance(nullptr, measure);
    none.distance(&manager, nullptr, measure);
    manager.distance(&none, nullptr, measure);
    manager.collide(&none, nullptr, note);
}

// The order of pairs is that of registering, wherever the objects are in memory.
static void order() {
    std::vector<std::vector<std::pair<std::size_t, std::size_t>>> orders;
    const scene<S> same(300, 1, 2, 4, 6);
    const std::size_t count = same.objects.size();
    for (const bool is_reversed : {false, true}) {
        std::vector<std::unique_ptr<object>> copies(count);
        for (std::size_t made = 0; made < count; made++) {
            const std::size_t i = is_reversed ? count - 1 - made : made;
            copies[i] = std::make_unique<object>(*same.objects[i]);
            copies[i]->setUserData(reinterpret_cast<void *>(i));
        }
        std::vector<object *> objects;
        for (const auto &copy : copies) objects.push_back(copy.get());
        sap::fcl_manager<S> manager;
        manager.registerObjects(objects);
        orders.emplace_back();
        manager.collide(&orders.back(), [](object *a, object *b, void *data) {
            static_cast<std::vector<std::pair<std::size_t, std::size_t>> *>(data)->emplace_back(
                reinterpret_cast<std::size_t>(a->getUserData()), reinterpret_cast<std::size_t>(b->getUserData()));
            return false;
        });
        CHECK(std::is_sorted(orders.back().begin(), orders.back().end()));
    }
    CHECK(orders[0] == orders[1] && orders[0].size() > 300);
}

int main(int count, char **arguments) {
    const std::size_t steps = count > 1 ? std::size_t(std::atoi(arguments[1])) : 30;
    moving_objects(300, S(0.3), 5, steps, 1);
    moving_objects(40, S(0.01), 20, steps, 2);
    moving_objects(200, 2, 1, steps / 2, 3);
    random_calls(200 * steps);
    threads();
    extremes();
    order();
}
