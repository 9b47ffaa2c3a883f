// The thread rules: readers at the same time, and an error instead of a race for everything else.
#include <pthread.h>

#include "support.h"

enum { BODIES = 2000, THREADS = 4, ROUNDS = 300 };

static world_type *world;
static aabb_type boxes[BODIES];
static sap_id ids[BODIES];

static void *query(void *unused) {
    (void)unused;
    for (int i = 0; i < ROUNDS; i++) {
        size_t found, expected = 0;
        aabb_type box;
        // Each thread has its own place to start, without a shared random state.
        const aabb_type *area = &boxes[(i * 7) % BODIES];
        for (int k = 0; k < BODIES; k++) expected += overlap(area, &boxes[k]);
        OK(WORLD(_overlapping)(world, area, NULL, NULL, 0, &found, &error));
        CHECK(found == expected);
        OK(WORLD(_aabb)(world, ids[i], &box, &error));
        CHECK(same_box(&box, &boxes[i]));
    }
    return NULL;
}

// Calls that change the world, some of them refused.
static void *change(void *done) {
    for (int i = 0; i < ROUNDS; i++) {
        sap_error error;
        sap_status status = WORLD(_set)(world, ids[i], &boxes[i], &error);
        CHECK(status == SAP_OK || status == SAP_ERROR_BUSY);
        *(size_t *)done += status == SAP_OK;
        status = WORLD(_update)(world, NULL, NULL);
        CHECK(status == SAP_OK || status == SAP_ERROR_BUSY);
    }
    return NULL;
}

static void *own_finder(void *unused) {
    (void)unused;
    finder_type *finder;
    OK(FINDER(_create)(2, &finder, &error));
    for (int i = 0; i < 3; i++) {
        uint64_t pairs;
        OK(FINDER(_count)(finder, boxes, BODIES, &pairs, &error));
        CHECK(pairs > 0);
    }
    FINDER(_destroy)(&finder);
    return NULL;
}

static void run(void *(*thread)(void *), size_t *counts) {
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++) CHECK(pthread_create(&threads[i], NULL, thread, counts ? &counts[i] : NULL) == 0);
    for (int i = 0; i < THREADS; i++) CHECK(pthread_join(threads[i], NULL) == 0);
}

int main(void) {
    options_type options = {.threads = 2};
    OK(WORLD(_create)(&options, &world, &error));
    for (int i = 0; i < BODIES; i++) boxes[i] = random_box(60);
    OK(WORLD(_insert_many)(world, boxes, BODIES, NULL, ids, &error));
    OK(WORLD(_prepare_queries)(world, &error));
    run(query, NULL);
    size_t done[THREADS] = {0};
    run(change, done);
    size_t all = 0;
    for (int i = 0; i < THREADS; i++) all += done[i];
    CHECK(all > 0);
    run(own_finder, NULL);
    WORLD(_destroy)(&world);
    return 0;
}
