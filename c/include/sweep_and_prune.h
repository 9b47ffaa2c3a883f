// sweep-and-prune: finds every overlapping pair of axis-aligned boxes, fast.
//
// Written by c/header from the Rust sources: do not edit.
//
// There are four kinds of boxes: 3f and 2f (3D and 2D, float), 3d and 2d (3D and 2D, double). Each has the same functions:
//
//     sap_finder3f    finds all pairs of one set of boxes, or of two sets
//     sap_world3f     the persistent broad phase: keeps bodies, and reports which overlaps begin and end
//
// Rules for all functions:
//
// Errors. A function that can fail returns a status, and SAP_OK is 0. Its last argument points to an error, which says in words
// what was wrong; it may be NULL. It is written only if the call fails. After a failed call nothing has changed, and no result
// has been written (SAP_ERROR_PANIC is an exception, see there). There is no global state.
//
// Handles. A handle is created by `create` and destroyed by `destroy`, which sets your pointer to NULL. NULL and a handle of
// another type are errors. A handle that was destroyed may not be used, as memory that was freed; copies of the pointer are
// your concern.
//
// Threads. Different handles can be used by different threads at the same time. One handle can be moved from thread to thread.
// Functions that take a `const` handle can run at the same time as each other, and so can queries of a prepared world
// (sap_world3f_prepare_queries). Any other call while one is running returns SAP_ERROR_BUSY and does nothing.
//
// Memory. What a function reads, it reads during the call only. Arrays that the library owns say how long they are valid. A
// function that writes a list takes the capacity of your array and says how many items there are in all; if there are more
// than fit, the first ones are written, and you can call it again with a larger array.
//
// Pointers. They must point to what their type says, for as many items as the count says, and be aligned for it. An array of
// count 0 may be NULL.

#ifndef SWEEP_AND_PRUNE_H
#define SWEEP_AND_PRUNE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// How many bytes the message of an error has at most, the final zero included.
#define SAP_MESSAGE_SIZE 240

/// How a call ended. After any status but `SAP_OK` the call has changed nothing and written no result, with one
/// exception: see `SAP_ERROR_PANIC`.
enum sap_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// The call did what it should.
    SAP_OK = 0,
    /// A pointer is NULL that must not be, or not aligned for its type; or a count is larger than memory can be.
    SAP_ERROR_INVALID_ARGUMENT = 1,
    /// A handle is not of the type that this function takes.
    SAP_ERROR_WRONG_HANDLE = 2,
    /// The handle is in use: by another thread, or by the call that runs this callback.
    SAP_ERROR_BUSY = 3,
    /// A box is inverted or NaN: `min <= max` does not hold on each axis. `index` is that of the box.
    SAP_ERROR_INVALID_BOX = 4,
    /// No body of this world has the id: its body was removed, or the id is of another world. `index` is that of the id.
    SAP_ERROR_STALE_ID = 5,
    /// An option of a world is negative, infinite or NaN.
    SAP_ERROR_INVALID_OPTION = 6,
    /// The offset of a shift is infinite or NaN.
    SAP_ERROR_INVALID_OFFSET = 7,
    /// An argument of a query is NaN, or infinite or negative where it must not be.
    SAP_ERROR_INVALID_QUERY = 8,
    /// The bytes are not a snapshot of a world of this kind, or they are damaged.
    SAP_ERROR_INVALID_SNAPSHOT = 9,
    /// More boxes than 2^32 - 1, which is how many one set can have.
    SAP_ERROR_TOO_MANY_BOXES = 10,
    /// The pairs, the memory for finding them, or the answer to a query do not fit. Counting and streaming need less.
    SAP_ERROR_OUT_OF_MEMORY = 11,
    /// The threads that a handle should have could not be started.
    SAP_ERROR_THREADS = 12,
    /// The library has a bug, which this call met. The handle may be half changed: all that it accepts from now on is to be
    /// destroyed.
    SAP_ERROR_PANIC = 13,
    /// An earlier call with this handle ended with `SAP_ERROR_PANIC`. Destroy it.
    SAP_ERROR_POISONED = 14,
    /// An error that this version has no number for. The message says what it is.
    SAP_ERROR_OTHER = 15,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sap_status sap_status;
#else
typedef int32_t sap_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// Finds all pairs of boxes that overlap, each once, in an order that depends on the boxes alone. It keeps its memory from call
/// to call: a search like the one before allocates nothing.
typedef struct sap_finder2d sap_finder2d;

/// Finds all pairs of boxes that overlap, each once, in an order that depends on the boxes alone. It keeps its memory from call
/// to call: a search like the one before allocates nothing.
typedef struct sap_finder2f sap_finder2f;

/// Finds all pairs of boxes that overlap, each once, in an order that depends on the boxes alone. It keeps its memory from call
/// to call: a search like the one before allocates nothing.
typedef struct sap_finder3d sap_finder3d;

/// Finds all pairs of boxes that overlap, each once, in an order that depends on the boxes alone. It keeps its memory from call
/// to call: a search like the one before allocates nothing.
typedef struct sap_finder3f sap_finder3f;

/// The persistent broad phase: a set of bodies, each with a box, that reports which overlaps begin and which end. The same
/// calls give the same results on every platform. Where memory runs out the program ends, except in an update whose pairs do not
/// fit and in a query whose answer does not: these return `SAP_ERROR_OUT_OF_MEMORY`.
typedef struct sap_world2d sap_world2d;

/// The persistent broad phase: a set of bodies, each with a box, that reports which overlaps begin and which end. The same
/// calls give the same results on every platform. Where memory runs out the program ends, except in an update whose pairs do not
/// fit and in a query whose answer does not: these return `SAP_ERROR_OUT_OF_MEMORY`.
typedef struct sap_world2f sap_world2f;

/// The persistent broad phase: a set of bodies, each with a box, that reports which overlaps begin and which end. The same
/// calls give the same results on every platform. Where memory runs out the program ends, except in an update whose pairs do not
/// fit and in a query whose answer does not: these return `SAP_ERROR_OUT_OF_MEMORY`.
typedef struct sap_world3d sap_world3d;

/// The persistent broad phase: a set of bodies, each with a box, that reports which overlaps begin and which end. The same
/// calls give the same results on every platform. Where memory runs out the program ends, except in an update whose pairs do not
/// fit and in a query whose answer does not: these return `SAP_ERROR_OUT_OF_MEMORY`.
typedef struct sap_world3f sap_world3f;

/// Which bodies may pair. Two bodies pair if their boxes overlap, not both are static, and: they have the same group, which is
/// greater than 0; or they do not have the same group (or both have 0), and the category of each has a bit in the mask of
/// the other. So a negative group keeps its bodies apart, and a positive one joins them.
typedef struct sap_filter {
    /// What the body is: bits. 1 by default.
    uint32_t category;
    /// What it pairs with: the categories of others. All bits by default.
    uint32_t mask;
    /// The group. 0, which is no group, by default.
    int32_t group;
    /// Whether it is static: two static bodies never pair. False by default.
    bool is_static;
} sap_filter;

/// What was wrong. Functions that can fail take a pointer to one, which may be NULL. They write it only if they fail.
typedef struct sap_error {
    /// What the function returned.
    sap_status status;
    /// Which of two sets of boxes has the bad box: 0, or 1 for the second.
    uint32_t set;
    /// The index of the bad box, id or query in the array that was passed; 0 where there is no array.
    uint64_t index;
    /// A sentence in UTF-8 that ends with a zero. It names the argument, its value and the limit that the value broke.
    char message[SAP_MESSAGE_SIZE];
} sap_error;

/// An axis-aligned box. It is valid if `min <= max` on each axis; points, flat boxes and infinite edges are valid, NaN is not.
/// Boxes that touch each other overlap.
typedef struct sap_aabb3f {
    /// The min corner.
    float min[3];
    /// The max corner.
    float max[3];
} sap_aabb3f;

/// Two boxes that overlap: the smaller index first, or an index of the first set and an index of the second.
typedef struct sap_pair {
    /// The index of a box.
    uint32_t a;
    /// The index of the other box.
    uint32_t b;
} sap_pair;

/// Receives pairs, 1 to 4096 in a call, and returns whether it wants more. It must return: it may neither throw nor jump out of
/// the call. The pairs are valid during the call. `context` is what was passed to the function that calls it.
typedef bool (*sap_pairs_callback)(void *context, const struct sap_pair *pairs, size_t count);

/// How a world treats its boxes. All zeros: the pairs of the exact boxes, one thread.
typedef struct sap_options3f {
    /// Whether the pairs of fattened AABBs are reported, which begin and end less often than those of the boxes themselves.
    bool fat;
    /// How far a fat AABB reaches beyond the box on every side, in units of length: finite, 0 or more. Not read unless `fat`.
    float margin;
    /// How many displacements of the last update it reaches ahead: finite, 0 or more. Not read unless `fat`.
    float prediction;
    /// The most threads of updates in which most bodies move; 0 counts as 1. The threads are the world's own, and no more than
    /// there are processors. Results do not depend on them.
    uint32_t threads;
} sap_options3f;

/// The id of a body in a world. Ids of removed bodies are not given out again. A 64-bit number, which is never 0: its lower
/// half is a slot (a small number that is reused after its body was removed, so an index for tables of your own), its upper
/// half how many bodies have had this slot.
typedef uint64_t sap_id;

/// Two bodies that overlap: the id with the smaller slot first.
typedef struct sap_id_pair {
    /// The id of a body.
    sap_id a;
    /// The id of the other body.
    sap_id b;
} sap_id_pair;

/// What an update found: pairs that began and pairs that ended since the update before, each once, sorted by slot. The arrays
/// belong to the world, and are valid until the next update, the next restore, or the end of the world.
typedef struct sap_changes {
    /// The pairs that overlap now and did not before. NULL if there are none.
    const struct sap_id_pair *begun;
    /// How many pairs began.
    size_t begun_count;
    /// The pairs that overlapped before and do not now, or of which a body was removed. NULL if there are none.
    const struct sap_id_pair *ended;
    /// How many pairs ended.
    size_t ended_count;
} sap_changes;

/// A moving box, or a ray. It is at `from + t * direction` for each t from 0 to `limit`.
typedef struct sap_cast3f {
    /// The box at t = 0. For a ray both corners are its origin.
    struct sap_aabb3f from;
    /// How far it moves as t grows by 1: of any length, finite. If its length is 1, t is a distance.
    float direction[3];
    /// The largest t: 0 or more, may be infinite.
    float limit;
    /// Whether it hits only what it enters: what it touches at its start and moves away from, or slides along, is not hit.
    bool ignore_touching;
} sap_cast3f;

