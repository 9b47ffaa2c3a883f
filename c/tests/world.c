// Worlds against a model: random calls, many of them with stale, foreign and null arguments. The model is brute force.
#include "support.h"

enum { MOST = 90, LIST = MOST * MOST };

typedef struct {
    sap_id id;
    aabb_type box, swept_to;
    sap_filter filter;
    bool is_swept, is_disabled;
} body;

static world_type *world, *other;
static body bodies[MOST];
static size_t count;
static sap_id removed[MOST]; // some ids of bodies that were removed
static size_t removed_count;
static bool is_fat;

// Pairs as two numbers in the order of slots.
typedef struct {
    uint64_t a, b;
} pair;
static pair live[LIST], now[LIST];
static size_t live_count, now_count;
static pair excluded_pairs[MOST];
static size_t excluded_count;

static int compare_pairs(const void *x, const void *y) {
    const pair *p = x, *q = y;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

static pair pair_of(sap_id a, sap_id b) {
    uint64_t x = by_slot(a), y = by_slot(b);
    return x < y ? (pair){x, y} : (pair){y, x};
}

static bool has(const pair *pairs, size_t length, pair wanted) {
    return length > 0 && bsearch(&wanted, pairs, length, sizeof wanted, compare_pairs) != NULL;
}

static size_t find_excluded(pair wanted) {
    size_t i = 0;
    while (i < excluded_count && compare_pairs(&excluded_pairs[i], &wanted) != 0) i++;
    return i;
}

static bool may_pair(const sap_filter *a, const sap_filter *b) {
    bool allows;
    if (a->is_static && b->is_static) allows = false;
    else if (a->group == b->group && a->group != 0) allows = a->group > 0;
    else allows = (a->category & b->mask) != 0 && (b->category & a->mask) != 0;
    CHECK(sap_filter_allows(a, b) == allows);
    return allows;
}

static uint64_t hash(void) {
    uint64_t hash;
    OK(WORLD(_state_hash)(world, &hash, &error));
    return hash;
}

static sap_filter random_filter(void) {
    if (below(2) == 0) return sap_filter_default();
    return (sap_filter){below(4), below(4), (int32_t)below(4) - 2, below(3) == 0};
}

// An id that names no body: of a removed body, of no world, of another world, or 0.
static sap_id bad_id(void) {
    for (;;) {
        sap_id id = SAP_NO_ID;
        switch (below(4)) {
        case 0: id = removed_count > 0 ? removed[below((uint32_t)removed_count)] : 0; break;
        case 1: id = random_bits(); break;
        case 2: id = (uint64_t)(1 + below(3)) << 32 | below(MOST); break;
        }
        size_t i = 0;
        while (i < count && bodies[i].id != id) i++;
        if (i == count) return id;
    }
}

static body *random_body(void) { return &bodies[below((uint32_t)count)]; }

static void forget(size_t index) {
    uint64_t gone = by_slot(bodies[index].id);
    for (size_t i = excluded_count; i-- > 0;)
        if (excluded_pairs[i].a == gone || excluded_pairs[i].b == gone) excluded_pairs[i] = excluded_pairs[--excluded_count];
    removed[removed_count < MOST ? removed_count++ : below(MOST)] = bodies[index].id;
    bodies[index] = bodies[--count];
}

static void insert(void) {
    body new = {.box = random_box(30), .filter = random_filter()};
    bool is_default = below(2) == 0;
    if (is_default) new.filter = sap_filter_default();
    OK(WORLD(_insert)(world, &new.box, is_default ? NULL : &new.filter, &new.id, &error));
    CHECK(new.id != SAP_NO_ID);
    bodies[count++] = new;
}

static void insert_many(void) {
    aabb_type boxes[10];
    sap_id ids[11] = {0};
    sap_filter filter = random_filter();
    size_t many = below(10);
    for (size_t i = 0; i < many; i++) boxes[i] = random_box(30);
    OK(WORLD(_insert_many)(world, boxes, many, &filter, ids, &error));
    CHECK(ids[many] == 0);
    for (size_t i = 0; i < many; i++) bodies[count++] = (body){.id = ids[i], .box = boxes[i], .filter = filter};
}

static void set_many(void) {
    sap_id ids[20];
    aabb_type boxes[20];
    size_t many = 1 + below(19);
    for (size_t i = 0; i < many; i++) {
        body *body = random_body();
        ids[i] = body->id;
        boxes[i] = random_box(30);
    }
    if (below(3) == 0) {
        uint32_t at = below((uint32_t)many);
        sap_id good = ids[at];
        aabb_type good_box = boxes[at];
        uint64_t before = hash();
        sap_error error;
        ids[at] = bad_id();
        CHECK(WORLD(_set_many)(world, ids, boxes, many, &error) == SAP_ERROR_STALE_ID && error.index == at);
        if (ids[at] != good) CHECK(WORLD(_remove_many)(world, ids, many, &error) == SAP_ERROR_STALE_ID);
        ids[at] = good;
        boxes[at] = bad_box();
        CHECK(WORLD(_set_many)(world, ids, boxes, many, &error) == SAP_ERROR_INVALID_BOX && error.index == at);
        boxes[at] = good_box;
        CHECK(hash() == before);
    }
    OK(WORLD(_set_many)(world, ids, boxes, many, &error));
    for (size_t i = 0; i < many; i++)
        for (size_t k = 0; k < count; k++)
            if (bodies[k].id == ids[i]) bodies[k].box = boxes[i], bodies[k].is_swept = false;
}

static void set_swept(void) {
    body *body = random_body();
    aabb_type from = random_box(30), to = random_box(30);
    OK(WORLD(_set_swept)(world, body->id, &from, &to, &error));
    body->is_swept = true;
    body->swept_to = to;
    for (int axis = 0; axis < DIMENSIONS; axis++) {
        body->box.min[axis] = fmin(from.min[axis], to.min[axis]);
        body->box.max[axis] = fmax(from.max[axis], to.max[axis]);
    }
}

static void toggle(void) {
    body *a = random_body(), *b = random_body();
    bool found;
    if (below(2) == 0) {
        a->is_disabled = !a->is_disabled;
        OK(WORLD(_set_enabled)(world, a->id, !a->is_disabled, &error));
        OK(WORLD(_is_enabled)(world, a->id, &found, &error));
        CHECK(found == !a->is_disabled);
        return;
    }
    pair pair = pair_of(a->id, b->id);
    size_t at = find_excluded(pair);
    bool is_excluded = at < excluded_count;
    OK(WORLD(_is_excluded)(world, b->id, a->id, &found, &error));
    CHECK(found == is_excluded);
    if (is_excluded) {
        OK(WORLD(_include_pair)(world, a->id, b->id, &error));
        excluded_pairs[at] = excluded_pairs[--excluded_count];
    } else if (excluded_count < MOST) {
        OK(WORLD(_exclude_pair)(world, a->id, b->id, &error));
        if (a != b) excluded_pairs[excluded_count++] = pair;
    }
}

static void shift(void) {
    scalar offset[DIMENSIONS];
    for (int axis = 0; axis < DIMENSIONS; axis++) offset[axis] = (scalar)below(5) - 2;
    OK(WORLD(_shift)(world, offset, &error));
    for (size_t i = 0; i < count; i++) {
        for (int axis = 0; axis < DIMENSIONS; axis++) {
            bodies[i].box.min[axis] += offset[axis];
            bodies[i].box.max[axis] += offset[axis];
            bodies[i].swept_to.min[axis] += offset[axis];
            bodies[i].swept_to.max[axis] += offset[axis];
        }
    }
    offset[below(DIMENSIONS)] = below(2) == 0 ? NAN : INFINITY;
    FAILS(SAP_ERROR_INVALID_OFFSET, WORLD(_shift)(world, offset, &error));
}

static void remove_some(void) {
    if (below(20) == 0) {
        OK(WORLD(_clear)(world, &error));
        while (count > 0) forget(count - 1);
        return;
    }
    sap_id ids[3];
    size_t many = 0;
    for (size_t i = 0; i < 3; i++) {
        sap_id id = random_body()->id;
        bool is_new = true;
        for (size_t k = 0; k < many; k++) is_new &= ids[k] != id;
        if (is_new) ids[many++] = id;
        else FAILS(SAP_ERROR_STALE_ID, WORLD(_remove_many)(world, (sap_id[]){id, id}, 2, &error));
    }
    if (below(2) == 0) OK(WORLD(_remove_many)(world, ids, many, &error));
    else
        for (size_t i = 0; i < many; i++) OK(WORLD(_remove)(world, ids[i], &error));
    for (size_t i = 0; i < many; i++)
        for (size_t k = 0; k < count; k++)
            if (bodies[k].id == ids[i]) {
                forget(k);
                break;
            }
}

// Events of an update are sorted, new, and together make what was live into what is live.
static void update(void) {
    sap_changes changes;
    OK(WORLD(_update)(world, &changes, &error));
    aabb_type boxes[MOST];
    for (size_t i = 0; i < count; i++) {
        boxes[i] = bodies[i].box;
        if (is_fat) OK(WORLD(_reported_aabb)(world, bodies[i].id, &boxes[i], &error));
        for (int axis = 0; axis < DIMENSIONS; axis++) {
            CHECK(boxes[i].min[axis] <= bodies[i].box.min[axis]);
            CHECK(boxes[i].max[axis] >= bodies[i].box.max[axis]);
        }
    }
    now_count = 0;
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count; b++)
            if (overlap(&boxes[a], &boxes[b]) && may_pair(&bodies[a].filter, &bodies[b].filter) && !bodies[a].is_disabled &&
                !bodies[b].is_disabled && find_excluded(pair_of(bodies[a].id, bodies[b].id)) == excluded_count)
                now[now_count++] = pair_of(bodies[a].id, bodies[b].id);
    qsort(now, now_count, sizeof *now, compare_pairs);
    size_t begun = 0, ended = 0;
    for (size_t i = 0; i < now_count; i++) {
        if (has(live, live_count, now[i])) continue;
        CHECK(begun < changes.begun_count);
        pair event = {by_slot(changes.begun[begun].a), by_slot(changes.begun[begun].b)};
        CHECK(compare_pairs(&event, &now[i]) == 0);
        begun++;
    }
    CHECK(begun == changes.begun_count && (begun == 0) == (changes.begun == NULL));
    for (size_t i = 0; i < live_count; i++) {
        if (has(now, now_count, live[i])) continue;
        CHECK(ended < changes.ended_count);
        pair event = {by_slot(changes.ended[ended].a), by_slot(changes.ended[ended].b)};
        CHECK(compare_pairs(&event, &live[i]) == 0);
        ended++;
    }
    CHECK(ended == changes.ended_count && (ended == 0) == (changes.ended == NULL));
    memcpy(live, now, now_count * sizeof *now);
    live_count = now_count;
    for (size_t i = 0; i < count; i++)
        if (bodies[i].is_swept) bodies[i].box = bodies[i].swept_to, bodies[i].is_swept = false;
}

