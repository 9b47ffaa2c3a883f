// What the tests share. They are compiled for each kind of boxes, by -DKIND=3f -DDIMENSIONS=3 -DSCALAR=float and the like.
#ifndef SUPPORT_H
#define SUPPORT_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sweep_and_prune.h>

#include "check.h"

#define JOIN_EXPANDED(a, b, c) a##b##c
#define JOIN(a, b, c) JOIN_EXPANDED(a, b, c)
#define FINDER(function) JOIN(sap_finder, KIND, function)
#define WORLD(function) JOIN(sap_world, KIND, function)

typedef JOIN(sap_finder, KIND, ) finder_type;
typedef JOIN(sap_world, KIND, ) world_type;
typedef JOIN(sap_aabb, KIND, ) aabb_type;
typedef JOIN(sap_options, KIND, ) options_type;
typedef JOIN(sap_cast, KIND, ) cast_type;
typedef JOIN(sap_hit, KIND, ) hit_type;
typedef SCALAR scalar;

// Ends the test unless a call succeeds. The call names `&error`.
#define OK(call)                                                                                   \
    do {                                                                                           \
        sap_error error;                                                                           \
        if ((call) != SAP_OK) {                                                                    \
            fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__, #call, error.message);          \
            exit(1);                                                                               \
        }                                                                                          \
    } while (0)

// Ends the test unless a call fails with a status and says so in `error`.
#define FAILS(wanted, call)                                                                        \
    do {                                                                                           \
        sap_error error;                                                                           \
        memset(&error, 0x55, sizeof error);                                                        \
        sap_status status = (call);                                                                \
        if (status != (wanted)) {                                                                  \
            fprintf(stderr, "%s:%d: %s: %s instead of %s\n", __FILE__, __LINE__, #call,            \
                    sap_status_name(status), #wanted);                                             \
            exit(1);                                                                               \
        }                                                                                          \
        CHECK(error.status == status && strlen(error.message) > 5);                                \
        CHECK(memchr(error.message, 0, sizeof error.message) != NULL);                             \
    } while (0)

static uint64_t random_state = 1;

// A random number below a limit, by xorshift64*.
static inline uint32_t below(uint32_t limit) {
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (uint32_t)((random_state * 0x2545F4914F6CDD1Dull) >> 33) % limit;
}

static inline uint64_t random_bits(void) {
    uint64_t high = below(1u << 31), low = below(1u << 31);
    return high << 33 ^ low << 2 ^ below(4);
}

// A box of few distinct coordinates, so that many touch each other. One edge in sixty is infinite.
static inline aabb_type random_box(uint32_t width) {
    aabb_type box;
    for (int axis = 0; axis < DIMENSIONS; axis++) {
        box.min[axis] = (scalar)below(width);
        box.max[axis] = box.min[axis] + (scalar)below(4);
        if (below(60) == 0) box.min[axis] = -INFINITY;
        if (below(60) == 0) box.max[axis] = INFINITY;
    }
    return box;
}

// A box that is inverted or NaN on one axis.
static inline aabb_type bad_box(void) {
    aabb_type box = random_box(10);
    uint32_t axis = below(DIMENSIONS);
    switch (below(3)) {
    case 0: box.min[axis] = NAN; break;
    case 1: box.max[axis] = NAN; break;
    default: box.min[axis] = 5, box.max[axis] = 4;
    }
    return box;
}

static inline bool overlap(const aabb_type *a, const aabb_type *b) {
    for (int axis = 0; axis < DIMENSIONS; axis++)
        if (a->min[axis] > b->max[axis] || b->min[axis] > a->max[axis]) return false;
    return true;
}

static inline bool same_box(const aabb_type *a, const aabb_type *b) {
    for (int axis = 0; axis < DIMENSIONS; axis++)
        if (a->min[axis] != b->min[axis] || a->max[axis] != b->max[axis]) return false;
    return true;
}

static inline int compare_numbers(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

// An id as a number in the order of slots.
static inline uint64_t by_slot(sap_id id) { return id << 32 | id >> 32; }

#endif