/// Which bodies a query finds, and in which order. Functions take a pointer to one; NULL, as well as all zeros, means: every
/// body, sorted.
typedef struct sap_query {
    /// If not NULL, the query finds the bodies that may pair with a body that has this filter.
    const struct sap_filter *filter;
    /// The ids of bodies that it does not find. May be NULL if there are none. Stale ids exclude nothing.
    const sap_id *excluded;
    /// How many ids these are. Each body that is found is compared with all of them.
    size_t excluded_count;
    /// Whether bodies in a region may be listed in any order, which takes less time: three quarters for 100 bodies, half for
    /// 10,000.
    bool unsorted;
} sap_query;

/// Receives a body and returns whether it wants more. It must return: it may neither throw nor jump out of the call. `context`
/// is what was passed to the function that calls it.
typedef bool (*sap_body_callback)(void *context, sap_id id);

/// A body near a point.
typedef struct sap_neighbor {
    /// The id of the body.
    sap_id id;
    /// The square of the distance from the point to its box: 0 if the point is in the box.
    double distance_squared;
} sap_neighbor;

/// A body that a cast hits.
typedef struct sap_hit3f {
    /// The id of the body; `SAP_NO_ID` if nothing is hit.
    sap_id id;
    /// Where the hit is: at `from + t * direction`. 0 if they overlap at the start.
    double t;
    /// Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts inside the
    /// body. At an edge or a corner, the face of the first axis.
    float normal[3];
    /// Whether the insides of the boxes overlap at the start.
    bool starts_inside;
} sap_hit3f;

/// An axis-aligned box. It is valid if `min <= max` on each axis; points, flat boxes and infinite edges are valid, NaN is not.
/// Boxes that touch each other overlap.
typedef struct sap_aabb2f {
    /// The min corner.
    float min[2];
    /// The max corner.
    float max[2];
} sap_aabb2f;

/// How a world treats its boxes. All zeros: the pairs of the exact boxes, one thread.
typedef struct sap_options2f {
    /// Whether the pairs of fattened AABBs are reported, which begin and end less often than those of the boxes themselves.
    bool fat;
    /// How far a fat AABB reaches beyond the box on every side, in units of length: finite, 0 or more. Not read unless `fat`.
    float margin;
    /// How many displacements of the last update it reaches ahead: finite, 0 or more. Not read unless `fat`.
    float prediction;
    /// The most threads of updates in which most bodies move; 0 counts as 1. The threads are the world's own, and no more than
    /// there are processors. Results do not depend on them.
    uint32_t threads;
} sap_options2f;

/// A moving box, or a ray. It is at `from + t * direction` for each t from 0 to `limit`.
typedef struct sap_cast2f {
    /// The box at t = 0. For a ray both corners are its origin.
    struct sap_aabb2f from;
    /// How far it moves as t grows by 1: of any length, finite. If its length is 1, t is a distance.
    float direction[2];
    /// The largest t: 0 or more, may be infinite.
    float limit;
    /// Whether it hits only what it enters: what it touches at its start and moves away from, or slides along, is not hit.
    bool ignore_touching;
} sap_cast2f;

/// A body that a cast hits.
typedef struct sap_hit2f {
    /// The id of the body; `SAP_NO_ID` if nothing is hit.
    sap_id id;
    /// Where the hit is: at `from + t * direction`. 0 if they overlap at the start.
    double t;
    /// Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts inside the
    /// body. At an edge or a corner, the face of the first axis.
    float normal[2];
    /// Whether the insides of the boxes overlap at the start.
    bool starts_inside;
} sap_hit2f;

/// An axis-aligned box. It is valid if `min <= max` on each axis; points, flat boxes and infinite edges are valid, NaN is not.
/// Boxes that touch each other overlap.
typedef struct sap_aabb3d {
    /// The min corner.
    double min[3];
    /// The max corner.
    double max[3];
} sap_aabb3d;

/// How a world treats its boxes. All zeros: the pairs of the exact boxes, one thread.
typedef struct sap_options3d {
    /// Whether the pairs of fattened AABBs are reported, which begin and end less often than those of the boxes themselves.
    bool fat;
    /// How far a fat AABB reaches beyond the box on every side, in units of length: finite, 0 or more. Not read unless `fat`.
    double margin;
    /// How many displacements of the last update it reaches ahead: finite, 0 or more. Not read unless `fat`.
    double prediction;
    /// The most threads of updates in which most bodies move; 0 counts as 1. The threads are the world's own, and no more than
    /// there are processors. Results do not depend on them.
    uint32_t threads;
} sap_options3d;

/// A moving box, or a ray. It is at `from + t * direction` for each t from 0 to `limit`.
typedef struct sap_cast3d {
    /// The box at t = 0. For a ray both corners are its origin.
    struct sap_aabb3d from;
    /// How far it moves as t grows by 1: of any length, finite. If its length is 1, t is a distance.
    double direction[3];
    /// The largest t: 0 or more, may be infinite.
    double limit;
    /// Whether it hits only what it enters: what it touches at its start and moves away from, or slides along, is not hit.
    bool ignore_touching;
} sap_cast3d;

/// A body that a cast hits.
typedef struct sap_hit3d {
    /// The id of the body; `SAP_NO_ID` if nothing is hit.
    sap_id id;
    /// Where the hit is: at `from + t * direction`. 0 if they overlap at the start.
    double t;
    /// Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts inside the
    /// body. At an edge or a corner, the face of the first axis.
    double normal[3];
    /// Whether the insides of the boxes overlap at the start.
    bool starts_inside;
} sap_hit3d;

/// An axis-aligned box. It is valid if `min <= max` on each axis; points, flat boxes and infinite edges are valid, NaN is not.
/// Boxes that touch each other overlap.
typedef struct sap_aabb2d {
    /// The min corner.
    double min[2];
    /// The max corner.
    double max[2];
} sap_aabb2d;

/// How a world treats its boxes. All zeros: the pairs of the exact boxes, one thread.
typedef struct sap_options2d {
    /// Whether the pairs of fattened AABBs are reported, which begin and end less often than those of the boxes themselves.
    bool fat;
    /// How far a fat AABB reaches beyond the box on every side, in units of length: finite, 0 or more. Not read unless `fat`.
    double margin;
    /// How many displacements of the last update it reaches ahead: finite, 0 or more. Not read unless `fat`.
    double prediction;
    /// The most threads of updates in which most bodies move; 0 counts as 1. The threads are the world's own, and no more than
    /// there are processors. Results do not depend on them.
    uint32_t threads;
} sap_options2d;

/// A moving box, or a ray. It is at `from + t * direction` for each t from 0 to `limit`.
typedef struct sap_cast2d {
    /// The box at t = 0. For a ray both corners are its origin.
    struct sap_aabb2d from;
    /// How far it moves as t grows by 1: of any length, finite. If its length is 1, t is a distance.
    double direction[2];
    /// The largest t: 0 or more, may be infinite.
    double limit;
    /// Whether it hits only what it enters: what it touches at its start and moves away from, or slides along, is not hit.
    bool ignore_touching;
} sap_cast2d;

/// A body that a cast hits.
typedef struct sap_hit2d {
    /// The id of the body; `SAP_NO_ID` if nothing is hit.
    sap_id id;
    /// Where the hit is: at `from + t * direction`. 0 if they overlap at the start.
    double t;
    /// Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts inside the
    /// body. At an edge or a corner, the face of the first axis.
    double normal[2];
    /// Whether the insides of the boxes overlap at the start.
    bool starts_inside;
} sap_hit2d;

/// Not the id of any body.
#define SAP_NO_ID 0

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/// The filter of a body if nothing else is said: category 1, all bits in the mask, no group, not static.
struct sap_filter sap_filter_default(void);

/// Whether two bodies with these filters may pair. NULL means the default filter.
bool sap_filter_allows(const struct sap_filter *a, const struct sap_filter *b);

/// The version of the library, as "0.1.0".
const char *sap_version(void);

/// The name of a status, as "SAP_ERROR_STALE_ID"; "unknown status" for a number that is none.
const char *sap_status_name(int32_t status);

/// Creates a finder that uses at most `threads` threads, and no more than there are processors; 0 counts as 1. The threads are
/// the finder's own. Destroy it by `sap_finder3f_destroy`.
sap_status sap_finder3f_create(uint32_t threads,
                               struct sap_finder3f **finder,
                               struct sap_error *error);

/// Destroys a finder and sets the pointer to it to NULL. Does nothing if `finder` or the pointer that it points to is NULL, or
/// if the finder is in use.
void sap_finder3f_destroy(struct sap_finder3f **finder);

/// Finds the pairs of boxes of one set that overlap, the smaller index first. `*pairs` points to memory of the finder, which
/// is valid until its next call; NULL if there are no pairs. Takes O(n log n + pairs) time on typical inputs.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`, `SAP_ERROR_OUT_OF_MEMORY`.
sap_status sap_finder3f_find(struct sap_finder3f *finder,
                             const struct sap_aabb3f *boxes,
                             size_t count,
                             const struct sap_pair **pairs,
                             size_t *pair_count,
                             struct sap_error *error);

/// Finds the pairs of a box of the set `a` and a box of the set `b` that overlap: `a` of a pair is an index of the first set,
/// `b` an index of the second. Otherwise as `sap_finder3f_find`.
sap_status sap_finder3f_find_between(struct sap_finder3f *finder,
                                     const struct sap_aabb3f *a,
                                     size_t a_count,
                                     const struct sap_aabb3f *b,
                                     size_t b_count,
                                     const struct sap_pair **pairs,
                                     size_t *pair_count,
                                     struct sap_error *error);

/// Finds the pairs of `sap_finder3f_find` and writes the first `capacity` of them to `pairs`, which may be NULL if `capacity`
/// is 0. `*pair_count` is how many there are in all. Uses one thread, and no memory for pairs.
///
/// Errors: as `sap_finder3f_find`. If a box is invalid, nothing has been written.
sap_status sap_finder3f_find_into(struct sap_finder3f *finder,
                                  const struct sap_aabb3f *boxes,
                                  size_t count,
                                  struct sap_pair *pairs,
                                  size_t capacity,
                                  size_t *pair_count,
                                  struct sap_error *error);

/// Finds the pairs of `sap_finder3f_find_between`. Otherwise as `sap_finder3f_find_into`.
sap_status sap_finder3f_find_between_into(struct sap_finder3f *finder,
                                          const struct sap_aabb3f *a,
                                          size_t a_count,
                                          const struct sap_aabb3f *b,
                                          size_t b_count,
                                          struct sap_pair *pairs,
                                          size_t capacity,
                                          size_t *pair_count,
                                          struct sap_error *error);

/// Counts the pairs of `sap_finder3f_find` without storing them.
///
/// Errors: as `sap_finder3f_find`.
sap_status sap_finder3f_count(struct sap_finder3f *finder,
                              const struct sap_aabb3f *boxes,
                              size_t count,
                              uint64_t *pair_count,
                              struct sap_error *error);