static sap_id_pair pairs[LIST + 1];
static sap_id ids[LIST + 1];

// Everything that can be read is as the model says.
static void read(void) {
    size_t found;
    bool contains;
    OK(WORLD(_len)(world, &found, &error));
    CHECK(found == count);
    uint64_t expected[MOST];
    for (size_t i = 0; i < count; i++) {
        body *body = &bodies[i];
        aabb_type box;
        sap_filter filter;
        expected[i] = by_slot(body->id);
        OK(WORLD(_aabb)(world, body->id, &box, &error));
        OK(WORLD(_filter)(world, body->id, &filter, &error));
        OK(WORLD(_contains)(world, body->id, &contains, &error));
        CHECK(contains && same_box(&box, &body->box));
        CHECK(filter.category == body->filter.category && filter.mask == body->filter.mask);
        CHECK(filter.group == body->filter.group && filter.is_static == body->filter.is_static);
    }
    qsort(expected, count, sizeof *expected, compare_numbers);
    // A list that is too short gets the first ids.
    size_t capacity = below(2) == 0 ? LIST : below(10);
    ids[capacity] = 1234;
    OK(WORLD(_ids)(world, ids, capacity, &found, &error));
    CHECK(found == count && ids[capacity] == 1234);
    for (size_t i = 0; i < found && i < capacity; i++) CHECK(by_slot(ids[i]) == expected[i]);

    pairs[capacity].a = 1234;
    OK(WORLD(_pairs)(world, pairs, capacity, &found, &error));
    CHECK(pairs[capacity].a == 1234);
    // Those of bodies that were removed since the update are still pairs of it.
    CHECK(found == live_count);
    for (size_t i = 0; i < found && i < capacity; i++)
        CHECK(by_slot(pairs[i].a) == live[i].a && by_slot(pairs[i].b) == live[i].b);

    if (count == 0) return;
    sap_id id = random_body()->id;
    size_t of = 0;
    OK(WORLD(_pairs_of)(world, id, ids, LIST, &found, &error));
    for (size_t i = 0; i < live_count; i++) of += live[i].a == by_slot(id) || live[i].b == by_slot(id);
    CHECK(found == of);
    for (size_t i = 0; i < found; i++) CHECK(has(live, live_count, pair_of(id, ids[i])));
}

