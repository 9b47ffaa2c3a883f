// ODE: its sweep and prune and its hash space, filled with box geometries. Coordinates are double,
// a box is given by its middle and its sides, and one without size is ignored, so every side is made
// positive and the pairs are tested once more on the boxes.
#include "libraries.h"

#include <algorithm>
#include <limits>

#include <ode/ode.h>

namespace {

const dReal smallest_side = std::numeric_limits<dReal>::min();

struct Found {
    const Boxes &boxes;
    Pairs &pairs;
};

void keep(void *data, dGeomID a, dGeomID b) {
    auto &found = *static_cast<Found *>(data);
    const auto id = [](dGeomID geom) {
        return static_cast<std::uint32_t>(reinterpret_cast<std::size_t>(dGeomGetData(geom)));
    };
    if (found.boxes.overlap(id(a), id(b))) found.pairs.push_back({id(a), id(b)});
}

void find(dSpaceID space, const Boxes &boxes, Pairs &pairs) {
    for (std::size_t id = 0; id < boxes.count; ++id) {
        dReal side[3], middle[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const dReal min = boxes.min(id, axis), max = boxes.max(id, axis);
            side[axis] = std::max(max - min, smallest_side);
            middle[axis] = (min + max) / 2;
        }
        dGeomID box = dCreateBox(space, side[0], side[1], side[2]);
        dGeomSetPosition(box, middle[0], middle[1], middle[2]);
        dGeomSetData(box, reinterpret_cast<void *>(id));
    }
    Found found{boxes, pairs};
    dSpaceCollide(space, &found, keep);
    dSpaceDestroy(space);
}

// The axes in the order that the sweep and prune wants, the one of largest variance first.
int axis_order(const Boxes &boxes) {
    double variance[3] = {};
    for (std::size_t axis = 0; axis < boxes.dimensions; ++axis) {
        double sum = 0, squares = 0;
        for (std::size_t id = 0; id < boxes.count; ++id) {
            const double middle = double(boxes.min(id, axis)) + boxes.max(id, axis);
            sum += middle;
            squares += middle * middle;
        }
        variance[axis] = squares - sum * sum / static_cast<double>(boxes.count);
    }
    int axes[3] = {0, 1, 2};
    std::sort(axes, axes + 3, [&](int a, int b) { return variance[a] > variance[b]; });
    return axes[0] | axes[1] << 2 | axes[2] << 4;
}

void start() {
    static const int started = dInitODE2(0);
    (void)started;
}

} // namespace

extern "C" void bench_ode_sweep(const Boxes *boxes, Pairs *pairs) {
    start();
    find(dSweepAndPruneSpaceCreate(nullptr, axis_order(*boxes)), *boxes, *pairs);
}

extern "C" void bench_ode_hash(const Boxes *boxes, Pairs *pairs) {
    start();
    find(dHashSpaceCreate(nullptr), *boxes, *pairs);
}
