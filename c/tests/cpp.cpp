// The C++ header: each function does what that of the C interface does, objects are moved and destroyed, errors are thrown.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>

#include <sweep_and_prune.hpp>

#include "check.h"

template <class F> sap_status status_of(F call) {
    try {
        call();
    } catch (const sap::error &error) {
        CHECK(std::string(error.what()).size() > 5);
        return error.status();
    }
    return SAP_OK;
}

template <std::size_t D, class T> struct tests {
    using world = sap::world<D, T>;
    using finder = sap::finder<D, T>;
    using aabb = typename world::aabb;
    using pairs = std::set<std::pair<std::uint64_t, std::uint64_t>>;

    std::uint32_t state = 7;
    std::uint32_t below(std::uint32_t limit) { return (state = state * 1664525u + 1013904223u) / 65536 % limit; }

    std::vector<aabb> random_boxes(std::size_t count) {
        std::vector<aabb> boxes(count);
        for (auto &box : boxes)
            for (std::size_t axis = 0; axis < D; axis++) {
                box.min[axis] = T(below(20));
                box.max[axis] = box.min[axis] + T(below(4));
            }
        return boxes;
    }
    static bool overlap(const aabb &a, const aabb &b) {
        for (std::size_t axis = 0; axis < D; axis++)
            if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
        return true;
    }

    void finds() {
        const auto a = random_boxes(200), b = random_boxes(150);
        pairs within, between;
        for (std::size_t i = 0; i < a.size(); i++) {
            for (std::size_t k = i + 1; k < a.size(); k++)
                if (overlap(a[i], a[k])) within.emplace(i, k);
            for (std::size_t k = 0; k < b.size(); k++)
                if (overlap(a[i], b[k])) between.emplace(i, k);
        }
        finder finder, two(2);
        pairs found;
        for (auto [x, y] : finder.find(a)) CHECK(found.emplace(x, y).second);
        CHECK(found == within && finder.count(a) == within.size() && two.count(a) == within.size());
        found.clear();
        for (auto [x, y] : finder.find(a, b)) CHECK(found.emplace(x, y).second);
        CHECK(found == between && finder.count(a, b) == between.size());
        found.clear();
        finder.each(a, [&](sap::pair pair) { found.emplace(pair.a, pair.b); });
        CHECK(found == within);
        found.clear();
        finder.each(a, b, [&](sap::pair pair) {
            found.emplace(pair.a, pair.b);
            return found.size() < 3;
        });
        CHECK(found.size() == 3);
        // What a callback throws arrives, and the finder can be used again.
        try {
            finder.each(a, [](sap::pair) { throw 42; });
            CHECK(false);
        } catch (int thrown) {
            CHECK(thrown == 42);
        }
        CHECK(status_of([&] { finder.each(a, [&](sap::pair) { finder.count(a); }); }) == SAP_ERROR_BUSY);
        CHECK(finder.count(a) == within.size());
        auto bad = a;
        bad[9].min[0] = bad[9].max[0] + 1;
        try {
            finder.find(a, bad);
            CHECK(false);
        } catch (const sap::error &error) {
            CHECK(error.status() == SAP_ERROR_INVALID_BOX && error.set() == 1 && error.index() == 9);
        }
        auto moved = std::move(finder);
        CHECK(moved.count(a) == within.size());
        CHECK(status_of([&] { finder.count(a); }) == SAP_ERROR_INVALID_ARGUMENT);
        finder = std::move(moved);
        CHECK(finder.count(a) == within.size() && finder.c() != nullptr);
    }

    void tracks() {
        world world;
        auto boxes = random_boxes(300);
        auto ids = world.insert_many(boxes);
        pairs live;
        for (int step = 0; step < 20; step++) {
            const auto changes = world.update();
            for (const auto &pair : changes.begun) CHECK(live.emplace(pair.a, pair.b).second);
            for (const auto &pair : changes.ended) CHECK(live.erase({pair.a, pair.b}) == 1);
            pairs expected, listed;
            for (std::size_t i = 0; i < ids.size(); i++)
                for (std::size_t k = i + 1; k < ids.size(); k++)
                    if (overlap(boxes[i], boxes[k])) expected.emplace(ids[i], ids[k]);
            for (const auto &pair : world.pairs()) listed.emplace(pair.a, pair.b);
            CHECK(live == expected && listed == expected);
            const auto some = random_boxes(50);
            std::copy(some.begin(), some.end(), boxes.begin() + step * 10);
            world.set_many(sap::span<const sap::id>(ids.data() + step * 10, 50), some);
        }
        CHECK(world.size() == 300 && world.ids() == ids);
        queries(world, boxes, ids);

        const auto hash = world.state_hash();
        auto copy = world.copy();
        typename world::options options{};
        options.fat = true;
        options.margin = 1;
        tests::world other(options);
        CHECK(other.state_hash() != hash);
        other.restore(world.snapshot());
        CHECK(copy.state_hash() == hash && other.state_hash() == hash);
        copy.remove(ids[0]);
        copy.remove_many(sap::span<const sap::id>(ids.data() + 1, 2));
        CHECK(copy.size() == 297 && !copy.contains(ids[0]) && world.contains(ids[0]));
        copy.clear();
        CHECK(copy.size() == 0 && copy.state_hash() != hash);
        // What an update reported stays until the next one.
        const auto changes = copy.update();
        const std::vector<sap::id_pair> ended(changes.ended.begin(), changes.ended.end());
        copy.assign(world);
        const auto same = [](const sap::id_pair &a, const sap::id_pair &b) { return a.a == b.a && a.b == b.b; };
        CHECK(!ended.empty() && std::equal(ended.begin(), ended.end(), changes.ended.begin(), changes.ended.end(), same));
        copy.shrink_to_fit();
        CHECK(copy.state_hash() == hash);

        CHECK(status_of([&] { world.set_many(ids, random_boxes(2)); }) == SAP_ERROR_INVALID_ARGUMENT);
        CHECK(status_of([&] { world.remove(sap::no_id); }) == SAP_ERROR_STALE_ID);
        options.margin = -1;
        CHECK(status_of([&] { tests::world bad(options); }) == SAP_ERROR_INVALID_OPTION);
        CHECK(status_of([&] { world.restore(sap::span<const std::uint8_t>()); }) == SAP_ERROR_INVALID_SNAPSHOT);
        auto moved = std::move(world);
        CHECK(moved.size() == 300 && status_of([&] { world.size(); }) == SAP_ERROR_INVALID_ARGUMENT);
        copy = std::move(moved);
        CHECK(copy.size() == 300 && status_of([&] { moved.size(); }) == SAP_ERROR_INVALID_ARGUMENT);
    }

    void queries(world &world, const std::vector<aabb> &boxes, const std::vector<sap::id> &ids) {
        aabb area{};
        for (std::size_t axis = 0; axis < D; axis++) area.min[axis] = 5, area.max[axis] = 12;
        std::vector<sap::id> expected;
        for (std::size_t i = 0; i < ids.size(); i++)
            if (overlap(boxes[i], area)) expected.push_back(ids[i]);
        CHECK(expected.size() > 16); // more than a vector has space for at first
        CHECK(world.overlapping(area) == expected);
        std::vector<sap::id> found;
        world.each_overlapping(area, [&](sap::id id) { found.push_back(id); });
        std::sort(found.begin(), found.end());
        CHECK(found == expected);
        aabb inverted = area;
        inverted.max[0] = inverted.min[0] - 1;
        CHECK(status_of([&] { world.overlapping(inverted, found); }) == SAP_ERROR_INVALID_BOX && found == expected);
        try {
            world.each_overlapping(area, [](sap::id id) { throw id; });
            CHECK(false);
        } catch (sap::id thrown) {
            CHECK(world.contains(thrown));
        }
        sap::query query;
        query.excluded = expected;
        query.unsorted = true;
        CHECK(world.overlapping(area, query).empty());
        query = {};
        const sap::filter nothing{1, 0, 0, false};
        query.filter = &nothing;
        CHECK(world.overlapping(area, query).empty() && !query.filter->allows(sap::filter{}));
        const auto old = world.filter(ids[3]);
        CHECK(old.category == 1 && old.mask == 0xffffffff && old.group == 0 && !old.is_static);
        world.set_filter(ids[3], sap::filter{2, 4, -1, true});
        CHECK(world.filter(ids[3]).is_static && world.filter(ids[3]).group == -1);
        world.set_filter(ids[3], old);
        world.set_enabled(ids[3], false);
        world.exclude_pair(ids[3], ids[4]);
        CHECK(!world.is_enabled(ids[3]) && world.is_excluded(ids[4], ids[3]));
        world.include_pair(ids[4], ids[3]);
        world.set_enabled(ids[3], true);
        CHECK(world.is_enabled(ids[3]) && !world.is_excluded(ids[3], ids[4]));

        world.prepare_queries();
        typename tests::world::point point{};
        point.fill(8);
        CHECK(world.containing(point) == world.within(point, 0));
        CHECK(world.nearest(point, 5).size() == 5 && world.nearest(point, 1000).size() == ids.size());
        CHECK(world.nearest(point, 5, 0).size() == std::min<std::size_t>(5, world.containing(point).size()));
        auto ray = world.ray(point, point, 10);
        const auto hits = world.cast_all(ray);
        const auto first = world.cast(ray);
        CHECK(first.has_value() == !hits.empty() && (hits.empty() || first->id == hits[0].id));
        point.fill(1000);
        CHECK(!world.cast(world.ray(point, point, 10)));
        for (auto id : world.pairs_of(ids[7])) CHECK(world.contains(id));

        const aabb before = world.box(ids[1]);
        world.teleport(ids[1], area);
        world.set(ids[1], area);
        CHECK(world.box(ids[1]).min[0] == 5 && world.reported_box(ids[1]).max[0] == 12);
        world.set_swept(ids[1], area, before);
        point.fill(3);
        world.shift(point);
        point.fill(-3);
        world.shift(point);
        world.set(ids[1], before);
        world.update();
        CHECK(world.insert(area, sap::filter{0, 0, 0, false}) != sap::no_id);
        world.remove(world.ids().back());
    }
};

template <std::size_t D, class T> void test() {
    tests<D, T> tests;
    tests.finds();
    tests.tracks();
}

// A vector of a derived class has larger items, so no span can see it.
struct tagged : sap_aabb3f {
    int tag;
};
static_assert(std::is_constructible_v<sap::span<const sap_aabb3f>, const std::vector<sap_aabb3f> &>);
static_assert(std::is_constructible_v<sap::span<const sap_aabb3f>, std::vector<sap_aabb3f> &>);
static_assert(!std::is_constructible_v<sap::span<sap_aabb3f>, const std::vector<sap_aabb3f> &>);
static_assert(!std::is_constructible_v<sap::span<const sap_aabb3f>, const std::vector<tagged> &>);
static_assert(!std::is_constructible_v<sap::span<const sap_aabb3f>, double>);

int main() {
    test<3, float>();
    test<2, float>();
    test<3, double>();
    test<2, double>();
}