typedef struct {
    double key; // a distance, or t
    uint64_t slot;
    const body *body;
} answer;

static int compare_answers(const void *x, const void *y) {
    const answer *p = x, *q = y;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return (p->slot > q->slot) - (p->slot < q->slot);
}

static double distance_squared(const scalar *point, const aabb_type *box) {
    double sum = 0;
    for (int axis = 0; axis < DIMENSIONS; axis++) {
        double gap = fmax(fmax((double)box->min[axis] - point[axis], (double)point[axis] - box->max[axis]), 0);
        sum += gap * gap;
    }
    return sum;
}

// The t at which a cast first touches a box; negative if it does not.
static double touch(const cast_type *cast, const aabb_type *box) {
    double first = 0, last = cast->limit;
    for (int axis = 0; axis < DIMENSIONS; axis++) {
        double speed = cast->direction[axis];
        double before = (double)box->min[axis] - cast->from.max[axis];
        double behind = (double)box->max[axis] - cast->from.min[axis];
        if (speed == 0) {
            if (before > 0 || behind < 0) return -1;
            continue;
        }
        first = fmax(first, (speed > 0 ? before : behind) / speed);
        last = fmin(last, (speed > 0 ? behind : before) / speed);
    }
    return first <= last ? first : -1;
}

typedef struct {
    size_t seen, most;
    aabb_type area;
} visit;

