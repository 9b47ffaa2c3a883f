// sweep-and-prune for C++17 and later: the functions of sweep_and_prune.h as classes. One file, nothing to compile.
//
//     sap::finder3f finder;                                       // also 2f, 3d, 2d; or sap::finder<3, float>
//     for (auto [a, b] : finder.find(boxes)) ...
//
//     sap::world3f world;
//     sap::id hero = world.insert({{0, 0, 0}, {1, 2, 1}});
//     auto changes = world.update();
//     for (auto [a, b] : changes.begun) ...
//
// Handles. Objects can be moved, and are destroyed at the end of their scope. A moved-from object can only be assigned to or
// destroyed; a call throws. `copy` copies a world.
//
// Errors are exceptions of the type sap::error, since constructors can fail, and C++17 has no other way to say so. After one,
// nothing has changed. Compiled without exceptions (-fno-exceptions), an error prints its message and ends the program; call
// the functions of sweep_and_prune.h where you want to handle it.
//
// What a function costs, which errors it has and how long its arrays are valid, is said in sweep_and_prune.h, where it has the
// same name. The thread rules are those of the C interface, too.
#ifndef SWEEP_AND_PRUNE_HPP
#define SWEEP_AND_PRUNE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>
#if defined(__has_include) && __cplusplus >= 202002L
#if __has_include(<span>)
#include <span>
#endif
#endif

#include "sweep_and_prune.h"

namespace sap {

#ifdef __cpp_lib_span
template <class T> using span = std::span<T>;
#else
/// Items in memory that belongs to something else: the part of std::span that is needed here.
template <class T> class span {
public:
    constexpr span() noexcept = default;
    constexpr span(T *items, std::size_t count) noexcept : items(items), count(count) {}
    template <std::size_t N> constexpr span(T (&array)[N]) noexcept : items(array), count(N) {}
    /// The items of a vector, an array or another span, of the same type: those of a derived class are larger.
    template <class C, class Items = std::remove_pointer_t<decltype(std::declval<C &>().data())>,
              class = std::enable_if_t<std::is_convertible_v<Items (*)[], T (*)[]>>>
    constexpr span(C &&container) noexcept : items(container.data()), count(container.size()) {}

    constexpr T *data() const noexcept { return items; }
    constexpr std::size_t size() const noexcept { return count; }
    constexpr bool empty() const noexcept { return count == 0; }
    constexpr T *begin() const noexcept { return items; }
    constexpr T *end() const noexcept { return items + count; }
    constexpr T &operator[](std::size_t index) const noexcept { return items[index]; }

private:
    T *items = nullptr;
    std::size_t count = 0;
};
#endif

using id = sap_id;
using pair = sap_pair;
using id_pair = sap_id_pair;
using neighbor = sap_neighbor;

/// Not the id of any body.
inline constexpr id no_id = SAP_NO_ID;

/// Why a call failed. `what()` is the message of the C interface.
class error : public std::runtime_error {
public:
    explicit error(const sap_error &from)
        : std::runtime_error(from.message), status_of(from.status), set_of(from.set), index_of(from.index) {}

    /// The status of the call.
    sap_status status() const noexcept { return status_of; }
    /// The set of the bad box: 0, or 1 for the second of two sets.
    std::uint32_t set() const noexcept { return set_of; }
    /// The index of the bad box, id or query.
    std::uint64_t index() const noexcept { return index_of; }

private:
    sap_status status_of;
    std::uint32_t set_of;
    std::uint64_t index_of;
};

/// Which bodies may pair: see sap_filter.
struct filter {
    std::uint32_t category = 1;
    std::uint32_t mask = 0xffffffff;
    std::int32_t group = 0;
    bool is_static = false;

