// Finders against brute force, and every call that must fail.
#include "support.h"

enum { MOST = 400 };

static finder_type *finder;
static aabb_type sets[2][MOST];
static size_t counts[2];
static uint64_t expected[MOST * MOST], found[MOST * MOST];
static sap_pair in_order[MOST * MOST];
static size_t expected_count, found_count;

// The pairs of one set, or between the two sets.
static void brute_force(bool between) {
    expected_count = 0;
    for (size_t a = 0; a < counts[0]; a++)
        for (size_t b = between ? 0 : a + 1; b < counts[between]; b++)
            if (overlap(&sets[0][a], &sets[between][b])) expected[expected_count++] = (uint64_t)a << 32 | b;
}

static void take(const sap_pair *pairs, size_t count) {
    for (size_t i = 0; i < count; i++) found[found_count++] = (uint64_t)pairs[i].a << 32 | pairs[i].b;
}

static void compare(void) {
    CHECK(found_count == expected_count);
    qsort(found, found_count, sizeof *found, compare_numbers);
    CHECK(memcmp(found, expected, found_count * sizeof *found) == 0);
    found_count = 0;
}

static size_t calls_left;

static bool receive(void *context, const sap_pair *pairs, size_t count) {
    CHECK(context == &calls_left && count > 0);
    take(pairs, count);
    // The finder is in use.
    FAILS(SAP_ERROR_BUSY, FINDER(_count)(finder, sets[0], counts[0], &(uint64_t){0}, &error));
    finder_type *same = finder;
    FINDER(_destroy)(&same);
    CHECK(same == finder);
    return --calls_left > 0;
}

static void one_round(uint32_t width) {
    const aabb_type *a = sets[0], *b = sets[1];
    for (int set = 0; set < 2; set++) {
        counts[set] = below(4) == 0 ? below(4) : below(MOST);
        for (size_t i = 0; i < counts[set]; i++) sets[set][i] = random_box(width);
    }
    for (int between = 0; between < 2; between++) {
        brute_force(between);
        const sap_pair *pairs;
        size_t count;
        if (between) OK(FINDER(_find_between)(finder, a, counts[0], b, counts[1], &pairs, &count, &error));
        else OK(FINDER(_find)(finder, a, counts[0], &pairs, &count, &error));
        CHECK((pairs == NULL) == (count == 0));
        if (count > 0) memcpy(in_order, pairs, count * sizeof *pairs);
        take(pairs, count);
        compare();

        uint64_t number = 0;
        if (between) OK(FINDER(_count_between)(finder, a, counts[0], b, counts[1], &number, &error));
        else OK(FINDER(_count)(finder, a, counts[0], &number, &error));
        CHECK(number == expected_count);

        // A buffer that is too small gets the first pairs, and nothing after it is written.
        size_t capacity = below(3) == 0 ? below(20) : expected_count, total = 0;
        sap_pair *buffer = malloc((capacity + 1) * sizeof *buffer);
        buffer[capacity] = (sap_pair){77, 78};
        if (between)
            OK(FINDER(_find_between_into)(finder, a, counts[0], b, counts[1], buffer, capacity, &total, &error));
        else OK(FINDER(_find_into)(finder, a, counts[0], buffer, capacity, &total, &error));
        CHECK(total == expected_count && buffer[capacity].a == 77 && buffer[capacity].b == 78);
        CHECK(memcmp(buffer, in_order, (capacity < total ? capacity : total) * sizeof *buffer) == 0);
        free(buffer);

        calls_left = SIZE_MAX;
        if (between)
            OK(FINDER(_each_between)(finder, a, counts[0], b, counts[1], receive, &calls_left, &error));
        else OK(FINDER(_each)(finder, a, counts[0], receive, &calls_left, &error));
        compare();
        calls_left = 1;
        OK(FINDER(_each)(finder, a, counts[0], receive, &calls_left, &error));
        CHECK(calls_left == 0 || found_count == 0);
        found_count = 0;
    }
}

static void bad_boxes(void) {
    const sap_pair *pairs = (const sap_pair *)&sets;
    size_t count = 99;
    for (int i = 0; i < MOST; i++) sets[0][i] = sets[1][i] = random_box(20);
    uint32_t at = below(MOST);
    sets[1][at] = bad_box();
    sap_error error;
    CHECK(FINDER(_find)(finder, sets[1], MOST, &pairs, &count, &error) == SAP_ERROR_INVALID_BOX);
    CHECK(error.status == SAP_ERROR_INVALID_BOX && error.index == at && error.set == 0);
    CHECK(FINDER(_find_between)(finder, sets[0], MOST, sets[1], MOST, &pairs, &count, &error) ==
          SAP_ERROR_INVALID_BOX);
    CHECK(error.index == at && error.set == 1 && strstr(error.message, "second set"));
    CHECK(FINDER(_each)(finder, sets[1], MOST, receive, NULL, &error) == SAP_ERROR_INVALID_BOX);
    CHECK(FINDER(_find)(finder, sets[1], MOST, &pairs, &count, NULL) == SAP_ERROR_INVALID_BOX);
    // After an error no result has been written.
    CHECK(pairs == (const sap_pair *)&sets && count == 99);
}