/// Counts the pairs of `sap_finder3f_find_between` without storing them.
///
/// Errors: as `sap_finder3f_find`.
sap_status sap_finder3f_count_between(struct sap_finder3f *finder,
                                      const struct sap_aabb3f *a,
                                      size_t a_count,
                                      const struct sap_aabb3f *b,
                                      size_t b_count,
                                      uint64_t *pair_count,
                                      struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder3f_find`, in their order, until it returns false. Uses one thread, and no
/// memory for pairs. The callback cannot use this finder: `SAP_ERROR_BUSY`.
///
/// Errors: as `sap_finder3f_find`. If a box is invalid, the callback has not been called.
sap_status sap_finder3f_each(struct sap_finder3f *finder,
                             const struct sap_aabb3f *boxes,
                             size_t count,
                             sap_pairs_callback callback,
                             void *context,
                             struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder3f_find_between`. Otherwise as `sap_finder3f_each`.
sap_status sap_finder3f_each_between(struct sap_finder3f *finder,
                                     const struct sap_aabb3f *a,
                                     size_t a_count,
                                     const struct sap_aabb3f *b,
                                     size_t b_count,
                                     sap_pairs_callback callback,
                                     void *context,
                                     struct sap_error *error);

/// Creates an empty world. `options` may be NULL, which is the same as all zeros. Destroy the world by `sap_world3f_destroy`.
///
/// Errors: `SAP_ERROR_INVALID_OPTION`, `SAP_ERROR_THREADS`.
sap_status sap_world3f_create(const struct sap_options3f *options,
                              struct sap_world3f **world,
                              struct sap_error *error);

/// Destroys a world and sets the pointer to it to NULL. Does nothing if `world` or the pointer that it points to is NULL, or if
/// the world is in use.
void sap_world3f_destroy(struct sap_world3f **world);

/// Copies a world: the copy has the same bodies under the same ids, and continues as the world would. For rollback this is
/// faster than a snapshot. Takes O(n + pairs) time.
///
/// Errors: `SAP_ERROR_THREADS`.
sap_status sap_world3f_copy(const struct sap_world3f *world,
                            struct sap_world3f **copy,
                            struct sap_error *error);

/// Makes a world equal to another one, as if it were a copy. Its memory is used again, so that saving a world now and then, in
/// turn to the same few worlds, allocates little. Keeps the threads of `world`. If `world` and `from` are the same:
/// `SAP_ERROR_BUSY`.
sap_status sap_world3f_assign(struct sap_world3f *world,
                              const struct sap_world3f *from,
                              struct sap_error *error);

/// Adds a body. `filter` may be NULL, which is the default filter. `id` may be NULL if the id is not needed.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`.
sap_status sap_world3f_insert(struct sap_world3f *world,
                              const struct sap_aabb3f *aabb,
                              const struct sap_filter *filter,
                              sap_id *id,
                              struct sap_error *error);

/// Adds a body for each of `count` boxes, all with the same filter, which may be NULL. Writes `count` ids to `ids`, in the
/// order of the boxes; `ids` may be NULL if they are not needed.
///
/// Errors: as `sap_world3f_insert`; then no body has been added.
sap_status sap_world3f_insert_many(struct sap_world3f *world,
                                   const struct sap_aabb3f *boxes,
                                   size_t count,
                                   const struct sap_filter *filter,
                                   sap_id *ids,
                                   struct sap_error *error);

/// Gives a body another box: it moved there. You don't have to track which bodies moved; a body whose box stays the same costs
/// next to nothing.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3f_set(struct sap_world3f *world,
                           sap_id id,
                           const struct sap_aabb3f *aabb,
                           struct sap_error *error);

/// Gives `count` bodies other boxes: `boxes[i]` to `ids[i]`. Of an id that is there twice the last box counts. Takes less time
/// than a call for each.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`; then no box has been set.
sap_status sap_world3f_set_many(struct sap_world3f *world,
                                const sap_id *ids,
                                const struct sap_aabb3f *boxes,
                                size_t count,
                                struct sap_error *error);

/// Moves a body from one box to another: the next update sees the smallest box that contains both, so that nothing is missed on
/// the way; the update after it sees `to`, if the body is not set before.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX` (`index` is 0 for `from` and 1 for `to`).
sap_status sap_world3f_set_swept(struct sap_world3f *world,
                                 sap_id id,
                                 const struct sap_aabb3f *from,
                                 const struct sap_aabb3f *to,
                                 struct sap_error *error);

/// Gives a body another box, to which it did not move: a fat AABB does not reach ahead after it. For exact boxes the same as
/// `sap_world3f_set`.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3f_teleport(struct sap_world3f *world,
                                sap_id id,
                                const struct sap_aabb3f *aabb,
                                struct sap_error *error);

/// Adds an offset to all boxes, for an origin that follows the player. `offset` points to 3 numbers, one for each axis.
/// Coordinates are rounded, so pairs that barely touch may begin or end.
///
/// Errors: `SAP_ERROR_INVALID_OFFSET`.
sap_status sap_world3f_shift(struct sap_world3f *world,
                             const float *offset,
                             struct sap_error *error);

/// Gives a body another filter, which counts from the next update on. NULL is the default filter.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_set_filter(struct sap_world3f *world,
                                  sap_id id,
                                  const struct sap_filter *filter,
                                  struct sap_error *error);

/// Disables a body (`false`), or enables it again. While it is disabled it pairs with no other, and queries do not find it; its
/// box and its filter can be set. Its pairs end or begin at the next update.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_set_enabled(struct sap_world3f *world,
                                   sap_id id,
                                   bool is_enabled,
                                   struct sap_error *error);

/// Excludes a pair, whatever the filters of its bodies allow: those of a joint, say. It ends at the next update if it was there,
/// and does not begin until it is included again. A body that is removed is forgotten, and a pair of a body with itself is never
/// there.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world3f_exclude_pair(struct sap_world3f *world,
                                    sap_id a,
                                    sap_id b,
                                    struct sap_error *error);

/// Includes a pair that was excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world3f_include_pair(struct sap_world3f *world, sap_id a, sap_id b, struct sap_error *error);

/// Removes a body. The next update reports the end of its pairs.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_remove(struct sap_world3f *world, sap_id id, struct sap_error *error);

/// Removes `count` bodies.
///
/// Errors: `SAP_ERROR_STALE_ID` with the index of the first id that is stale or there twice; then no body has been removed.
sap_status sap_world3f_remove_many(struct sap_world3f *world,
                                   const sap_id *ids,
                                   size_t count,
                                   struct sap_error *error);

/// Removes all bodies. The next update reports the end of all pairs.
sap_status sap_world3f_clear(struct sap_world3f *world, struct sap_error *error);

/// Finds the pairs that began and those that ended since the last update. `changes` may be NULL if they are not needed.
///
/// Takes time in proportion to the bodies that changed and their neighbors.
///
/// Errors: `SAP_ERROR_OUT_OF_MEMORY` if the pairs of a crowd do not fit. The next call then reports what this one should have.
sap_status sap_world3f_update(struct sap_world3f *world,
                              struct sap_changes *changes,
                              struct sap_error *error);

/// How many bodies there are.
sap_status sap_world3f_len(const struct sap_world3f *world, size_t *len, struct sap_error *error);

/// Whether an id names a body that is here. No id is an error.
sap_status sap_world3f_contains(const struct sap_world3f *world,
                                sap_id id,
                                bool *contains,
                                struct sap_error *error);

/// The box of a body as last set. That of a swept body is, until the next update, the smallest one that contains both of its
/// boxes.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_aabb(const struct sap_world3f *world,
                            sap_id id,
                            struct sap_aabb3f *aabb,
                            struct sap_error *error);

/// The box of a body whose overlaps are reported: its fat AABB if the world has the option `fat`, otherwise its box.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_reported_aabb(const struct sap_world3f *world,
                                     sap_id id,
                                     struct sap_aabb3f *aabb,
                                     struct sap_error *error);

/// The filter of a body.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_filter(const struct sap_world3f *world,
                              sap_id id,
                              struct sap_filter *filter,
                              struct sap_error *error);

/// Whether a body is enabled, as it is until `sap_world3f_set_enabled` says otherwise.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_is_enabled(const struct sap_world3f *world,
                                  sap_id id,
                                  bool *is_enabled,
                                  struct sap_error *error);

/// Whether a pair is excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world3f_is_excluded(const struct sap_world3f *world,
                                   sap_id a,
                                   sap_id b,
                                   bool *is_excluded,
                                   struct sap_error *error);

/// The ids of all bodies, sorted by slot. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all.
sap_status sap_world3f_ids(const struct sap_world3f *world,
                           sap_id *ids,
                           size_t capacity,
                           size_t *count,
                           struct sap_error *error);

/// The pairs that overlapped at the last update, each once, sorted by slot. Writes the first `capacity` of them to `pairs`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(pairs) time and memory.
sap_status sap_world3f_pairs(const struct sap_world3f *world,
                             struct sap_id_pair *pairs,
                             size_t capacity,
                             size_t *count,
                             struct sap_error *error);

/// The bodies that overlapped this one at the last update, sorted by slot. Writes the first `capacity` of them to `ids`, which
/// may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(log n) time and that of its neighbors after
/// `sap_world3f_prepare_queries` until the next update, otherwise O(pairs) time.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3f_pairs_of(const struct sap_world3f *world,
                                sap_id id,
                                sap_id *ids,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

/// The whole state as bytes. `*bytes` points to memory of the world, which is valid until its next snapshot, or its end. A
/// world restored from them gives, for the same calls, the same ids, events and results, bit for bit, on every platform. Takes
/// O(n) time.
sap_status sap_world3f_snapshot(struct sap_world3f *world,
                                const uint8_t **bytes,
                                size_t *count,
                                struct sap_error *error);

/// Makes a world that of a snapshot, with its options and ids; the bodies that it had are gone. Any bytes give a world or an
/// error. Keeps its threads. Takes the time of finding all pairs.
///
/// Errors: `SAP_ERROR_INVALID_SNAPSHOT`.
sap_status sap_world3f_restore(struct sap_world3f *world,
                               const uint8_t *bytes,
                               size_t count,
                               struct sap_error *error);

/// A hash of the whole state: equal for equal states, on every platform. It shows whether two machines that run the same
/// simulation diverged. Takes O(n) time and memory.
sap_status sap_world3f_state_hash(const struct sap_world3f *world,
                                  uint64_t *hash,
                                  struct sap_error *error);

/// Gives back memory that is not needed now, and changes no result. Takes O(n + pairs) time.
sap_status sap_world3f_shrink_to_fit(struct sap_world3f *world, struct sap_error *error);

/// The cast of a ray from `origin`. Both arrays have 3 numbers. `ignore_touching` is false. If a pointer is NULL, its numbers
/// are NaN, which no query accepts.
struct sap_cast3f sap_ray3f(const float *origin,
                            const float *direction,
                            float limit);

