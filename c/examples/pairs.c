// Which boxes overlap? Prints "0 and 2".
#include <stdio.h>
#include <sweep_and_prune.h>

int main(void) {
    // Each is a min corner and a max corner. The third touches the first, so they overlap.
    sap_aabb2f boxes[] = {{{0, 0}, {2, 2}}, {{5, 5}, {6, 6}}, {{2, 1}, {3, 4}}};
    sap_finder2f *finder = NULL;
    const sap_pair *pairs = NULL;
    size_t count = 0;
    sap_finder2f_create(1, &finder, NULL);
    sap_finder2f_find(finder, boxes, 3, &pairs, &count, NULL);
    for (size_t i = 0; i < count; i++) printf("%u and %u\n", (unsigned)pairs[i].a, (unsigned)pairs[i].b);
    sap_finder2f_destroy(&finder);
    return 0;
}