static void bad_arguments(void) {
    const aabb_type *a = sets[0];
    const aabb_type *crooked = (const aabb_type *)((const char *)a + 1);
    const sap_pair *pairs;
    sap_pair buffer[1];
    size_t count;
    uint64_t number;
    finder_type *none = NULL;
    world_type *world;
    OK(WORLD(_create)(NULL, &world, &error));
    finder_type *wrong = (finder_type *)world;
    FAILS(SAP_ERROR_INVALID_ARGUMENT, FINDER(_create)(1, NULL, &error));
    finder_type *each[] = {none, wrong};
    for (int i = 0; i < 2; i++) {
        sap_status wanted = i == 0 ? SAP_ERROR_INVALID_ARGUMENT : SAP_ERROR_WRONG_HANDLE;
        FAILS(wanted, FINDER(_find)(each[i], a, 1, &pairs, &count, &error));
        FAILS(wanted, FINDER(_find_between)(each[i], a, 1, a, 1, &pairs, &count, &error));
        FAILS(wanted, FINDER(_find_into)(each[i], a, 1, buffer, 1, &count, &error));
        FAILS(wanted, FINDER(_find_between_into)(each[i], a, 1, a, 1, buffer, 1, &count, &error));
        FAILS(wanted, FINDER(_count)(each[i], a, 1, &number, &error));
        FAILS(wanted, FINDER(_count_between)(each[i], a, 1, a, 1, &number, &error));
        FAILS(wanted, FINDER(_each)(each[i], a, 1, receive, NULL, &error));
        FAILS(wanted, FINDER(_each_between)(each[i], a, 1, a, 1, receive, NULL, &error));
    }
    const aabb_type *bad[] = {NULL, crooked};
    for (int i = 0; i < 2; i++) {
        sap_status wanted = SAP_ERROR_INVALID_ARGUMENT;
        FAILS(wanted, FINDER(_find)(finder, bad[i], 1, &pairs, &count, &error));
        FAILS(wanted, FINDER(_find_between)(finder, bad[i], 1, a, 1, &pairs, &count, &error));
        FAILS(wanted, FINDER(_find_between)(finder, a, 1, bad[i], 1, &pairs, &count, &error));
        FAILS(wanted, FINDER(_find_into)(finder, bad[i], 1, buffer, 1, &count, &error));
        FAILS(wanted, FINDER(_count)(finder, bad[i], 1, &number, &error));
        FAILS(wanted, FINDER(_each)(finder, bad[i], 1, receive, NULL, &error));
    }
    sap_status wanted = SAP_ERROR_INVALID_ARGUMENT;
    FAILS(wanted, FINDER(_find)(finder, a, 1, NULL, &count, &error));
    FAILS(wanted, FINDER(_find)(finder, a, 1, &pairs, NULL, &error));
    FAILS(wanted, FINDER(_find)(finder, a, SIZE_MAX, &pairs, &count, &error));
    FAILS(wanted, FINDER(_find_into)(finder, a, 1, NULL, 1, &count, &error));
    FAILS(wanted, FINDER(_find_into)(finder, a, 1, buffer, 1, NULL, &error));
    FAILS(wanted, FINDER(_find_into)(finder, a, 1, buffer, SIZE_MAX, &count, &error));
    FAILS(wanted, FINDER(_count)(finder, a, 1, NULL, &error));
    FAILS(wanted, FINDER(_each)(finder, a, 1, NULL, NULL, &error));
    OK(FINDER(_find)(finder, NULL, 0, &pairs, &count, &error));
    CHECK(count == 0 && pairs == NULL);
    // What is not a finder is not destroyed.
    FINDER(_destroy)(&wrong);
    CHECK((world_type *)wrong == world);
    FINDER(_destroy)(NULL);
    FINDER(_destroy)(&none);
    WORLD(_destroy)(&world);
    CHECK(world == NULL);
}

int main(int count, char **arguments) {
    int rounds = count > 1 ? atoi(arguments[1]) : 60;
    random_state += count > 2 ? strtoull(arguments[2], NULL, 10) : 0;
    for (uint32_t threads = 0; threads < 3; threads++) {
        OK(FINDER(_create)(threads, &finder, &error));
        for (int i = 0; i < rounds; i++) one_round(2 + below(60));
        bad_boxes();
        bad_arguments();
        FINDER(_destroy)(&finder);
        CHECK(finder == NULL);
        FAILS(SAP_ERROR_INVALID_ARGUMENT, FINDER(_count)(finder, sets[0], 0, &(uint64_t){0}, &error));
    }
    CHECK(strcmp(sap_version(), VERSION) == 0);
    CHECK(strcmp(sap_status_name(SAP_ERROR_STALE_ID), "SAP_ERROR_STALE_ID") == 0);
    CHECK(strcmp(sap_status_name(SAP_ERROR_OTHER + 1), "unknown status") == 0);
    return 0;
}