/// Prepares for queries, which takes time if bodies changed since the last query. A query does so by itself if it must. But
/// until a body is inserted or changed, or the next update, several threads may ask at the same time.
sap_status sap_world3f_prepare_queries(struct sap_world3f *world,
                                       struct sap_error *error);

/// The bodies whose boxes overlap a box. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all. All queries see the boxes as last set, updated or not.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3f_overlapping(struct sap_world3f *world,
                                   const struct sap_aabb3f *aabb,
                                   const struct sap_query *query,
                                   sap_id *ids,
                                   size_t capacity,
                                   size_t *count,
                                   struct sap_error *error);

/// Calls `callback` with each body whose box overlaps a box, in no particular order, until it returns false: is this place
/// free? The callback may read from this world, and ask it, but not change it.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3f_each_overlapping(struct sap_world3f *world,
                                        const struct sap_aabb3f *aabb,
                                        const struct sap_query *query,
                                        sap_body_callback callback,
                                        void *context,
                                        struct sap_error *error);

/// The bodies whose boxes contain a point. `point` points to 3 numbers. Writes the first `capacity` of them to `ids`, which may
/// be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` for a NaN.
sap_status sap_world3f_containing(struct sap_world3f *world,
                                  const float *point,
                                  const struct sap_query *query,
                                  sap_id *ids,
                                  size_t capacity,
                                  size_t *count,
                                  struct sap_error *error);

/// The bodies whose boxes are at most `radius` away from a point. `center` points to 3 numbers. Writes the first `capacity` of
/// them to `ids`, which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the center is not finite, or the radius negative or NaN.
sap_status sap_world3f_within(struct sap_world3f *world,
                              const float *center,
                              float radius,
                              const struct sap_query *query,
                              sap_id *ids,
                              size_t capacity,
                              size_t *count,
                              struct sap_error *error);

/// The bodies nearest to a point, at most `capacity` of them and at most `max_distance` away (which may be infinite), nearest
/// first. `point` points to 3 numbers. Writes them to `neighbors`; `*count` is how many were written.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the point is not finite, or the distance negative or NaN.
sap_status sap_world3f_nearest(struct sap_world3f *world,
                               const float *point,
                               double max_distance,
                               const struct sap_query *query,
                               struct sap_neighbor *neighbors,
                               size_t capacity,
                               size_t *count,
                               struct sap_error *error);

/// The body that a ray or a moving box hits first; of several at once that with the smallest slot. `hit->id` is `SAP_NO_ID` if
/// it hits none.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if its box or direction is not finite, its box inverted, or its limit negative or NaN.
sap_status sap_world3f_cast(struct sap_world3f *world,
                            const struct sap_cast3f *cast,
                            const struct sap_query *query,
                            struct sap_hit3f *hit,
                            struct sap_error *error);

/// Everything that a ray or a moving box hits, sorted by t and then by slot. Writes the first `capacity` of them to `hits`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: as `sap_world3f_cast`.
sap_status sap_world3f_cast_all(struct sap_world3f *world,
                                const struct sap_cast3f *cast,
                                const struct sap_query *query,
                                struct sap_hit3f *hits,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

/// Creates a finder that uses at most `threads` threads, and no more than there are processors; 0 counts as 1. The threads are
/// the finder's own. Destroy it by `sap_finder2f_destroy`.
sap_status sap_finder2f_create(uint32_t threads,
                               struct sap_finder2f **finder,
                               struct sap_error *error);

/// Destroys a finder and sets the pointer to it to NULL. Does nothing if `finder` or the pointer that it points to is NULL, or
/// if the finder is in use.
void sap_finder2f_destroy(struct sap_finder2f **finder);

/// Finds the pairs of boxes of one set that overlap, the smaller index first. `*pairs` points to memory of the finder, which
/// is valid until its next call; NULL if there are no pairs. Takes O(n log n + pairs) time on typical inputs.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`, `SAP_ERROR_OUT_OF_MEMORY`.
sap_status sap_finder2f_find(struct sap_finder2f *finder,
                             const struct sap_aabb2f *boxes,
                             size_t count,
                             const struct sap_pair **pairs,
                             size_t *pair_count,
                             struct sap_error *error);

/// Finds the pairs of a box of the set `a` and a box of the set `b` that overlap: `a` of a pair is an index of the first set,
/// `b` an index of the second. Otherwise as `sap_finder2f_find`.
sap_status sap_finder2f_find_between(struct sap_finder2f *finder,
                                     const struct sap_aabb2f *a,
                                     size_t a_count,
                                     const struct sap_aabb2f *b,
                                     size_t b_count,
                                     const struct sap_pair **pairs,
                                     size_t *pair_count,
                                     struct sap_error *error);

/// Finds the pairs of `sap_finder2f_find` and writes the first `capacity` of them to `pairs`, which may be NULL if `capacity`
/// is 0. `*pair_count` is how many there are in all. Uses one thread, and no memory for pairs.
///
/// Errors: as `sap_finder2f_find`. If a box is invalid, nothing has been written.
sap_status sap_finder2f_find_into(struct sap_finder2f *finder,
                                  const struct sap_aabb2f *boxes,
                                  size_t count,
                                  struct sap_pair *pairs,
                                  size_t capacity,
                                  size_t *pair_count,
                                  struct sap_error *error);

/// Finds the pairs of `sap_finder2f_find_between`. Otherwise as `sap_finder2f_find_into`.
sap_status sap_finder2f_find_between_into(struct sap_finder2f *finder,
                                          const struct sap_aabb2f *a,
                                          size_t a_count,
                                          const struct sap_aabb2f *b,
                                          size_t b_count,
                                          struct sap_pair *pairs,
                                          size_t capacity,
                                          size_t *pair_count,
                                          struct sap_error *error);

/// Counts the pairs of `sap_finder2f_find` without storing them.
///
/// Errors: as `sap_finder2f_find`.
sap_status sap_finder2f_count(struct sap_finder2f *finder,
                              const struct sap_aabb2f *boxes,
                              size_t count,
                              uint64_t *pair_count,
                              struct sap_error *error);

/// Counts the pairs of `sap_finder2f_find_between` without storing them.
///
/// Errors: as `sap_finder2f_find`.
sap_status sap_finder2f_count_between(struct sap_finder2f *finder,
                                      const struct sap_aabb2f *a,
                                      size_t a_count,
                                      const struct sap_aabb2f *b,
                                      size_t b_count,
                                      uint64_t *pair_count,
                                      struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder2f_find`, in their order, until it returns false. Uses one thread, and no
/// memory for pairs. The callback cannot use this finder: `SAP_ERROR_BUSY`.
///
/// Errors: as `sap_finder2f_find`. If a box is invalid, the callback has not been called.
sap_status sap_finder2f_each(struct sap_finder2f *finder,
                             const struct sap_aabb2f *boxes,
                             size_t count,
                             sap_pairs_callback callback,
                             void *context,
                             struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder2f_find_between`. Otherwise as `sap_finder2f_each`.
sap_status sap_finder2f_each_between(struct sap_finder2f *finder,
                                     const struct sap_aabb2f *a,
                                     size_t a_count,
                                     const struct sap_aabb2f *b,
                                     size_t b_count,
                                     sap_pairs_callback callback,
                                     void *context,
                                     struct sap_error *error);

/// Creates an empty world. `options` may be NULL, which is the same as all zeros. Destroy the world by `sap_world2f_destroy`.
///
/// Errors: `SAP_ERROR_INVALID_OPTION`, `SAP_ERROR_THREADS`.
sap_status sap_world2f_create(const struct sap_options2f *options,
                              struct sap_world2f **world,
                              struct sap_error *error);

/// Destroys a world and sets the pointer to it to NULL. Does nothing if `world` or the pointer that it points to is NULL, or if
/// the world is in use.
void sap_world2f_destroy(struct sap_world2f **world);

/// Copies a world: the copy has the same bodies under the same ids, and continues as the world would. For rollback this is
/// faster than a snapshot. Takes O(n + pairs) time.
///
/// Errors: `SAP_ERROR_THREADS`.
sap_status sap_world2f_copy(const struct sap_world2f *world,
                            struct sap_world2f **copy,
                            struct sap_error *error);

/// Makes a world equal to another one, as if it were a copy. Its memory is used again, so that saving a world now and then, in
/// turn to the same few worlds, allocates little. Keeps the threads of `world`. If `world` and `from` are the same:
/// `SAP_ERROR_BUSY`.
sap_status sap_world2f_assign(struct sap_world2f *world,
                              const struct sap_world2f *from,
                              struct sap_error *error);

/// Adds a body. `filter` may be NULL, which is the default filter. `id` may be NULL if the id is not needed.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`.
sap_status sap_world2f_insert(struct sap_world2f *world,
                              const struct sap_aabb2f *aabb,
                              const struct sap_filter *filter,
                              sap_id *id,
                              struct sap_error *error);

/// Adds a body for each of `count` boxes, all with the same filter, which may be NULL. Writes `count` ids to `ids`, in the
/// order of the boxes; `ids` may be NULL if they are not needed.
///
/// Errors: as `sap_world2f_insert`; then no body has been added.
sap_status sap_world2f_insert_many(struct sap_world2f *world,
                                   const struct sap_aabb2f *boxes,
                                   size_t count,
                                   const struct sap_filter *filter,
                                   sap_id *ids,
                                   struct sap_error *error);

/// Gives a body another box: it moved there. You don't have to track which bodies moved; a body whose box stays the same costs
/// next to nothing.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2f_set(struct sap_world2f *world,
                           sap_id id,
                           const struct sap_aabb2f *aabb,
                           struct sap_error *error);

/// Gives `count` bodies other boxes: `boxes[i]` to `ids[i]`. Of an id that is there twice the last box counts. Takes less time
/// than a call for each.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`; then no box has been set.
sap_status sap_world2f_set_many(struct sap_world2f *world,
                                const sap_id *ids,
                                const struct sap_aabb2f *boxes,
                                size_t count,
                                struct sap_error *error);

/// Moves a body from one box to another: the next update sees the smallest box that contains both, so that nothing is missed on
/// the way; the update after it sees `to`, if the body is not set before.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX` (`index` is 0 for `from` and 1 for `to`).
sap_status sap_world2f_set_swept(struct sap_world2f *world,
                                 sap_id id,
                                 const struct sap_aabb2f *from,
                                 const struct sap_aabb2f *to,
                                 struct sap_error *error);

/// Gives a body another box, to which it did not move: a fat AABB does not reach ahead after it. For exact boxes the same as
/// `sap_world2f_set`.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2f_teleport(struct sap_world2f *world,
                                sap_id id,
                                const struct sap_aabb2f *aabb,
                                struct sap_error *error);