static bool visitor(void *context, sap_id id) {
    visit *visit = context;
    aabb_type box;
    // It may read and ask, but not change.
    OK(WORLD(_aabb)(world, id, &box, &error));
    CHECK(overlap(&box, &visit->area));
    size_t found;
    OK(WORLD(_overlapping)(world, &visit->area, NULL, NULL, 0, &found, &error));
    CHECK(found > 0);
    FAILS(SAP_ERROR_BUSY, WORLD(_update)(world, NULL, &error));
    FAILS(SAP_ERROR_BUSY, WORLD(_remove)(world, id, &error));
    FAILS(SAP_ERROR_BUSY, WORLD(_assign)(world, world, &error));
    return ++visit->seen < visit->most;
}

static void ask(void) {
    aabb_type area = random_box(30);
    sap_filter filter = random_filter();
    sap_id excluded[3];
    size_t excluded_count = count > 0 ? below(3) : 0;
    for (size_t i = 0; i < excluded_count; i++) excluded[i] = below(3) == 0 ? bad_id() : random_body()->id;
    sap_query query = {below(2) == 0 ? &filter : NULL, excluded, excluded_count, below(2) == 0};
    scalar point[DIMENSIONS];
    for (int axis = 0; axis < DIMENSIONS; axis++) point[axis] = (scalar)below(30);
    scalar radius = (scalar)below(10);
    cast_type cast = {.from = area, .limit = below(5) == 0 ? INFINITY : (scalar)below(20)};
    if (below(3) == 0) {
        cast = JOIN(sap_ray, KIND, )(point, point, cast.limit);
        for (int axis = 0; axis < DIMENSIONS; axis++)
            CHECK(cast.from.min[axis] == point[axis] && cast.from.max[axis] == point[axis]);
    }
    for (int axis = 0; axis < DIMENSIONS; axis++) {
        // A cast begins at a finite box.
        if (!isfinite(cast.from.min[axis])) cast.from.min[axis] = fmin(0, cast.from.max[axis]);
        if (!isfinite(cast.from.min[axis])) cast.from.min[axis] = 0;
        if (!isfinite(cast.from.max[axis])) cast.from.max[axis] = cast.from.min[axis];
        cast.direction[axis] = (scalar)below(5) - 2;
    }

    answer near[MOST], hit[MOST];
    size_t overlapping = 0, containing = 0, within = 0, near_count = 0, hit_count = 0;
    for (size_t i = 0; i < count; i++) {
        const body *body = &bodies[i];
        if (body->is_disabled || (query.filter && !may_pair(query.filter, &body->filter))) continue;
        bool is_excluded = false;
        for (size_t k = 0; k < excluded_count; k++) is_excluded |= excluded[k] == body->id;
        if (is_excluded) continue;
        double distance = distance_squared(point, &body->box), t = touch(&cast, &body->box);
        overlapping += overlap(&area, &body->box);
        containing += distance == 0;
        within += distance <= (double)radius * radius;
        if (distance <= 400) near[near_count++] = (answer){distance, by_slot(body->id), body};
        if (t >= 0) hit[hit_count++] = (answer){t, by_slot(body->id), body};
    }
    qsort(near, near_count, sizeof *near, compare_answers);
    qsort(hit, hit_count, sizeof *hit, compare_answers);

    if (below(2) == 0) OK(WORLD(_prepare_queries)(world, &error));
    size_t found, capacity = below(2) == 0 ? LIST : below(5);
    ids[capacity] = 1234;
    OK(WORLD(_overlapping)(world, &area, &query, ids, capacity, &found, &error));
    CHECK(found == overlapping && ids[capacity] == 1234);
    for (size_t i = 0; i < found && i < capacity; i++) {
        aabb_type box;
        OK(WORLD(_aabb)(world, ids[i], &box, &error));
        CHECK(overlap(&box, &area));
        CHECK(i == 0 || query.unsorted || by_slot(ids[i - 1]) < by_slot(ids[i]));
    }
    OK(WORLD(_containing)(world, point, &query, ids, LIST, &found, &error));
    CHECK(found == containing);
    OK(WORLD(_within)(world, point, radius, &query, ids, LIST, &found, &error));
    CHECK(found == within);

    visit all = {0, SIZE_MAX, area}, one = {0, 1, area};
    OK(WORLD(_each_overlapping)(world, &area, &query, visitor, &all, &error));
    OK(WORLD(_each_overlapping)(world, &area, &query, visitor, &one, &error));
    CHECK(all.seen == overlapping && one.seen == (overlapping > 0));

    sap_neighbor neighbors[11];
    size_t k = below(10);
    neighbors[k].id = 1234;
    OK(WORLD(_nearest)(world, point, 20, &query, neighbors, k, &found, &error));
    CHECK(found == (near_count < k ? near_count : k) && neighbors[k].id == 1234);
    for (size_t i = 0; i < found; i++)
        CHECK(neighbors[i].id == near[i].body->id && neighbors[i].distance_squared == near[i].key);

    hit_type hits[MOST + 1], first;
    OK(WORLD(_cast)(world, &cast, &query, &first, &error));
    CHECK(first.id == (hit_count > 0 ? hit[0].body->id : SAP_NO_ID));
    OK(WORLD(_cast_all)(world, &cast, &query, hits, MOST, &found, &error));
    CHECK(found == hit_count);
    for (size_t i = 0; i < found; i++) {
        CHECK(hits[i].id == hit[i].body->id && hits[i].t == hit[i].key);
        double length = 0;
        bool is_inside = true;
        for (int axis = 0; axis < DIMENSIONS; axis++) {
            length += fabs((double)hits[i].normal[axis]);
            is_inside &= hit[i].body->box.min[axis] < cast.from.max[axis];
            is_inside &= hit[i].body->box.max[axis] > cast.from.min[axis];
        }
        CHECK(hits[i].starts_inside == is_inside && length == (is_inside ? 0 : 1));
    }
    cast.ignore_touching = true;
    OK(WORLD(_cast_all)(world, &cast, &query, NULL, 0, &found, &error));
    CHECK(found <= hit_count);
    cast.limit = -1;
    FAILS(SAP_ERROR_INVALID_QUERY, WORLD(_cast)(world, &cast, &query, &first, &error));
    FAILS(SAP_ERROR_INVALID_QUERY, WORLD(_cast_all)(world, &cast, &query, hits, MOST, &found, &error));
    FAILS(SAP_ERROR_INVALID_QUERY, WORLD(_within)(world, point, -1, NULL, ids, LIST, &found, &error));
    FAILS(SAP_ERROR_INVALID_QUERY, WORLD(_nearest)(world, point, -1, NULL, neighbors, 1, &found, &error));
    area = bad_box();
    FAILS(SAP_ERROR_INVALID_BOX, WORLD(_overlapping)(world, &area, &query, ids, LIST, &found, &error));
    FAILS(SAP_ERROR_INVALID_BOX, WORLD(_each_overlapping)(world, &area, &query, visitor, &all, &error));
    point[below(DIMENSIONS)] = NAN;
    FAILS(SAP_ERROR_INVALID_QUERY, WORLD(_containing)(world, point, NULL, ids, LIST, &found, &error));
    FAILS(SAP_ERROR_INVALID_QUERY, WORLD(_nearest)(world, point, 1, NULL, neighbors, 1, &found, &error));
}

