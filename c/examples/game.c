// A hero runs into a wall: which overlaps begin and end, what a ray hits, and what an error looks like.
#include <stdio.h>
#include <stdlib.h>
#include <sweep_and_prune.h>

static sap_error error;

// Every call can fail, and says why.
static void check(sap_status status) {
    if (status == SAP_OK) return;
    fprintf(stderr, "%s: %s\n", sap_status_name(status), error.message);
    exit(1);
}

int main(void) {
    sap_world2f *world = NULL;
    check(sap_world2f_create(NULL, &world, &error));

    sap_id hero, wall;
    sap_filter is_static = sap_filter_default();
    is_static.is_static = true;
    check(sap_world2f_insert(world, &(sap_aabb2f){{0, 0}, {1, 2}}, NULL, &hero, &error));
    check(sap_world2f_insert(world, &(sap_aabb2f){{5, -9}, {6, 9}}, &is_static, &wall, &error));

    for (int frame = 0; frame < 8; frame++) {
        float x = (float)frame;
        check(sap_world2f_set(world, hero, &(sap_aabb2f){{x, 0}, {x + 1, 2}}, &error));
        sap_changes changes;
        check(sap_world2f_update(world, &changes, &error));
        for (size_t i = 0; i < changes.begun_count; i++) printf("frame %d: the hero touches the wall\n", frame);
        for (size_t i = 0; i < changes.ended_count; i++) printf("frame %d: the hero is past it\n", frame);
    }

    // What does the hero see, looking back? The ray begins in its own box, so the query leaves that out.
    sap_cast2f look = sap_ray2f((float[]){7.5f, 1}, (float[]){-1, 0}, 100);
    sap_query query = {.excluded = &hero, .excluded_count = 1};
    sap_hit2f hit;
    check(sap_world2f_cast(world, &look, &query, &hit, &error));
    if (hit.id == wall) printf("the wall is %.1f away\n", hit.t);

    check(sap_world2f_remove(world, wall, &error));
    if (sap_world2f_remove(world, wall, &error) != SAP_OK) printf("%s\n", sap_status_name(error.status));
    sap_world2f_destroy(&world);
    return 0;
}