/// Adds an offset to all boxes, for an origin that follows the player. `offset` points to 2 numbers, one for each axis.
/// Coordinates are rounded, so pairs that barely touch may begin or end.
///
/// Errors: `SAP_ERROR_INVALID_OFFSET`.
sap_status sap_world2f_shift(struct sap_world2f *world,
                             const float *offset,
                             struct sap_error *error);

/// Gives a body another filter, which counts from the next update on. NULL is the default filter.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_set_filter(struct sap_world2f *world,
                                  sap_id id,
                                  const struct sap_filter *filter,
                                  struct sap_error *error);

/// Disables a body (`false`), or enables it again. While it is disabled it pairs with no other, and queries do not find it; its
/// box and its filter can be set. Its pairs end or begin at the next update.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_set_enabled(struct sap_world2f *world,
                                   sap_id id,
                                   bool is_enabled,
                                   struct sap_error *error);

/// Excludes a pair, whatever the filters of its bodies allow: those of a joint, say. It ends at the next update if it was there,
/// and does not begin until it is included again. A body that is removed is forgotten, and a pair of a body with itself is never
/// there.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world2f_exclude_pair(struct sap_world2f *world,
                                    sap_id a,
                                    sap_id b,
                                    struct sap_error *error);

/// Includes a pair that was excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world2f_include_pair(struct sap_world2f *world, sap_id a, sap_id b, struct sap_error *error);

/// Removes a body. The next update reports the end of its pairs.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_remove(struct sap_world2f *world, sap_id id, struct sap_error *error);

/// Removes `count` bodies.
///
/// Errors: `SAP_ERROR_STALE_ID` with the index of the first id that is stale or there twice; then no body has been removed.
sap_status sap_world2f_remove_many(struct sap_world2f *world,
                                   const sap_id *ids,
                                   size_t count,
                                   struct sap_error *error);

/// Removes all bodies. The next update reports the end of all pairs.
sap_status sap_world2f_clear(struct sap_world2f *world, struct sap_error *error);

/// Finds the pairs that began and those that ended since the last update. `changes` may be NULL if they are not needed.
///
/// Takes time in proportion to the bodies that changed and their neighbors.
///
/// Errors: `SAP_ERROR_OUT_OF_MEMORY` if the pairs of a crowd do not fit. The next call then reports what this one should have.
sap_status sap_world2f_update(struct sap_world2f *world,
                              struct sap_changes *changes,
                              struct sap_error *error);

/// How many bodies there are.
sap_status sap_world2f_len(const struct sap_world2f *world, size_t *len, struct sap_error *error);

/// Whether an id names a body that is here. No id is an error.
sap_status sap_world2f_contains(const struct sap_world2f *world,
                                sap_id id,
                                bool *contains,
                                struct sap_error *error);

/// The box of a body as last set. That of a swept body is, until the next update, the smallest one that contains both of its
/// boxes.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_aabb(const struct sap_world2f *world,
                            sap_id id,
                            struct sap_aabb2f *aabb,
                            struct sap_error *error);

/// The box of a body whose overlaps are reported: its fat AABB if the world has the option `fat`, otherwise its box.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_reported_aabb(const struct sap_world2f *world,
                                     sap_id id,
                                     struct sap_aabb2f *aabb,
                                     struct sap_error *error);

/// The filter of a body.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_filter(const struct sap_world2f *world,
                              sap_id id,
                              struct sap_filter *filter,
                              struct sap_error *error);

/// Whether a body is enabled, as it is until `sap_world2f_set_enabled` says otherwise.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_is_enabled(const struct sap_world2f *world,
                                  sap_id id,
                                  bool *is_enabled,
                                  struct sap_error *error);

/// Whether a pair is excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world2f_is_excluded(const struct sap_world2f *world,
                                   sap_id a,
                                   sap_id b,
                                   bool *is_excluded,
                                   struct sap_error *error);

/// The ids of all bodies, sorted by slot. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all.
sap_status sap_world2f_ids(const struct sap_world2f *world,
                           sap_id *ids,
                           size_t capacity,
                           size_t *count,
                           struct sap_error *error);

/// The pairs that overlapped at the last update, each once, sorted by slot. Writes the first `capacity` of them to `pairs`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(pairs) time and memory.
sap_status sap_world2f_pairs(const struct sap_world2f *world,
                             struct sap_id_pair *pairs,
                             size_t capacity,
                             size_t *count,
                             struct sap_error *error);

/// The bodies that overlapped this one at the last update, sorted by slot. Writes the first `capacity` of them to `ids`, which
/// may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(log n) time and that of its neighbors after
/// `sap_world2f_prepare_queries` until the next update, otherwise O(pairs) time.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2f_pairs_of(const struct sap_world2f *world,
                                sap_id id,
                                sap_id *ids,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

/// The whole state as bytes. `*bytes` points to memory of the world, which is valid until its next snapshot, or its end. A
/// world restored from them gives, for the same calls, the same ids, events and results, bit for bit, on every platform. Takes
/// O(n) time.
sap_status sap_world2f_snapshot(struct sap_world2f *world,
                                const uint8_t **bytes,
                                size_t *count,
                                struct sap_error *error);

/// Makes a world that of a snapshot, with its options and ids; the bodies that it had are gone. Any bytes give a world or an
/// error. Keeps its threads. Takes the time of finding all pairs.
///
/// Errors: `SAP_ERROR_INVALID_SNAPSHOT`.
sap_status sap_world2f_restore(struct sap_world2f *world,
                               const uint8_t *bytes,
                               size_t count,
                               struct sap_error *error);

/// A hash of the whole state: equal for equal states, on every platform. It shows whether two machines that run the same
/// simulation diverged. Takes O(n) time and memory.
sap_status sap_world2f_state_hash(const struct sap_world2f *world,
                                  uint64_t *hash,
                                  struct sap_error *error);

/// Gives back memory that is not needed now, and changes no result. Takes O(n + pairs) time.
sap_status sap_world2f_shrink_to_fit(struct sap_world2f *world, struct sap_error *error);

/// The cast of a ray from `origin`. Both arrays have 2 numbers. `ignore_touching` is false. If a pointer is NULL, its numbers
/// are NaN, which no query accepts.
struct sap_cast2f sap_ray2f(const float *origin,
                            const float *direction,
                            float limit);

/// Prepares for queries, which takes time if bodies changed since the last query. A query does so by itself if it must. But
/// until a body is inserted or changed, or the next update, several threads may ask at the same time.
sap_status sap_world2f_prepare_queries(struct sap_world2f *world,
                                       struct sap_error *error);

/// The bodies whose boxes overlap a box. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all. All queries see the boxes as last set, updated or not.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2f_overlapping(struct sap_world2f *world,
                                   const struct sap_aabb2f *aabb,
                                   const struct sap_query *query,
                                   sap_id *ids,
                                   size_t capacity,
                                   size_t *count,
                                   struct sap_error *error);

/// Calls `callback` with each body whose box overlaps a box, in no particular order, until it returns false: is this place
/// free? The callback may read from this world, and ask it, but not change it.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2f_each_overlapping(struct sap_world2f *world,
                                        const struct sap_aabb2f *aabb,
                                        const struct sap_query *query,
                                        sap_body_callback callback,
                                        void *context,
                                        struct sap_error *error);

/// The bodies whose boxes contain a point. `point` points to 2 numbers. Writes the first `capacity` of them to `ids`, which may
/// be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` for a NaN.
sap_status sap_world2f_containing(struct sap_world2f *world,
                                  const float *point,
                                  const struct sap_query *query,
                                  sap_id *ids,
                                  size_t capacity,
                                  size_t *count,
                                  struct sap_error *error);

/// The bodies whose boxes are at most `radius` away from a point. `center` points to 2 numbers. Writes the first `capacity` of
/// them to `ids`, which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the center is not finite, or the radius negative or NaN.
sap_status sap_world2f_within(struct sap_world2f *world,
                              const float *center,
                              float radius,
                              const struct sap_query *query,
                              sap_id *ids,
                              size_t capacity,
                              size_t *count,
                              struct sap_error *error);

/// The bodies nearest to a point, at most `capacity` of them and at most `max_distance` away (which may be infinite), nearest
/// first. `point` points to 2 numbers. Writes them to `neighbors`; `*count` is how many were written.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the point is not finite, or the distance negative or NaN.
sap_status sap_world2f_nearest(struct sap_world2f *world,
                               const float *point,
                               double max_distance,
                               const struct sap_query *query,
                               struct sap_neighbor *neighbors,
                               size_t capacity,
                               size_t *count,
                               struct sap_error *error);

/// The body that a ray or a moving box hits first; of several at once that with the smallest slot. `hit->id` is `SAP_NO_ID` if
/// it hits none.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if its box or direction is not finite, its box inverted, or its limit negative or NaN.
sap_status sap_world2f_cast(struct sap_world2f *world,
                            const struct sap_cast2f *cast,
                            const struct sap_query *query,
                            struct sap_hit2f *hit,
                            struct sap_error *error);