// The world goes on as another one that is equal to it.
static void replace(void) {
    uint64_t before = hash();
    const uint8_t *bytes;
    size_t length;
    world_type *copy;
    switch (below(3)) {
    case 0:
        OK(WORLD(_snapshot)(world, &bytes, &length, &error));
        OK(WORLD(_restore)(other, bytes, length, &error));
        copy = other, other = world, world = copy;
        break;
    case 1:
        OK(WORLD(_copy)(world, &copy, &error));
        WORLD(_destroy)(&world);
        CHECK(world == NULL);
        world = copy;
        break;
    default:
        OK(WORLD(_assign)(other, world, &error));
        copy = other, other = world, world = copy;
    }
    CHECK(hash() == before);

    // Bytes that are cut off or changed are no snapshot.
    OK(WORLD(_snapshot)(world, &bytes, &length, &error));
    uint8_t *damaged = malloc(length);
    memcpy(damaged, bytes, length);
    FAILS(SAP_ERROR_INVALID_SNAPSHOT, WORLD(_restore)(world, damaged, below((uint32_t)length), &error));
    damaged[below((uint32_t)length)] ^= (uint8_t)(1 + below(255));
    FAILS(SAP_ERROR_INVALID_SNAPSHOT, WORLD(_restore)(world, damaged, length, &error));
    free(damaged);
    CHECK(hash() == before);
    OK(WORLD(_shrink_to_fit)(world, &error));
    CHECK(hash() == before);
}