    /// Whether two bodies with these filters may pair.
    bool allows(const filter &other) const noexcept {
        const sap_filter a = *this, b = other;
        return sap_filter_allows(&a, &b);
    }
    operator sap_filter() const noexcept { return {category, mask, group, is_static}; }
};

/// Which bodies a query finds, and in which order: see sap_query. By default every body, sorted.
struct query {
    /// If not null, the query finds the bodies that may pair with a body that has this filter.
    const sap::filter *filter = nullptr;
    /// Ids of bodies that it does not find.
    span<const id> excluded{};
    bool unsorted = false;
};

/// What an update found: see sap_changes. The arrays are valid until the next update.
struct changes {
    span<const id_pair> begun;
    span<const id_pair> ended;
    bool empty() const noexcept { return begun.empty() && ended.empty(); }
};

namespace detail {

/// The types and functions of a kind of boxes.
template <std::size_t Dimensions, class Scalar> struct kind;

#define SAP_KIND(name, dimensions, scalar)                                                                             \
    template <> struct kind<dimensions, scalar> {                                                                      \
        using aabb = sap_aabb##name;                                                                                   \
        using options = sap_options##name;                                                                             \
        using cast_t = sap_cast##name;                                                                                 \
        using hit = sap_hit##name;                                                                                     \
        using finder = sap_finder##name;                                                                               \
        using world = sap_world##name;                                                                                 \
        static constexpr auto ray = sap_ray##name;                                                                     \
        static constexpr auto finder_create = sap_finder##name##_create;                                               \
        static constexpr auto finder_destroy = sap_finder##name##_destroy;                                             \
        static constexpr auto find = sap_finder##name##_find;                                                          \
        static constexpr auto find_between = sap_finder##name##_find_between;                                          \
        static constexpr auto count = sap_finder##name##_count;                                                        \
        static constexpr auto count_between = sap_finder##name##_count_between;                                        \
        static constexpr auto each = sap_finder##name##_each;                                                          \
        static constexpr auto each_between = sap_finder##name##_each_between;                                          \
        static constexpr auto world_create = sap_world##name##_create;                                                 \
        static constexpr auto world_destroy = sap_world##name##_destroy;                                               \
        static constexpr auto copy = sap_world##name##_copy;                                                           \
        static constexpr auto assign = sap_world##name##_assign;                                                       \
        static constexpr auto insert = sap_world##name##_insert;                                                       \
        static constexpr auto insert_many = sap_world##name##_insert_many;                                             \
        static constexpr auto set = sap_world##name##_set;                                                             \
        static constexpr auto set_many = sap_world##name##_set_many;                                                   \
        static constexpr auto set_swept = sap_world##name##_set_swept;                                                 \
        static constexpr auto teleport = sap_world##name##_teleport;                                                   \
        static constexpr auto shift = sap_world##name##_shift;                                                         \
        static constexpr auto set_filter = sap_world##name##_set_filter;                                               \
        static constexpr auto set_enabled = sap_world##name##_set_enabled;                                             \
        static constexpr auto exclude_pair = sap_world##name##_exclude_pair;                                           \
        static constexpr auto include_pair = sap_world##name##_include_pair;                                           \
        static constexpr auto is_enabled = sap_world##name##_is_enabled;                                               \
        static constexpr auto is_excluded = sap_world##name##_is_excluded;                                             \
        static constexpr auto remove = sap_world##name##_remove;                                                       \
        static constexpr auto remove_many = sap_world##name##_remove_many;                                             \
        static constexpr auto clear = sap_world##name##_clear;                                                         \
        static constexpr auto update = sap_world##name##_update;                                                       \
        static constexpr auto len = sap_world##name##_len;                                                             \
        static constexpr auto contains = sap_world##name##_contains;                                                   \
        static constexpr auto aabb_of = sap_world##name##_aabb;                                                        \
        static constexpr auto reported_aabb = sap_world##name##_reported_aabb;                                         \
        static constexpr auto filter = sap_world##name##_filter;                                                       \
        static constexpr auto ids = sap_world##name##_ids;                                                             \
        static constexpr auto pairs = sap_world##name##_pairs;                                                         \
        static constexpr auto pairs_of = sap_world##name##_pairs_of;                                                   \
        static constexpr auto snapshot = sap_world##name##_snapshot;                                                   \
        static constexpr auto restore = sap_world##name##_restore;                                                     \
        static constexpr auto state_hash = sap_world##name##_state_hash;                                               \
        static constexpr auto shrink_to_fit = sap_world##name##_shrink_to_fit;                                         \
        static constexpr auto prepare_queries = sap_world##name##_prepare_queries;                                     \
        static constexpr auto overlapping = sap_world##name##_overlapping;                                             \
        static constexpr auto each_overlapping = sap_world##name##_each_overlapping;                                   \
        static constexpr auto containing = sap_world##name##_containing;                                               \
        static constexpr auto within = sap_world##name##_within;                                                       \
        static constexpr auto nearest = sap_world##name##_nearest;                                                     \
        static constexpr auto cast = sap_world##name##_cast;                                                           \
        static constexpr auto cast_all = sap_world##name##_cast_all;                                                   \
    }
SAP_KIND(3f, 3, float);
SAP_KIND(2f, 2, float);
SAP_KIND(3d, 3, double);
SAP_KIND(2d, 2, double);
#undef SAP_KIND

/// Reports an error.
[[noreturn]] inline void fail(const sap_error &failure) {
#ifdef __cpp_exceptions
    throw error(failure);
#else
    std::fprintf(stderr, "sweep-and-prune: %s: %s\n", sap_status_name(failure.status), failure.message);
    std::abort();
#endif
}

/// Calls a function of the C interface and reports its error.
template <class Function, class... Arguments> void call(Function function, Arguments... arguments) {
    sap_error failure;
    if (function(arguments..., &failure) != SAP_OK) fail(failure);
}

inline void check_lengths(std::size_t ids, std::size_t boxes) {
    if (ids == boxes) return;
    sap_error failure{SAP_ERROR_INVALID_ARGUMENT, 0, 0, {}};
    std::snprintf(failure.message, sizeof failure.message, "there are %zu ids but %zu boxes: pass one box for each id", ids, boxes);
    fail(failure);
}

/// Fills a vector by a function that takes an array, its capacity and a place for the count. If that throws, it has written
/// nothing, and the vector is as before.
template <class T, class List> void fill(std::vector<T> &items, List list) {
    struct sized {
        std::vector<T> &items;
        std::size_t size;
        ~sized() { items.resize(size); }
    } result{items, items.size()};
    if (items.capacity() < 16) items.reserve(16);
    for (std::size_t count = 0;; items.reserve(count)) {
        items.resize(items.capacity());
        list(items.data(), items.size(), &count);
        if (count <= items.size()) {
            result.size = count;
            return;
        }
    }
}

/// Whether a callback wants more: what it returns, or yes if that is void.
template <class F, class... Arguments> bool wants_more(F &callback, Arguments... arguments) {
    if constexpr (std::is_void_v<std::invoke_result_t<F &, Arguments...>>) {
        callback(arguments...);
        return true;
    } else {
        return callback(arguments...);
    }
}

/// A callback, and what it threw: an exception may not pass through the C interface, so it waits until the call is over.
template <class F> struct receiver {
    F &callback;
    std::exception_ptr thrown = nullptr;

    template <class Call> bool run(Call call) noexcept {
#ifdef __cpp_exceptions
        try {
            return call();
        } catch (...) {
            thrown = std::current_exception();
            return false;
        }
#else
        return call();
#endif
    }
    static bool pairs(void *context, const sap_pair *pairs, std::size_t count) noexcept {
        auto &self = *static_cast<receiver *>(context);
        return self.run([&] {
            for (std::size_t i = 0; i < count; i++)
                if (!wants_more(self.callback, pairs[i])) return false;
            return true;
        });
    }
    static bool body(void *context, sap_id id) noexcept {
        auto &self = *static_cast<receiver *>(context);
        return self.run([&] { return wants_more(self.callback, id); });
    }
    void end() const {
        if (thrown) std::rethrow_exception(thrown);
    }
};

/// A query as the C interface has it. Points to itself, so it stays where it is.
struct c_query {
    sap_filter filter;
    sap_query query;
    explicit c_query(const sap::query &from)
        : filter(from.filter ? *from.filter : sap::filter{}),
          query{from.filter ? &filter : nullptr, from.excluded.data(), from.excluded.size(), from.unsorted} {}
    c_query(const c_query &) = delete;
};

/// A handle of the C interface, which it destroys.
template <class Handle, void (*const &destroy)(Handle **)> class owner {
public:
    owner() noexcept = default;
    owner(owner &&other) noexcept : handle(std::exchange(other.handle, nullptr)) {}
    owner &operator=(owner &&other) noexcept {
        owner moved(std::move(other));
        std::swap(handle, moved.handle);
        return *this;
    }
    ~owner() { destroy(&handle); }
    operator Handle *() const noexcept { return handle; }
    Handle **place() noexcept { return &handle; }

private:
    Handle *handle = nullptr;
};

} // namespace detail

/// Finds all pairs of boxes that overlap: see sap_finder3f. It keeps its memory from call to call.
template <std::size_t Dimensions, class Scalar> class finder {
    using kind = detail::kind<Dimensions, Scalar>;

public:
    using aabb = typename kind::aabb;
    using boxes = span<const aabb>;

    /// A finder that uses at most this many threads.
    explicit finder(std::uint32_t threads = 1) { detail::call(kind::finder_create, threads, handle.place()); }

    /// The pairs of one set, the smaller index first. Valid until the next call.
    span<const pair> find(boxes set) {
        const pair *pairs;
        std::size_t count;
        detail::call(kind::find, c(), set.data(), set.size(), &pairs, &count);
        return {pairs, count};
    }
    /// The pairs of a box of one set and a box of another. Valid until the next call.
    span<const pair> find(boxes a, boxes b) {
        const pair *pairs;
        std::size_t count;
        detail::call(kind::find_between, c(), a.data(), a.size(), b.data(), b.size(), &pairs, &count);
        return {pairs, count};
    }
    /// How many pairs there are.
    std::uint64_t count(boxes set) {
        std::uint64_t count;
        detail::call(kind::count, c(), set.data(), set.size(), &count);
        return count;
    }
    /// How many pairs there are between two sets.
    std::uint64_t count(boxes a, boxes b) {
        std::uint64_t count;
        detail::call(kind::count_between, c(), a.data(), a.size(), b.data(), b.size(), &count);
        return count;
    }
    /// Calls back with each pair, until the callback returns false, if it returns anything. What it throws is thrown.
    template <class F> void each(boxes set, F &&callback) {
        detail::receiver<F> receiver{callback};
        detail::call(kind::each, c(), set.data(), set.size(), receiver.pairs, &receiver);
        receiver.end();
    }
    /// Calls back with each pair between two sets.
    template <class F> void each(boxes a, boxes b, F &&callback) {
        detail::receiver<F> receiver{callback};
        detail::call(kind::each_between, c(), a.data(), a.size(), b.data(), b.size(), receiver.pairs, &receiver);
        receiver.end();
    }
    /// The handle, for functions of the C interface.
    typename kind::finder *c() const noexcept { return handle; }

private:
    detail::owner<typename kind::finder, kind::finder_destroy> handle;
};

/// The persistent broad phase: see sap_world3f.
template <std::size_t Dimensions, class Scalar> class world {
    using kind = detail::kind<Dimensions, Scalar>;

public:
    using aabb = typename kind::aabb;
    using options = typename kind::options;
    using cast_type = typename kind::cast_t;
    using hit = typename kind::hit;
    using point = std::array<Scalar, Dimensions>;

    world() { detail::call(kind::world_create, static_cast<const options *>(nullptr), handle.place()); }
    explicit world(const options &options) { detail::call(kind::world_create, &options, handle.place()); }

    /// The same world once more.
    world copy() const {
        world made{nullptr};
        detail::call(kind::copy, c(), made.handle.place());
        return made;
    }
    /// Makes this world equal to another one, and uses its memory again.
    void assign(const world &from) { detail::call(kind::assign, c(), from.c()); }

    id insert(const aabb &box, const sap::filter &filter = {}) {
        const sap_filter c_filter = filter;
        id made;
        detail::call(kind::insert, c(), &box, &c_filter, &made);
        return made;
    }
    std::vector<id> insert_many(span<const aabb> boxes, const sap::filter &filter = {}) {
        const sap_filter c_filter = filter;
        std::vector<id> ids(boxes.size());
        detail::call(kind::insert_many, c(), boxes.data(), boxes.size(), &c_filter, ids.data());
        return ids;
    }
    void set(id body, const aabb &box) { detail::call(kind::set, c(), body, &box); }
    void set_many(span<const id> ids, span<const aabb> boxes) {
        detail::check_lengths(ids.size(), boxes.size());
        detail::call(kind::set_many, c(), ids.data(), boxes.data(), boxes.size());
    }
    void set_swept(id body, const aabb &from, const aabb &to) { detail::call(kind::set_swept, c(), body, &from, &to); }
    void teleport(id body, const aabb &box) { detail::call(kind::teleport, c(), body, &box); }
    void shift(const point &offset) { detail::call(kind::shift, c(), offset.data()); }
    void set_filter(id body, const sap::filter &filter) {
        const sap_filter c_filter = filter;
        detail::call(kind::set_filter, c(), body, &c_filter);
    }
    void set_enabled(id body, bool is_enabled) { detail::call(kind::set_enabled, c(), body, is_enabled); }
    void exclude_pair(id a, id b) { detail::call(kind::exclude_pair, c(), a, b); }
    void include_pair(id a, id b) { detail::call(kind::include_pair, c(), a, b); }
    void remove(id body) { detail::call(kind::remove, c(), body); }
    void remove_many(span<const id> ids) { detail::call(kind::remove_many, c(), ids.data(), ids.size()); }
    void clear() { detail::call(kind::clear, c()); }

    sap::changes update() {
        sap_changes found;
        detail::call(kind::update, c(), &found);
        return {{found.begun, found.begun_count}, {found.ended, found.ended_count}};
    }

    std::size_t size() const {
        std::size_t size;
        detail::call(kind::len, c(), &size);
        return size;
    }
    bool contains(id body) const {
        bool contains;
        detail::call(kind::contains, c(), body, &contains);
        return contains;
    }
    aabb box(id body) const {
        aabb box;
        detail::call(kind::aabb_of, c(), body, &box);
        return box;
    }
    aabb reported_box(id body) const {
        aabb box;
        detail::call(kind::reported_aabb, c(), body, &box);
        return box;
    }
    sap::filter filter(id body) const {
        sap_filter found;
        detail::call(kind::filter, c(), body, &found);
        return {found.category, found.mask, found.group, found.is_static};
    }

    bool is_enabled(id body) const {
        bool enabled;
        detail::call(kind::is_enabled, c(), body, &enabled);
        return enabled;
    }
    bool is_excluded(id a, id b) const {
        bool excluded;
        detail::call(kind::is_excluded, c(), a, b, &excluded);
        return excluded;
    }

    // Lists. Each has a form that fills a vector of yours, whose memory is used again.
    std::vector<id> ids() const {
        return made<id>([&](auto... list) { detail::call(kind::ids, c(), list...); });
    }
    std::vector<id_pair> pairs() const {
        std::vector<id_pair> pairs;
        this->pairs(pairs);
        return pairs;
    }
    void pairs(std::vector<id_pair> &pairs) const {
        detail::fill(pairs, [&](auto... list) { detail::call(kind::pairs, c(), list...); });
    }
    std::vector<id> pairs_of(id body) const {
        return made<id>([&](auto... list) { detail::call(kind::pairs_of, c(), body, list...); });
    }

    void prepare_queries() { detail::call(kind::prepare_queries, c()); }
    std::vector<id> overlapping(const aabb &area, const query &query = {}) {
        std::vector<id> ids;
        overlapping(area, ids, query);
        return ids;
    }
    void overlapping(const aabb &area, std::vector<id> &ids, const query &query = {}) {
        const detail::c_query q(query);
        detail::fill(ids, [&](auto... list) { detail::call(kind::overlapping, c(), &area, &q.query, list...); });
    }
    /// Calls back with each body whose box overlaps a box, until the callback returns false, if it returns anything. What it throws
    /// is thrown.
    template <class F> void each_overlapping(const aabb &area, F &&callback, const query &query = {}) {
        const detail::c_query q(query);
        detail::receiver<F> receiver{callback};
        detail::call(kind::each_overlapping, c(), &area, &q.query, receiver.body, &receiver);
        receiver.end();
    }
    std::vector<id> containing(const point &at, const query &query = {}) {
        const detail::c_query q(query);
        return made<id>([&](auto... list) { detail::call(kind::containing, c(), at.data(), &q.query, list...); });
    }
    std::vector<id> within(const point &center, Scalar radius, const query &query = {}) {
        const detail::c_query q(query);
        return made<id>([&](auto... list) { detail::call(kind::within, c(), center.data(), radius, &q.query, list...); });
    }
    /// The `most` nearest bodies, nearest first.
    std::vector<neighbor> nearest(const point &at, std::size_t most,
                                  double max_distance = std::numeric_limits<double>::infinity(), const query &query = {}) {
        const detail::c_query q(query);
        std::vector<neighbor> found(most < size() ? most : size());
        std::size_t count;
        detail::call(kind::nearest, c(), at.data(), max_distance, &q.query, found.data(), found.size(), &count);
        found.resize(count);
        return found;
    }
    /// A ray, for `cast` and `cast_all`.
    static cast_type ray(const point &origin, const point &direction, Scalar limit) {
        return kind::ray(origin.data(), direction.data(), limit);
    }
    /// What a ray or a moving box hits first.
    std::optional<hit> cast(const cast_type &cast, const query &query = {}) {
        const detail::c_query q(query);
        hit found;
        detail::call(kind::cast, c(), &cast, &q.query, &found);
        if (found.id == no_id) return std::nullopt;
        return found;
    }
    std::vector<hit> cast_all(const cast_type &cast, const query &query = {}) {
        std::vector<hit> hits;
        cast_all(cast, hits, query);
        return hits;
    }
    void cast_all(const cast_type &cast, std::vector<hit> &hits, const query &query = {}) {
        const detail::c_query q(query);
        detail::fill(hits, [&](auto... list) { detail::call(kind::cast_all, c(), &cast, &q.query, list...); });
    }

    /// Valid until the next snapshot.
    span<const std::uint8_t> snapshot() {
        const std::uint8_t *bytes;
        std::size_t count;
        detail::call(kind::snapshot, c(), &bytes, &count);
        return {bytes, count};
    }
    void restore(span<const std::uint8_t> bytes) { detail::call(kind::restore, c(), bytes.data(), bytes.size()); }
    std::uint64_t state_hash() const {
        std::uint64_t hash;
        detail::call(kind::state_hash, c(), &hash);
        return hash;
    }
    void shrink_to_fit() { detail::call(kind::shrink_to_fit, c()); }

    /// The handle, for functions of the C interface.
    typename kind::world *c() const noexcept { return handle; }

private:
    explicit world(std::nullptr_t) noexcept {}

    template <class T, class List> static std::vector<T> made(List list) {
        std::vector<T> items;
        detail::fill(items, list);
        return items;
    }

    detail::owner<typename kind::world, kind::world_destroy> handle;
};

using finder3f = finder<3, float>;
using finder2f = finder<2, float>;
using finder3d = finder<3, double>;
using finder2d = finder<2, double>;
using world3f = world<3, float>;
using world2f = world<2, float>;
using world3d = world<3, double>;
using world2d = world<2, double>;

} // namespace sap

#endif