/// Everything that a ray or a moving box hits, sorted by t and then by slot. Writes the first `capacity` of them to `hits`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: as `sap_world2f_cast`.
sap_status sap_world2f_cast_all(struct sap_world2f *world,
                                const struct sap_cast2f *cast,
                                const struct sap_query *query,
                                struct sap_hit2f *hits,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

/// Creates a finder that uses at most `threads` threads, and no more than there are processors; 0 counts as 1. The threads are
/// the finder's own. Destroy it by `sap_finder3d_destroy`.
sap_status sap_finder3d_create(uint32_t threads,
                               struct sap_finder3d **finder,
                               struct sap_error *error);

/// Destroys a finder and sets the pointer to it to NULL. Does nothing if `finder` or the pointer that it points to is NULL, or
/// if the finder is in use.
void sap_finder3d_destroy(struct sap_finder3d **finder);

/// Finds the pairs of boxes of one set that overlap, the smaller index first. `*pairs` points to memory of the finder, which
/// is valid until its next call; NULL if there are no pairs. Takes O(n log n + pairs) time on typical inputs.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`, `SAP_ERROR_OUT_OF_MEMORY`.
sap_status sap_finder3d_find(struct sap_finder3d *finder,
                             const struct sap_aabb3d *boxes,
                             size_t count,
                             const struct sap_pair **pairs,
                             size_t *pair_count,
                             struct sap_error *error);

/// Finds the pairs of a box of the set `a` and a box of the set `b` that overlap: `a` of a pair is an index of the first set,
/// `b` an index of the second. Otherwise as `sap_finder3d_find`.
sap_status sap_finder3d_find_between(struct sap_finder3d *finder,
                                     const struct sap_aabb3d *a,
                                     size_t a_count,
                                     const struct sap_aabb3d *b,
                                     size_t b_count,
                                     const struct sap_pair **pairs,
                                     size_t *pair_count,
                                     struct sap_error *error);

/// Finds the pairs of `sap_finder3d_find` and writes the first `capacity` of them to `pairs`, which may be NULL if `capacity`
/// is 0. `*pair_count` is how many there are in all. Uses one thread, and no memory for pairs.
///
/// Errors: as `sap_finder3d_find`. If a box is invalid, nothing has been written.
sap_status sap_finder3d_find_into(struct sap_finder3d *finder,
                                  const struct sap_aabb3d *boxes,
                                  size_t count,
                                  struct sap_pair *pairs,
                                  size_t capacity,
                                  size_t *pair_count,
                                  struct sap_error *error);

/// Finds the pairs of `sap_finder3d_find_between`. Otherwise as `sap_finder3d_find_into`.
sap_status sap_finder3d_find_between_into(struct sap_finder3d *finder,
                                          const struct sap_aabb3d *a,
                                          size_t a_count,
                                          const struct sap_aabb3d *b,
                                          size_t b_count,
                                          struct sap_pair *pairs,
                                          size_t capacity,
                                          size_t *pair_count,
                                          struct sap_error *error);

/// Counts the pairs of `sap_finder3d_find` without storing them.
///
/// Errors: as `sap_finder3d_find`.
sap_status sap_finder3d_count(struct sap_finder3d *finder,
                              const struct sap_aabb3d *boxes,
                              size_t count,
                              uint64_t *pair_count,
                              struct sap_error *error);

/// Counts the pairs of `sap_finder3d_find_between` without storing them.
///
/// Errors: as `sap_finder3d_find`.
sap_status sap_finder3d_count_between(struct sap_finder3d *finder,
                                      const struct sap_aabb3d *a,
                                      size_t a_count,
                                      const struct sap_aabb3d *b,
                                      size_t b_count,
                                      uint64_t *pair_count,
                                      struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder3d_find`, in their order, until it returns false. Uses one thread, and no
/// memory for pairs. The callback cannot use this finder: `SAP_ERROR_BUSY`.
///
/// Errors: as `sap_finder3d_find`. If a box is invalid, the callback has not been called.
sap_status sap_finder3d_each(struct sap_finder3d *finder,
                             const struct sap_aabb3d *boxes,
                             size_t count,
                             sap_pairs_callback callback,
                             void *context,
                             struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder3d_find_between`. Otherwise as `sap_finder3d_each`.
sap_status sap_finder3d_each_between(struct sap_finder3d *finder,
                                     const struct sap_aabb3d *a,
                                     size_t a_count,
                                     const struct sap_aabb3d *b,
                                     size_t b_count,
                                     sap_pairs_callback callback,
                                     void *context,
                                     struct sap_error *error);

/// Creates an empty world. `options` may be NULL, which is the same as all zeros. Destroy the world by `sap_world3d_destroy`.
///
/// Errors: `SAP_ERROR_INVALID_OPTION`, `SAP_ERROR_THREADS`.
sap_status sap_world3d_create(const struct sap_options3d *options,
                              struct sap_world3d **world,
                              struct sap_error *error);

/// Destroys a world and sets the pointer to it to NULL. Does nothing if `world` or the pointer that it points to is NULL, or if
/// the world is in use.
void sap_world3d_destroy(struct sap_world3d **world);

/// Copies a world: the copy has the same bodies under the same ids, and continues as the world would. For rollback this is
/// faster than a snapshot. Takes O(n + pairs) time.
///
/// Errors: `SAP_ERROR_THREADS`.
sap_status sap_world3d_copy(const struct sap_world3d *world,
                            struct sap_world3d **copy,
                            struct sap_error *error);

/// Makes a world equal to another one, as if it were a copy. Its memory is used again, so that saving a world now and then, in
/// turn to the same few worlds, allocates little. Keeps the threads of `world`. If `world` and `from` are the same:
/// `SAP_ERROR_BUSY`.
sap_status sap_world3d_assign(struct sap_world3d *world,
                              const struct sap_world3d *from,
                              struct sap_error *error);

/// Adds a body. `filter` may be NULL, which is the default filter. `id` may be NULL if the id is not needed.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`.
sap_status sap_world3d_insert(struct sap_world3d *world,
                              const struct sap_aabb3d *aabb,
                              const struct sap_filter *filter,
                              sap_id *id,
                              struct sap_error *error);

/// Adds a body for each of `count` boxes, all with the same filter, which may be NULL. Writes `count` ids to `ids`, in the
/// order of the boxes; `ids` may be NULL if they are not needed.
///
/// Errors: as `sap_world3d_insert`; then no body has been added.
sap_status sap_world3d_insert_many(struct sap_world3d *world,
                                   const struct sap_aabb3d *boxes,
                                   size_t count,
                                   const struct sap_filter *filter,
                                   sap_id *ids,
                                   struct sap_error *error);

/// Gives a body another box: it moved there. You don't have to track which bodies moved; a body whose box stays the same costs
/// next to nothing.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3d_set(struct sap_world3d *world,
                           sap_id id,
                           const struct sap_aabb3d *aabb,
                           struct sap_error *error);

/// Gives `count` bodies other boxes: `boxes[i]` to `ids[i]`. Of an id that is there twice the last box counts. Takes less time
/// than a call for each.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`; then no box has been set.
sap_status sap_world3d_set_many(struct sap_world3d *world,
                                const sap_id *ids,
                                const struct sap_aabb3d *boxes,
                                size_t count,
                                struct sap_error *error);

/// Moves a body from one box to another: the next update sees the smallest box that contains both, so that nothing is missed on
/// the way; the update after it sees `to`, if the body is not set before.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX` (`index` is 0 for `from` and 1 for `to`).
sap_status sap_world3d_set_swept(struct sap_world3d *world,
                                 sap_id id,
                                 const struct sap_aabb3d *from,
                                 const struct sap_aabb3d *to,
                                 struct sap_error *error);

/// Gives a body another box, to which it did not move: a fat AABB does not reach ahead after it. For exact boxes the same as
/// `sap_world3d_set`.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3d_teleport(struct sap_world3d *world,
                                sap_id id,
                                const struct sap_aabb3d *aabb,
                                struct sap_error *error);

/// Adds an offset to all boxes, for an origin that follows the player. `offset` points to 3 numbers, one for each axis.
/// Coordinates are rounded, so pairs that barely touch may begin or end.
///
/// Errors: `SAP_ERROR_INVALID_OFFSET`.
sap_status sap_world3d_shift(struct sap_world3d *world,
                             const double *offset,
                             struct sap_error *error);

/// Gives a body another filter, which counts from the next update on. NULL is the default filter.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_set_filter(struct sap_world3d *world,
                                  sap_id id,
                                  const struct sap_filter *filter,
                                  struct sap_error *error);

/// Disables a body (`false`), or enables it again. While it is disabled it pairs with no other, and queries do not find it; its
/// box and its filter can be set. Its pairs end or begin at the next update.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_set_enabled(struct sap_world3d *world,
                                   sap_id id,
                                   bool is_enabled,
                                   struct sap_error *error);

/// Excludes a pair, whatever the filters of its bodies allow: those of a joint, say. It ends at the next update if it was there,
/// and does not begin until it is included again. A body that is removed is forgotten, and a pair of a body with itself is never
/// there.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world3d_exclude_pair(struct sap_world3d *world,
                                    sap_id a,
                                    sap_id b,
                                    struct sap_error *error);

/// Includes a pair that was excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world3d_include_pair(struct sap_world3d *world, sap_id a, sap_id b, struct sap_error *error);

/// Removes a body. The next update reports the end of its pairs.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_remove(struct sap_world3d *world, sap_id id, struct sap_error *error);

/// Removes `count` bodies.
///
/// Errors: `SAP_ERROR_STALE_ID` with the index of the first id that is stale or there twice; then no body has been removed.
sap_status sap_world3d_remove_many(struct sap_world3d *world,
                                   const sap_id *ids,
                                   size_t count,
                                   struct sap_error *error);

/// Removes all bodies. The next update reports the end of all pairs.
sap_status sap_world3d_clear(struct sap_world3d *world, struct sap_error *error);

/// Finds the pairs that began and those that ended since the last update. `changes` may be NULL if they are not needed.
///
/// Takes time in proportion to the bodies that changed and their neighbors.
///
/// Errors: `SAP_ERROR_OUT_OF_MEMORY` if the pairs of a crowd do not fit. The next call then reports what this one should have.
sap_status sap_world3d_update(struct sap_world3d *world,
                              struct sap_changes *changes,
                              struct sap_error *error);

/// How many bodies there are.
sap_status sap_world3d_len(const struct sap_world3d *world, size_t *len, struct sap_error *error);

/// Whether an id names a body that is here. No id is an error.
sap_status sap_world3d_contains(const struct sap_world3d *world,
                                sap_id id,
                                bool *contains,
                                struct sap_error *error);

/// The box of a body as last set. That of a swept body is, until the next update, the smallest one that contains both of its
/// boxes.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_aabb(const struct sap_world3d *world,
                            sap_id id,
                            struct sap_aabb3d *aabb,
                            struct sap_error *error);

/// The box of a body whose overlaps are reported: its fat AABB if the world has the option `fat`, otherwise its box.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_reported_aabb(const struct sap_world3d *world,
                                     sap_id id,
                                     struct sap_aabb3d *aabb,
                                     struct sap_error *error);

/// The filter of a body.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_filter(const struct sap_world3d *world,
                              sap_id id,
                              struct sap_filter *filter,
                              struct sap_error *error);

/// Whether a body is enabled, as it is until `sap_world3d_set_enabled` says otherwise.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_is_enabled(const struct sap_world3d *world,
                                  sap_id id,
                                  bool *is_enabled,
                                  struct sap_error *error);

/// Whether a pair is excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world3d_is_excluded(const struct sap_world3d *world,
                                   sap_id a,
                                   sap_id b,
                                   bool *is_excluded,
                                   struct sap_error *error);

/// The ids of all bodies, sorted by slot. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all.
sap_status sap_world3d_ids(const struct sap_world3d *world,
                           sap_id *ids,
                           size_t capacity,
                           size_t *count,
                           struct sap_error *error);

/// The pairs that overlapped at the last update, each once, sorted by slot. Writes the first `capacity` of them to `pairs`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(pairs) time and memory.
sap_status sap_world3d_pairs(const struct sap_world3d *world,
                             struct sap_id_pair *pairs,
                             size_t capacity,
                             size_t *count,
                             struct sap_error *error);

/// The bodies that overlapped this one at the last update, sorted by slot. Writes the first `capacity` of them to `ids`, which
/// may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(log n) time and that of its neighbors after
/// `sap_world3d_prepare_queries` until the next update, otherwise O(pairs) time.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world3d_pairs_of(const struct sap_world3d *world,
                                sap_id id,
                                sap_id *ids,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