// Calls with ids of no body, boxes that are none, no world, and what is not a world: all are errors, and nothing changes.
static void hostile(void) {
    uint64_t before = hash();
    aabb_type box = random_box(30), bad = bad_box(), out;
    sap_id id = bad_id(), good = count > 0 ? random_body()->id : 0;
    sap_filter filter;
    size_t found;
    bool contains = true;
    OK(WORLD(_contains)(world, id, &contains, &error));
    CHECK(!contains);
    FAILS(SAP_ERROR_STALE_ID, WORLD(_set)(world, id, &box, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_set_many)(world, &id, &box, 1, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_set_swept)(world, id, &box, &box, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_teleport)(world, id, &box, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_set_filter)(world, id, NULL, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_set_enabled)(world, id, false, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_is_enabled)(world, id, &contains, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_exclude_pair)(world, id, id, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_include_pair)(world, id, id, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_is_excluded)(world, id, id, &contains, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_remove)(world, id, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_remove_many)(world, &id, 1, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_aabb)(world, id, &out, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_reported_aabb)(world, id, &out, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_filter)(world, id, &filter, &error));
    FAILS(SAP_ERROR_STALE_ID, WORLD(_pairs_of)(world, id, ids, LIST, &found, &error));
    FAILS(SAP_ERROR_INVALID_BOX, WORLD(_insert)(world, &bad, NULL, NULL, &error));
    FAILS(SAP_ERROR_INVALID_BOX, WORLD(_insert_many)(world, &bad, 1, NULL, NULL, &error));
    if (good != 0) {
        sap_error error;
        CHECK(WORLD(_exclude_pair)(world, good, id, &error) == SAP_ERROR_STALE_ID && error.index == 1);
        FAILS(SAP_ERROR_INVALID_BOX, WORLD(_set)(world, good, &bad, &error));
        FAILS(SAP_ERROR_INVALID_BOX, WORLD(_set_swept)(world, good, &box, &bad, &error));
        FAILS(SAP_ERROR_INVALID_BOX, WORLD(_teleport)(world, good, &bad, &error));
        CHECK(WORLD(_teleport)(world, good, &bad, NULL) == SAP_ERROR_INVALID_BOX);
    }
    CHECK(hash() == before);
}

