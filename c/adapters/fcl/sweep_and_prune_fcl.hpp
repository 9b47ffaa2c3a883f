// sweep-and-prune as a broad phase of the Flexible Collision Library (FCL):
//
//     sap::fcl_manager<double> manager; // a fcl::BroadPhaseCollisionManager<double>
//
// Objects take part with the AABB that they had when they were registered, or at the last `update` of them. Callbacks get pairs whose
// AABBs overlap, each once, in an order that is the same on every platform. Those of one manager are sorted by the order in which
// objects were registered, where none was unregistered. Callbacks may ask the manager; one that changes it has to end the search.
// Between two changes several threads may ask at the same time.
//
// Errors are exceptions of the type sap::error, after which nothing has changed: an AABB that is NaN or empty (an object without
// geometry has such a one).
#ifndef SWEEP_AND_PRUNE_FCL_HPP
#define SWEEP_AND_PRUNE_FCL_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fcl/broadphase/broadphase_collision_manager.h>
#include <sweep_and_prune.hpp>

namespace sap {

template <class S> class fcl_manager : public fcl::BroadPhaseCollisionManager<S> {
    using base = fcl::BroadPhaseCollisionManager<S>;
    using world_type = sap::world<3, S>;
    using aabb = typename world_type::aabb;

public:
    using object = fcl::CollisionObject<S>;
    using collision_callback = fcl::CollisionCallBack<S>;
    using distance_callback = fcl::DistanceCallBack<S>;

    /// Uses at most this many threads in updates in which most objects move.
    explicit fcl_manager(std::uint32_t threads = 1) : world(options(threads)) {}
    ~fcl_manager() override = default;
    fcl_manager(const fcl_manager &) = delete;
    fcl_manager &operator=(const fcl_manager &) = delete;

    /// Adds objects. Those that are registered stay as they are.
    void registerObjects(const std::vector<object *> &added) override {
        std::vector<object *> fresh;
        std::vector<aabb> fresh_boxes;
        std::unordered_map<const object *, std::size_t> places;
        for (object *one : added) {
            if (index_of.count(one) || !places.emplace(one, all.objects.size() + fresh.size()).second) continue;
            fresh.push_back(one);
            fresh_boxes.push_back(box_of(*one));
        }
        const auto made = world.insert_many(fresh_boxes);
        note_change();
        for (std::size_t i = 0; i < fresh.size(); i++) {
            if (by_slot.size() <= slot(made[i])) by_slot.resize(slot(made[i]) + 1);
            by_slot[slot(made[i])] = all.objects.size() + i;
        }
        all.objects.insert(all.objects.end(), fresh.begin(), fresh.end());
        all.boxes.insert(all.boxes.end(), fresh_boxes.begin(), fresh_boxes.end());
        ids.insert(ids.end(), made.begin(), made.end());
        index_of.insert(places.begin(), places.end());
    }

    void registerObject(object *added) override { registerObjects({added}); }

    /// Removes an object; one that is not registered is no error.
    void unregisterObject(object *removed) override {
        const auto found = index_of.find(removed);
        if (found == index_of.end()) return;
        const std::size_t index = found->second;
        world.remove(ids[index]);
        note_change();
        index_of.erase(found);
        if (index + 1 < all.objects.size()) {
            all.objects[index] = all.objects.back();
            all.boxes[index] = all.boxes.back();
            ids[index] = ids.back();
            index_of[all.objects[index]] = index;
            by_slot[slot(ids[index])] = index;
        }
        all.objects.pop_back();
        all.boxes.pop_back();
        ids.pop_back();
    }

    /// Nothing is left to do: what a query needs is made when it is asked.
    void setup() override {}

    /// Reads the AABBs of all objects.
    void update() override { read(all.objects); }
    void update(object *moved) override { read({moved}); }
    /// Reads the AABBs of these objects; those that are not registered are left out.
    void update(const std::vector<object *> &moved) override { read(moved); }

    void clear() override {
        world.clear();
        note_change();
        all.objects.clear();
        all.boxes.clear();
        ids.clear();
        by_slot.clear();
        index_of.clear();
    }

    /// The objects, in the order in which they were registered where none was unregistered.
    void getObjects(std::vector<object *> &list) const override { list = all.objects; }
    bool empty() const override { return all.objects.empty(); }
    std::size_t size() const override { return all.objects.size(); }

    void collide(object *asked, void *data, collision_callback callback) const override {
        if (!empty()) each_overlapping(box_of(*asked), asked, [&](object *found) { return callback(found, asked, data); });
    }

    void collide(void *data, collision_callback callback) const override {
        for (const auto &pair : pairs())
            if (callback(object_of(pair.a), object_of(pair.b), data)) return;
    }

    /// Objects of this manager come first. The other one may be of any kind.
    void collide(base *other, void *data, collision_callback callback) const override {
        if (other == this) return collide(data, callback);
        members copied;
        const auto *const alike = dynamic_cast<const fcl_manager *>(other);
        const members &theirs = alike ? alike->all : copy_members(*other, copied);
        if (alike && is_much_smaller(all, theirs)) {
            for (std::size_t i = 0; i < size(); i++)
                if (alike->each_overlapping(all.boxes[i], all.objects[i],
                                             [&](object *found) { return callback(all.objects[i], found, data); }))
                    return;
        } else if (!alike || is_much_smaller(theirs, all)) {
            for (std::size_t i = 0; i < theirs.objects.size(); i++)
                if (each_overlapping(theirs.boxes[i], theirs.objects[i],
                                     [&](object *found) { return callback(found, theirs.objects[i], data); }))
                    return;
        } else {
            sap::finder<3, S> finder;
            for (const auto &pair : finder.find(all.boxes, theirs.boxes)) {
                object *const a = all.objects[pair.a], *const b = theirs.objects[pair.b];
                if (a != b && callback(a, b, data)) return;
            }
        }
    }

    void distance(object *asked, void *data, distance_callback callback) const override {
        S least = std::numeric_limits<S>::max();
        each_near(box_of(*asked), asked, least,
                  [&](object *found, std::size_t) { return callback(found, asked, data, least); });
    }

    void distance(void *data, distance_callback callback) const override {
        S least = std::numeric_limits<S>::max();
        for (std::size_t i = 0; i < size(); i++)
            if (each_near(all.boxes[i], all.objects[i], least, [&](object *found, std::size_t index) {
                    return index > i && callback(all.objects[i], found, data, least);
                }))
                return;
    }

    /// Objects of this manager come first. The other one may be of any kind.
    void distance(base *other, void *data, distance_callback callback) const override {
        if (other == this) return distance(data, callback);
        S least = std::numeric_limits<S>::max();
        members copied;
        const auto *const alike = dynamic_cast<const fcl_manager *>(other);
        const members &theirs = alike ? alike->all : copy_members(*other, copied);
        if (alike && size() < alike->size()) {
            for (std::size_t i = 0; i < size(); i++)
                if (alike->each_near(all.boxes[i], all.objects[i], least, [&](object *found, std::size_t) {
                        return callback(all.objects[i], found, data, least);
                    }))
                    return;
        } else {
            for (std::size_t i = 0; i < theirs.objects.size(); i++)
                if (each_near(theirs.boxes[i], theirs.objects[i], least, [&](object *found, std::size_t) {
                        return callback(found, theirs.objects[i], data, least);
                    }))
                    return;
        }
    }

private:
    /// Objects and their AABBs.
    struct members {
        std::vector<object *> objects;
        std::vector<aabb> boxes;
    };

    /// Copies what a manager of another kind has to an empty list.
    static const members &copy_members(const base &other, members &list) {
        other.getObjects(list.objects);
        for (const object *one : list.objects) list.boxes.push_back(box_of(*one));
        return list;
    }

    static typename world_type::options options(std::uint32_t threads) {
        typename world_type::options options{};
        options.threads = threads;
        return options;
    }
    static aabb box_of(const object &of) {
        const auto &box = of.getAABB();
        return {{box.min_[0], box.min_[1], box.min_[2]}, {box.max_[0], box.max_[1], box.max_[2]}};
    }
    static bool is_equal(const aabb &a, const aabb &b) {
        return std::equal(a.min, a.min + 3, b.min) && std::equal(a.max, a.max + 3, b.max);
    }
    static bool overlap(const aabb &a, const aabb &b) {
        for (int axis = 0; axis < 3; axis++)
            if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
        return true;
    }
    static S distance_between(const aabb &a, const aabb &b) {
        S squares = 0;
        for (int axis = 0; axis < 3; axis++) {
            const S gap = std::max({S(0), a.min[axis] - b.max[axis], b.min[axis] - a.max[axis]});
            squares += gap * gap;
        }
        return std::sqrt(squares);
    }
    static constexpr S infinity = std::numeric_limits<S>::infinity();
    /// A box grown by a distance at each side, rounded outwards.
    static aabb grown(aabb box, S by) {
        for (int axis = 0; axis < 3; axis++) {
            box.min[axis] = std::nextafter(box.min[axis] - by, -infinity);
            box.max[axis] = std::nextafter(box.max[axis] + by, infinity);
        }
        return box;
    }
    /// Whether looking up each object of the smaller manager in the larger one takes less time than finding all pairs of both.
    static bool is_much_smaller(const members &smaller, const members &larger) {
        return 32 * smaller.objects.size() < larger.objects.size();
    }

    static std::size_t slot(sap::id id) { return static_cast<std::uint32_t>(id); }
    object *object_of(sap::id id) const { return all.objects[by_slot[slot(id)]]; }

    void read(const std::vector<object *> &moved) {
        std::vector<sap::id> moved_ids;
        std::vector<aabb> moved_boxes;
        std::vector<std::size_t> places;
        for (std::size_t i = 0; i < moved.size(); i++) {
            std::size_t index = i;
            if (&moved != &all.objects) {
                const auto found = index_of.find(moved[i]);
                if (found == index_of.end()) continue;
                index = found->second;
            }
            const aabb box = box_of(*moved[i]);
            if (is_equal(box, all.boxes[index])) continue;
            moved_ids.push_back(ids[index]);
            moved_boxes.push_back(box);
            places.push_back(index);
        }
        if (moved_ids.empty()) return;
        world.set_many(moved_ids, moved_boxes);
        note_change();
        for (std::size_t i = 0; i < places.size(); i++) all.boxes[places[i]] = moved_boxes[i];
    }

    void note_change() { is_update_due = are_queries_due = true; }

    /// Pairs of this manager, of its objects as they are now.
    std::vector<id_pair> pairs() const {
        std::unique_lock<std::shared_mutex> lock(asking);
        if (is_update_due) {
            world.update();
            is_update_due = false;
            are_queries_due = true;
        }
        return world.pairs();
    }

    /// What a query finds in the world, which several threads may ask at the same time.
    template <class F> auto ask(F query) const {
        for (;;) {
            {
                std::shared_lock<std::shared_mutex> lock(asking);
                if (!are_queries_due) return query(world);
            }
            std::unique_lock<std::shared_mutex> lock(asking);
            if (are_queries_due) world.prepare_queries();
            are_queries_due = false;
        }
    }
    std::vector<sap::id> overlapping(const aabb &box, const sap::id &excluded) const {
        return ask([&](world_type &world) { return world.overlapping(box, all_but(excluded)); });
    }
    std::vector<neighbor> nearest(const std::array<S, 3> &center, std::size_t most, const sap::id &excluded) const {
        return ask([&](world_type &world) {
            return world.nearest(center, most, std::numeric_limits<double>::infinity(), all_but(excluded));
        });
    }

    static sap::query all_but(const sap::id &excluded) {
        sap::query query;
        if (excluded != no_id) query.excluded = sap::span<const sap::id>(&excluded, 1);
        return query;
    }
    sap::id id_of(const object *one) const {
        const auto found = index_of.find(one);
        return found == index_of.end() ? no_id : ids[found->second];
    }

    /// Calls back with each object whose AABB overlaps a box, but for `asked`, until the callback returns true. Whether it did.
    template <class F> bool each_overlapping(const aabb &box, const object *asked, F callback) const {
        const sap::id self = id_of(asked);
        for (const sap::id found : overlapping(box, self))
            if (callback(object_of(found))) return true;
        return false;
    }

    /// Calls back with each object whose AABB is nearer to a box than `least`, which callbacks lower, and with its index: but for
    /// `asked`, and until a callback returns true. Whether one did.
    ///
    /// First comes one that is near. Its distance says how far the others can be; as long as callbacks give none, it looks among
    /// twice as many objects each time.
    template <class F> bool each_near(const aabb &box, const object *asked, S &least, F callback) const {
        constexpr S unknown = std::numeric_limits<S>::max();
        constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
        const sap::id self = id_of(asked);
        std::size_t left = size() - (self != no_id);
        std::array<S, 3> center;
        // Of an infinite AABB any point will do: it only says where to look first.
        const auto finite = [&](S at) { return std::clamp(at, -unknown, unknown); };
        for (int axis = 0; axis < 3; axis++) center[axis] = finite(box.min[axis]) / 2 + finite(box.max[axis]) / 2;

        std::size_t first = none;
        if (least == unknown && left > 0) {
            first = by_slot[slot(nearest(center, 1, self).front().id)];
            if (distance_between(all.boxes[first], box) < least && callback(all.objects[first], first)) return true;
            left--;
        }
        std::vector<std::pair<S, std::size_t>> ring; // the objects that are seen for the first time
        std::optional<aabb> seen;
        for (std::size_t most = 2; left > 0 && least > 0; most *= 2) {
            S reach = least;
            if (least == unknown) {
                const auto around = nearest(center, most, self);
                reach = around.size() < most ? infinity : S(std::sqrt(around.back().distance_squared));
            }
            const aabb searched = grown(box, reach);
            ring.clear();
            for (const sap::id found : overlapping(searched, self)) {
                const std::size_t index = by_slot[slot(found)];
                if (index == first || (seen && overlap(all.boxes[index], *seen))) continue;
                ring.push_back({distance_between(all.boxes[index], box), index});
            }
            std::sort(ring.begin(), ring.end());
            for (const auto &[distance, index] : ring) {
                if (distance >= least) break;
                if (callback(all.objects[index], index)) return true;
            }
            if (reach >= least) return false;
            left -= ring.size();
            seen = searched;
        }
        return false;
    }

    mutable world_type world;
    members all; // with the AABBs that the world has
    std::vector<sap::id> ids;
    std::vector<std::size_t> by_slot; // the index of what has a slot
    std::unordered_map<const object *, std::size_t> index_of;

    mutable std::shared_mutex asking; // alone: while the world changes
    mutable bool is_update_due = false, are_queries_due = false;
};

} // namespace sap

#endif