/// The whole state as bytes. `*bytes` points to memory of the world, which is valid until its next snapshot, or its end. A
/// world restored from them gives, for the same calls, the same ids, events and results, bit for bit, on every platform. Takes
/// O(n) time.
sap_status sap_world3d_snapshot(struct sap_world3d *world,
                                const uint8_t **bytes,
                                size_t *count,
                                struct sap_error *error);

/// Makes a world that of a snapshot, with its options and ids; the bodies that it had are gone. Any bytes give a world or an
/// error. Keeps its threads. Takes the time of finding all pairs.
///
/// Errors: `SAP_ERROR_INVALID_SNAPSHOT`.
sap_status sap_world3d_restore(struct sap_world3d *world,
                               const uint8_t *bytes,
                               size_t count,
                               struct sap_error *error);

/// A hash of the whole state: equal for equal states, on every platform. It shows whether two machines that run the same
/// simulation diverged. Takes O(n) time and memory.
sap_status sap_world3d_state_hash(const struct sap_world3d *world,
                                  uint64_t *hash,
                                  struct sap_error *error);

/// Gives back memory that is not needed now, and changes no result. Takes O(n + pairs) time.
sap_status sap_world3d_shrink_to_fit(struct sap_world3d *world, struct sap_error *error);

/// The cast of a ray from `origin`. Both arrays have 3 numbers. `ignore_touching` is false. If a pointer is NULL, its numbers
/// are NaN, which no query accepts.
struct sap_cast3d sap_ray3d(const double *origin,
                            const double *direction,
                            double limit);

/// Prepares for queries, which takes time if bodies changed since the last query. A query does so by itself if it must. But
/// until a body is inserted or changed, or the next update, several threads may ask at the same time.
sap_status sap_world3d_prepare_queries(struct sap_world3d *world,
                                       struct sap_error *error);

/// The bodies whose boxes overlap a box. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all. All queries see the boxes as last set, updated or not.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3d_overlapping(struct sap_world3d *world,
                                   const struct sap_aabb3d *aabb,
                                   const struct sap_query *query,
                                   sap_id *ids,
                                   size_t capacity,
                                   size_t *count,
                                   struct sap_error *error);

/// Calls `callback` with each body whose box overlaps a box, in no particular order, until it returns false: is this place
/// free? The callback may read from this world, and ask it, but not change it.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world3d_each_overlapping(struct sap_world3d *world,
                                        const struct sap_aabb3d *aabb,
                                        const struct sap_query *query,
                                        sap_body_callback callback,
                                        void *context,
                                        struct sap_error *error);

/// The bodies whose boxes contain a point. `point` points to 3 numbers. Writes the first `capacity` of them to `ids`, which may
/// be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` for a NaN.
sap_status sap_world3d_containing(struct sap_world3d *world,
                                  const double *point,
                                  const struct sap_query *query,
                                  sap_id *ids,
                                  size_t capacity,
                                  size_t *count,
                                  struct sap_error *error);

/// The bodies whose boxes are at most `radius` away from a point. `center` points to 3 numbers. Writes the first `capacity` of
/// them to `ids`, which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the center is not finite, or the radius negative or NaN.
sap_status sap_world3d_within(struct sap_world3d *world,
                              const double *center,
                              double radius,
                              const struct sap_query *query,
                              sap_id *ids,
                              size_t capacity,
                              size_t *count,
                              struct sap_error *error);

/// The bodies nearest to a point, at most `capacity` of them and at most `max_distance` away (which may be infinite), nearest
/// first. `point` points to 3 numbers. Writes them to `neighbors`; `*count` is how many were written.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the point is not finite, or the distance negative or NaN.
sap_status sap_world3d_nearest(struct sap_world3d *world,
                               const double *point,
                               double max_distance,
                               const struct sap_query *query,
                               struct sap_neighbor *neighbors,
                               size_t capacity,
                               size_t *count,
                               struct sap_error *error);

/// The body that a ray or a moving box hits first; of several at once that with the smallest slot. `hit->id` is `SAP_NO_ID` if
/// it hits none.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if its box or direction is not finite, its box inverted, or its limit negative or NaN.
sap_status sap_world3d_cast(struct sap_world3d *world,
                            const struct sap_cast3d *cast,
                            const struct sap_query *query,
                            struct sap_hit3d *hit,
                            struct sap_error *error);

/// Everything that a ray or a moving box hits, sorted by t and then by slot. Writes the first `capacity` of them to `hits`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: as `sap_world3d_cast`.
sap_status sap_world3d_cast_all(struct sap_world3d *world,
                                const struct sap_cast3d *cast,
                                const struct sap_query *query,
                                struct sap_hit3d *hits,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

/// Creates a finder that uses at most `threads` threads, and no more than there are processors; 0 counts as 1. The threads are
/// the finder's own. Destroy it by `sap_finder2d_destroy`.
sap_status sap_finder2d_create(uint32_t threads,
                               struct sap_finder2d **finder,
                               struct sap_error *error);

/// Destroys a finder and sets the pointer to it to NULL. Does nothing if `finder` or the pointer that it points to is NULL, or
/// if the finder is in use.
void sap_finder2d_destroy(struct sap_finder2d **finder);

/// Finds the pairs of boxes of one set that overlap, the smaller index first. `*pairs` points to memory of the finder, which
/// is valid until its next call; NULL if there are no pairs. Takes O(n log n + pairs) time on typical inputs.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`, `SAP_ERROR_OUT_OF_MEMORY`.
sap_status sap_finder2d_find(struct sap_finder2d *finder,
                             const struct sap_aabb2d *boxes,
                             size_t count,
                             const struct sap_pair **pairs,
                             size_t *pair_count,
                             struct sap_error *error);

/// Finds the pairs of a box of the set `a` and a box of the set `b` that overlap: `a` of a pair is an index of the first set,
/// `b` an index of the second. Otherwise as `sap_finder2d_find`.
sap_status sap_finder2d_find_between(struct sap_finder2d *finder,
                                     const struct sap_aabb2d *a,
                                     size_t a_count,
                                     const struct sap_aabb2d *b,
                                     size_t b_count,
                                     const struct sap_pair **pairs,
                                     size_t *pair_count,
                                     struct sap_error *error);

/// Finds the pairs of `sap_finder2d_find` and writes the first `capacity` of them to `pairs`, which may be NULL if `capacity`
/// is 0. `*pair_count` is how many there are in all. Uses one thread, and no memory for pairs.
///
/// Errors: as `sap_finder2d_find`. If a box is invalid, nothing has been written.
sap_status sap_finder2d_find_into(struct sap_finder2d *finder,
                                  const struct sap_aabb2d *boxes,
                                  size_t count,
                                  struct sap_pair *pairs,
                                  size_t capacity,
                                  size_t *pair_count,
                                  struct sap_error *error);

/// Finds the pairs of `sap_finder2d_find_between`. Otherwise as `sap_finder2d_find_into`.
sap_status sap_finder2d_find_between_into(struct sap_finder2d *finder,
                                          const struct sap_aabb2d *a,
                                          size_t a_count,
                                          const struct sap_aabb2d *b,
                                          size_t b_count,
                                          struct sap_pair *pairs,
                                          size_t capacity,
                                          size_t *pair_count,
                                          struct sap_error *error);

/// Counts the pairs of `sap_finder2d_find` without storing them.
///
/// Errors: as `sap_finder2d_find`.
sap_status sap_finder2d_count(struct sap_finder2d *finder,
                              const struct sap_aabb2d *boxes,
                              size_t count,
                              uint64_t *pair_count,
                              struct sap_error *error);

/// Counts the pairs of `sap_finder2d_find_between` without storing them.
///
/// Errors: as `sap_finder2d_find`.
sap_status sap_finder2d_count_between(struct sap_finder2d *finder,
                                      const struct sap_aabb2d *a,
                                      size_t a_count,
                                      const struct sap_aabb2d *b,
                                      size_t b_count,
                                      uint64_t *pair_count,
                                      struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder2d_find`, in their order, until it returns false. Uses one thread, and no
/// memory for pairs. The callback cannot use this finder: `SAP_ERROR_BUSY`.
///
/// Errors: as `sap_finder2d_find`. If a box is invalid, the callback has not been called.
sap_status sap_finder2d_each(struct sap_finder2d *finder,
                             const struct sap_aabb2d *boxes,
                             size_t count,
                             sap_pairs_callback callback,
                             void *context,
                             struct sap_error *error);

/// Calls `callback` with the pairs of `sap_finder2d_find_between`. Otherwise as `sap_finder2d_each`.
sap_status sap_finder2d_each_between(struct sap_finder2d *finder,
                                     const struct sap_aabb2d *a,
                                     size_t a_count,
                                     const struct sap_aabb2d *b,
                                     size_t b_count,
                                     sap_pairs_callback callback,
                                     void *context,
                                     struct sap_error *error);

/// Creates an empty world. `options` may be NULL, which is the same as all zeros. Destroy the world by `sap_world2d_destroy`.
///
/// Errors: `SAP_ERROR_INVALID_OPTION`, `SAP_ERROR_THREADS`.
sap_status sap_world2d_create(const struct sap_options2d *options,
                              struct sap_world2d **world,
                              struct sap_error *error);

/// Destroys a world and sets the pointer to it to NULL. Does nothing if `world` or the pointer that it points to is NULL, or if
/// the world is in use.
void sap_world2d_destroy(struct sap_world2d **world);

/// Copies a world: the copy has the same bodies under the same ids, and continues as the world would. For rollback this is
/// faster than a snapshot. Takes O(n + pairs) time.
///
/// Errors: `SAP_ERROR_THREADS`.
sap_status sap_world2d_copy(const struct sap_world2d *world,
                            struct sap_world2d **copy,
                            struct sap_error *error);

/// Makes a world equal to another one, as if it were a copy. Its memory is used again, so that saving a world now and then, in
/// turn to the same few worlds, allocates little. Keeps the threads of `world`. If `world` and `from` are the same:
/// `SAP_ERROR_BUSY`.
sap_status sap_world2d_assign(struct sap_world2d *world,
                              const struct sap_world2d *from,
                              struct sap_error *error);

/// Adds a body. `filter` may be NULL, which is the default filter. `id` may be NULL if the id is not needed.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`.
sap_status sap_world2d_insert(struct sap_world2d *world,
                              const struct sap_aabb2d *aabb,
                              const struct sap_filter *filter,
                              sap_id *id,
                              struct sap_error *error);

/// Adds a body for each of `count` boxes, all with the same filter, which may be NULL. Writes `count` ids to `ids`, in the
/// order of the boxes; `ids` may be NULL if they are not needed.
///
/// Errors: as `sap_world2d_insert`; then no body has been added.
sap_status sap_world2d_insert_many(struct sap_world2d *world,
                                   const struct sap_aabb2d *boxes,
                                   size_t count,
                                   const struct sap_filter *filter,
                                   sap_id *ids,
                                   struct sap_error *error);

/// Gives a body another box: it moved there. You don't have to track which bodies moved; a body whose box stays the same costs
/// next to nothing.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2d_set(struct sap_world2d *world,
                           sap_id id,
                           const struct sap_aabb2d *aabb,
                           struct sap_error *error);

/// Gives `count` bodies other boxes: `boxes[i]` to `ids[i]`. Of an id that is there twice the last box counts. Takes less time
/// than a call for each.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`; then no box has been set.
sap_status sap_world2d_set_many(struct sap_world2d *world,
                                const sap_id *ids,
                                const struct sap_aabb2d *boxes,
                                size_t count,
                                struct sap_error *error);

/// Moves a body from one box to another: the next update sees the smallest box that contains both, so that nothing is missed on
/// the way; the update after it sees `to`, if the body is not set before.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX` (`index` is 0 for `from` and 1 for `to`).
sap_status sap_world2d_set_swept(struct sap_world2d *world,
                                 sap_id id,
                                 const struct sap_aabb2d *from,
                                 const struct sap_aabb2d *to,
                                 struct sap_error *error);

/// Gives a body another box, to which it did not move: a fat AABB does not reach ahead after it. For exact boxes the same as
/// `sap_world2d_set`.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2d_teleport(struct sap_world2d *world,
                                sap_id id,
                                const struct sap_aabb2d *aabb,
                                struct sap_error *error);