static void bad_arguments(void) {
    finder_type *finder;
    world_type *none = NULL, *made;
    aabb_type box = random_box(30), *nothing = NULL;
    scalar point[DIMENSIONS] = {0};
    cast_type cast = {.limit = 1};
    hit_type hit;
    sap_query query = {NULL, NULL, 1, false}; // it says that it excludes an id, and has none
    sap_changes changes;
    sap_neighbor neighbor;
    sap_filter filter;
    sap_id id;
    size_t found;
    uint64_t number;
    bool contains;
    const uint8_t *bytes;
    OK(FINDER(_create)(1, &finder, &error));
    world_type *bad[] = {NULL, (world_type *)finder};
    for (int i = 0; i < 2; i++) {
        world_type *w = bad[i];
        sap_status wanted = i == 0 ? SAP_ERROR_INVALID_ARGUMENT : SAP_ERROR_WRONG_HANDLE;
        FAILS(wanted, WORLD(_copy)(w, &made, &error));
        FAILS(wanted, WORLD(_assign)(w, world, &error));
        FAILS(wanted, WORLD(_assign)(world, w, &error));
        FAILS(wanted, WORLD(_insert)(w, &box, NULL, &id, &error));
        FAILS(wanted, WORLD(_insert_many)(w, &box, 1, NULL, &id, &error));
        FAILS(wanted, WORLD(_set)(w, 1, &box, &error));
        FAILS(wanted, WORLD(_set_many)(w, &id, &box, 1, &error));
        FAILS(wanted, WORLD(_set_swept)(w, 1, &box, &box, &error));
        FAILS(wanted, WORLD(_teleport)(w, 1, &box, &error));
        FAILS(wanted, WORLD(_shift)(w, point, &error));
        FAILS(wanted, WORLD(_set_filter)(w, 1, NULL, &error));
        FAILS(wanted, WORLD(_set_enabled)(w, 1, true, &error));
        FAILS(wanted, WORLD(_is_enabled)(w, 1, &contains, &error));
        FAILS(wanted, WORLD(_exclude_pair)(w, 1, 1, &error));
        FAILS(wanted, WORLD(_include_pair)(w, 1, 1, &error));
        FAILS(wanted, WORLD(_is_excluded)(w, 1, 1, &contains, &error));
        FAILS(wanted, WORLD(_remove)(w, 1, &error));
        FAILS(wanted, WORLD(_remove_many)(w, &id, 1, &error));
        FAILS(wanted, WORLD(_clear)(w, &error));
        FAILS(wanted, WORLD(_update)(w, &changes, &error));
        FAILS(wanted, WORLD(_len)(w, &found, &error));
        FAILS(wanted, WORLD(_contains)(w, 1, &contains, &error));
        FAILS(wanted, WORLD(_aabb)(w, 1, &box, &error));
        FAILS(wanted, WORLD(_reported_aabb)(w, 1, &box, &error));
        FAILS(wanted, WORLD(_filter)(w, 1, &filter, &error));
        FAILS(wanted, WORLD(_ids)(w, ids, LIST, &found, &error));
        FAILS(wanted, WORLD(_pairs)(w, pairs, LIST, &found, &error));
        FAILS(wanted, WORLD(_pairs_of)(w, 1, ids, LIST, &found, &error));
        FAILS(wanted, WORLD(_snapshot)(w, &bytes, &found, &error));
        FAILS(wanted, WORLD(_restore)(w, (const uint8_t *)"", 1, &error));
        FAILS(wanted, WORLD(_state_hash)(w, &number, &error));
        FAILS(wanted, WORLD(_shrink_to_fit)(w, &error));
        FAILS(wanted, WORLD(_prepare_queries)(w, &error));
        FAILS(wanted, WORLD(_overlapping)(w, &box, NULL, ids, LIST, &found, &error));
        FAILS(wanted, WORLD(_each_overlapping)(w, &box, NULL, visitor, NULL, &error));
        FAILS(wanted, WORLD(_containing)(w, point, NULL, ids, LIST, &found, &error));
        FAILS(wanted, WORLD(_within)(w, point, 1, NULL, ids, LIST, &found, &error));
        FAILS(wanted, WORLD(_nearest)(w, point, 1, NULL, &neighbor, 1, &found, &error));
        FAILS(wanted, WORLD(_cast)(w, &cast, NULL, &hit, &error));
        FAILS(wanted, WORLD(_cast_all)(w, &cast, NULL, &hit, 1, &found, &error));
        WORLD(_destroy)(&bad[i]);
        CHECK(bad[i] == w);
    }
    sap_status wanted = SAP_ERROR_INVALID_ARGUMENT;
    const sap_filter *crooked = (const sap_filter *)((const char *)ids + 1);
    FAILS(wanted, WORLD(_create)(NULL, NULL, &error));
    FAILS(wanted, WORLD(_create)((const options_type *)crooked, &made, &error));
    FAILS(wanted, WORLD(_copy)(world, NULL, &error));
    FAILS(wanted, WORLD(_insert)(world, nothing, NULL, &id, &error));
    FAILS(wanted, WORLD(_insert)(world, &box, crooked, &id, &error));
    FAILS(wanted, WORLD(_insert)(world, &box, NULL, (sap_id *)((char *)ids + 1), &error));
    FAILS(wanted, WORLD(_insert_many)(world, nothing, 1, NULL, &id, &error));
    FAILS(wanted, WORLD(_insert_many)(world, &box, SIZE_MAX, NULL, &id, &error));
    FAILS(wanted, WORLD(_set)(world, 1, nothing, &error));
    FAILS(wanted, WORLD(_set_many)(world, NULL, &box, 1, &error));
    FAILS(wanted, WORLD(_set_many)(world, &id, nothing, 1, &error));
    FAILS(wanted, WORLD(_set_swept)(world, 1, nothing, &box, &error));
    FAILS(wanted, WORLD(_set_swept)(world, 1, &box, nothing, &error));
    FAILS(wanted, WORLD(_teleport)(world, 1, nothing, &error));
    FAILS(wanted, WORLD(_shift)(world, NULL, &error));
    FAILS(wanted, WORLD(_remove_many)(world, NULL, 1, &error));
    FAILS(wanted, WORLD(_update)(world, (sap_changes *)((char *)ids + 1), &error));
    FAILS(wanted, WORLD(_len)(world, NULL, &error));
    FAILS(wanted, WORLD(_contains)(world, 1, NULL, &error));
    FAILS(wanted, WORLD(_aabb)(world, 1, NULL, &error));
    FAILS(wanted, WORLD(_reported_aabb)(world, 1, NULL, &error));
    FAILS(wanted, WORLD(_filter)(world, 1, NULL, &error));
    FAILS(wanted, WORLD(_ids)(world, NULL, 1, &found, &error));
    FAILS(wanted, WORLD(_ids)(world, ids, 1, NULL, &error));
    FAILS(wanted, WORLD(_pairs)(world, NULL, 1, &found, &error));
    FAILS(wanted, WORLD(_pairs_of)(world, 1, NULL, 1, &found, &error));
    FAILS(wanted, WORLD(_snapshot)(world, NULL, &found, &error));
    FAILS(wanted, WORLD(_snapshot)(world, &bytes, NULL, &error));
    FAILS(wanted, WORLD(_restore)(world, NULL, 1, &error));
    FAILS(SAP_ERROR_INVALID_SNAPSHOT, WORLD(_restore)(world, NULL, 0, &error));
    FAILS(wanted, WORLD(_state_hash)(world, NULL, &error));
    FAILS(wanted, WORLD(_overlapping)(world, nothing, NULL, ids, LIST, &found, &error));
    FAILS(wanted, WORLD(_overlapping)(world, &box, &query, ids, LIST, &found, &error));
    FAILS(wanted, WORLD(_each_overlapping)(world, &box, NULL, NULL, NULL, &error));
    FAILS(wanted, WORLD(_containing)(world, NULL, NULL, ids, LIST, &found, &error));
    FAILS(wanted, WORLD(_within)(world, NULL, 1, NULL, ids, LIST, &found, &error));
    FAILS(wanted, WORLD(_nearest)(world, NULL, 1, NULL, &neighbor, 1, &found, &error));
    FAILS(wanted, WORLD(_nearest)(world, point, 1, NULL, NULL, 1, &found, &error));
    FAILS(wanted, WORLD(_cast)(world, NULL, NULL, &hit, &error));
    FAILS(wanted, WORLD(_cast)(world, &cast, NULL, NULL, &error));
    FAILS(wanted, WORLD(_cast_all)(world, &cast, NULL, NULL, 1, &found, &error));
    cast = JOIN(sap_ray, KIND, )(NULL, point, 1);
    FAILS(SAP_ERROR_INVALID_QUERY, WORLD(_cast)(world, &cast, NULL, &hit, &error));
    options_type options = {.fat = true, .margin = -1};
    FAILS(SAP_ERROR_INVALID_OPTION, WORLD(_create)(&options, &made, &error));
    WORLD(_destroy)(NULL);
    WORLD(_destroy)(&none);
    FINDER(_destroy)(&finder);
}