/// Adds an offset to all boxes, for an origin that follows the player. `offset` points to 2 numbers, one for each axis.
/// Coordinates are rounded, so pairs that barely touch may begin or end.
///
/// Errors: `SAP_ERROR_INVALID_OFFSET`.
sap_status sap_world2d_shift(struct sap_world2d *world,
                             const double *offset,
                             struct sap_error *error);

/// Gives a body another filter, which counts from the next update on. NULL is the default filter.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_set_filter(struct sap_world2d *world,
                                  sap_id id,
                                  const struct sap_filter *filter,
                                  struct sap_error *error);

/// Disables a body (`false`), or enables it again. While it is disabled it pairs with no other, and queries do not find it; its
/// box and its filter can be set. Its pairs end or begin at the next update.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_set_enabled(struct sap_world2d *world,
                                   sap_id id,
                                   bool is_enabled,
                                   struct sap_error *error);

/// Excludes a pair, whatever the filters of its bodies allow: those of a joint, say. It ends at the next update if it was there,
/// and does not begin until it is included again. A body that is removed is forgotten, and a pair of a body with itself is never
/// there.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world2d_exclude_pair(struct sap_world2d *world,
                                    sap_id a,
                                    sap_id b,
                                    struct sap_error *error);

/// Includes a pair that was excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world2d_include_pair(struct sap_world2d *world, sap_id a, sap_id b, struct sap_error *error);

/// Removes a body. The next update reports the end of its pairs.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_remove(struct sap_world2d *world, sap_id id, struct sap_error *error);

/// Removes `count` bodies.
///
/// Errors: `SAP_ERROR_STALE_ID` with the index of the first id that is stale or there twice; then no body has been removed.
sap_status sap_world2d_remove_many(struct sap_world2d *world,
                                   const sap_id *ids,
                                   size_t count,
                                   struct sap_error *error);

/// Removes all bodies. The next update reports the end of all pairs.
sap_status sap_world2d_clear(struct sap_world2d *world, struct sap_error *error);

/// Finds the pairs that began and those that ended since the last update. `changes` may be NULL if they are not needed.
///
/// Takes time in proportion to the bodies that changed and their neighbors.
///
/// Errors: `SAP_ERROR_OUT_OF_MEMORY` if the pairs of a crowd do not fit. The next call then reports what this one should have.
sap_status sap_world2d_update(struct sap_world2d *world,
                              struct sap_changes *changes,
                              struct sap_error *error);

/// How many bodies there are.
sap_status sap_world2d_len(const struct sap_world2d *world, size_t *len, struct sap_error *error);

/// Whether an id names a body that is here. No id is an error.
sap_status sap_world2d_contains(const struct sap_world2d *world,
                                sap_id id,
                                bool *contains,
                                struct sap_error *error);

/// The box of a body as last set. That of a swept body is, until the next update, the smallest one that contains both of its
/// boxes.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_aabb(const struct sap_world2d *world,
                            sap_id id,
                            struct sap_aabb2d *aabb,
                            struct sap_error *error);

/// The box of a body whose overlaps are reported: its fat AABB if the world has the option `fat`, otherwise its box.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_reported_aabb(const struct sap_world2d *world,
                                     sap_id id,
                                     struct sap_aabb2d *aabb,
                                     struct sap_error *error);

/// The filter of a body.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_filter(const struct sap_world2d *world,
                              sap_id id,
                              struct sap_filter *filter,
                              struct sap_error *error);

/// Whether a body is enabled, as it is until `sap_world2d_set_enabled` says otherwise.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_is_enabled(const struct sap_world2d *world,
                                  sap_id id,
                                  bool *is_enabled,
                                  struct sap_error *error);

/// Whether a pair is excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
sap_status sap_world2d_is_excluded(const struct sap_world2d *world,
                                   sap_id a,
                                   sap_id b,
                                   bool *is_excluded,
                                   struct sap_error *error);

/// The ids of all bodies, sorted by slot. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all.
sap_status sap_world2d_ids(const struct sap_world2d *world,
                           sap_id *ids,
                           size_t capacity,
                           size_t *count,
                           struct sap_error *error);

/// The pairs that overlapped at the last update, each once, sorted by slot. Writes the first `capacity` of them to `pairs`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(pairs) time and memory.
sap_status sap_world2d_pairs(const struct sap_world2d *world,
                             struct sap_id_pair *pairs,
                             size_t capacity,
                             size_t *count,
                             struct sap_error *error);

/// The bodies that overlapped this one at the last update, sorted by slot. Writes the first `capacity` of them to `ids`, which
/// may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(log n) time and that of its neighbors after
/// `sap_world2d_prepare_queries` until the next update, otherwise O(pairs) time.
///
/// Errors: `SAP_ERROR_STALE_ID`.
sap_status sap_world2d_pairs_of(const struct sap_world2d *world,
                                sap_id id,
                                sap_id *ids,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

/// The whole state as bytes. `*bytes` points to memory of the world, which is valid until its next snapshot, or its end. A
/// world restored from them gives, for the same calls, the same ids, events and results, bit for bit, on every platform. Takes
/// O(n) time.
sap_status sap_world2d_snapshot(struct sap_world2d *world,
                                const uint8_t **bytes,
                                size_t *count,
                                struct sap_error *error);

/// Makes a world that of a snapshot, with its options and ids; the bodies that it had are gone. Any bytes give a world or an
/// error. Keeps its threads. Takes the time of finding all pairs.
///
/// Errors: `SAP_ERROR_INVALID_SNAPSHOT`.
sap_status sap_world2d_restore(struct sap_world2d *world,
                               const uint8_t *bytes,
                               size_t count,
                               struct sap_error *error);

/// A hash of the whole state: equal for equal states, on every platform. It shows whether two machines that run the same
/// simulation diverged. Takes O(n) time and memory.
sap_status sap_world2d_state_hash(const struct sap_world2d *world,
                                  uint64_t *hash,
                                  struct sap_error *error);

/// Gives back memory that is not needed now, and changes no result. Takes O(n + pairs) time.
sap_status sap_world2d_shrink_to_fit(struct sap_world2d *world, struct sap_error *error);

/// The cast of a ray from `origin`. Both arrays have 2 numbers. `ignore_touching` is false. If a pointer is NULL, its numbers
/// are NaN, which no query accepts.
struct sap_cast2d sap_ray2d(const double *origin,
                            const double *direction,
                            double limit);

/// Prepares for queries, which takes time if bodies changed since the last query. A query does so by itself if it must. But
/// until a body is inserted or changed, or the next update, several threads may ask at the same time.
sap_status sap_world2d_prepare_queries(struct sap_world2d *world,
                                       struct sap_error *error);

/// The bodies whose boxes overlap a box. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all. All queries see the boxes as last set, updated or not.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2d_overlapping(struct sap_world2d *world,
                                   const struct sap_aabb2d *aabb,
                                   const struct sap_query *query,
                                   sap_id *ids,
                                   size_t capacity,
                                   size_t *count,
                                   struct sap_error *error);

/// Calls `callback` with each body whose box overlaps a box, in no particular order, until it returns false: is this place
/// free? The callback may read from this world, and ask it, but not change it.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
sap_status sap_world2d_each_overlapping(struct sap_world2d *world,
                                        const struct sap_aabb2d *aabb,
                                        const struct sap_query *query,
                                        sap_body_callback callback,
                                        void *context,
                                        struct sap_error *error);

/// The bodies whose boxes contain a point. `point` points to 2 numbers. Writes the first `capacity` of them to `ids`, which may
/// be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` for a NaN.
sap_status sap_world2d_containing(struct sap_world2d *world,
                                  const double *point,
                                  const struct sap_query *query,
                                  sap_id *ids,
                                  size_t capacity,
                                  size_t *count,
                                  struct sap_error *error);

/// The bodies whose boxes are at most `radius` away from a point. `center` points to 2 numbers. Writes the first `capacity` of
/// them to `ids`, which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the center is not finite, or the radius negative or NaN.
sap_status sap_world2d_within(struct sap_world2d *world,
                              const double *center,
                              double radius,
                              const struct sap_query *query,
                              sap_id *ids,
                              size_t capacity,
                              size_t *count,
                              struct sap_error *error);

/// The bodies nearest to a point, at most `capacity` of them and at most `max_distance` away (which may be infinite), nearest
/// first. `point` points to 2 numbers. Writes them to `neighbors`; `*count` is how many were written.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the point is not finite, or the distance negative or NaN.
sap_status sap_world2d_nearest(struct sap_world2d *world,
                               const double *point,
                               double max_distance,
                               const struct sap_query *query,
                               struct sap_neighbor *neighbors,
                               size_t capacity,
                               size_t *count,
                               struct sap_error *error);

/// The body that a ray or a moving box hits first; of several at once that with the smallest slot. `hit->id` is `SAP_NO_ID` if
/// it hits none.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if its box or direction is not finite, its box inverted, or its limit negative or NaN.
sap_status sap_world2d_cast(struct sap_world2d *world,
                            const struct sap_cast2d *cast,
                            const struct sap_query *query,
                            struct sap_hit2d *hit,
                            struct sap_error *error);

/// Everything that a ray or a moving box hits, sorted by t and then by slot. Writes the first `capacity` of them to `hits`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: as `sap_world2d_cast`.
sap_status sap_world2d_cast_all(struct sap_world2d *world,
                                const struct sap_cast2d *cast,
                                const struct sap_query *query,
                                struct sap_hit2d *hits,
                                size_t capacity,
                                size_t *count,
                                struct sap_error *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SWEEP_AND_PRUNE_H */