// A character that stands on a floor touches it, and hits it first whichever way it moves, unless it ignores what it touches.
static void cast_from_the_floor(void) {
    aabb_type floor = {0}, wall = {0}, character = {0};
    for (int axis = 0; axis < DIMENSIONS; axis++) {
        floor.min[axis] = wall.min[axis] = -10;
        floor.max[axis] = wall.max[axis] = 10;
        character.max[axis] = 1;
    }
    floor.max[DIMENSIONS - 1] = 0;
    wall.min[0] = 6;
    wall.max[0] = 7;
    wall.min[DIMENSIONS - 1] = 0.5;
    sap_id floor_id, wall_id;
    OK(WORLD(_insert)(world, &floor, NULL, &floor_id, &error));
    OK(WORLD(_insert)(world, &wall, NULL, &wall_id, &error));
    cast_type cast = {.from = character, .limit = 100};
    cast.direction[0] = 1;
    hit_type hits[3];
    size_t found;
    OK(WORLD(_cast_all)(world, &cast, NULL, hits, 3, &found, &error));
    CHECK(found == 2 && hits[0].id == floor_id && hits[0].t == 0 && hits[1].id == wall_id && hits[1].t == 5);
    CHECK(hits[0].normal[DIMENSIONS - 1] == 1 && hits[0].normal[0] == 0);
    CHECK(hits[1].normal[0] == -1 && hits[1].normal[DIMENSIONS - 1] == 0);
    cast.ignore_touching = true;
    OK(WORLD(_cast_all)(world, &cast, NULL, hits, 3, &found, &error));
    CHECK(found == 1 && hits[0].id == wall_id && hits[0].t == 5 && hits[0].normal[0] == -1);
    cast.direction[0] = 0;
    cast.direction[DIMENSIONS - 1] = 1;
    OK(WORLD(_cast)(world, &cast, NULL, hits, &error));
    CHECK(hits[0].id == SAP_NO_ID);
    OK(WORLD(_remove_many)(world, (sap_id[]){floor_id, wall_id}, 2, &error));
    OK(WORLD(_update)(world, NULL, &error));
}

int main(int argument_count, char **arguments) {
    int steps = argument_count > 1 ? atoi(arguments[1]) : 3000;
    random_state += argument_count > 2 ? strtoull(arguments[2], NULL, 10) : 0;
    for (int variant = 0; variant < 3; variant++) {
        is_fat = variant == 1;
        options_type options = {.fat = is_fat, .margin = 1, .prediction = 2, .threads = (uint32_t)variant};
        OK(WORLD(_create)(variant == 0 ? NULL : &options, &world, &error));
        OK(WORLD(_create)(NULL, &other, &error));
        bad_arguments();
        cast_from_the_floor();
        for (int step = 0; step < steps; step++) {
            uint32_t what = below(100);
            if (what < 10 && count < MOST) insert();
            else if (what < 14 && count + 10 < MOST) insert_many();
            else if (what < 20) update();
            else if (what < 24) ask();
            else if (what < 28) read();
            else if (what < 30) replace();
            else if (what < 36) hostile();
            else if (what < 37) shift();
            else if (count == 0) continue;
            else if (what < 44) remove_some();
            else if (what < 54) set_many();
            else if (what < 58 && !is_fat) set_swept(); // after an update, its fat AABB is that of the next one
            else {
                body *body = random_body();
                if (what < 61) {
                    toggle();
                    continue;
                }
                if (what < 64) {
                    body->filter = random_filter();
                    OK(WORLD(_set_filter)(world, body->id, &body->filter, &error));
                    continue;
                }
                body->box = random_box(30);
                body->is_swept = false;
                if (what < 70) OK(WORLD(_teleport)(world, body->id, &body->box, &error));
                else OK(WORLD(_set)(world, body->id, &body->box, &error));
            }
        }
        WORLD(_destroy)(&world);
        WORLD(_destroy)(&other);
        CHECK(world == NULL && other == NULL);
        count = live_count = removed_count = excluded_count = 0;
    }
    return 0;
}
