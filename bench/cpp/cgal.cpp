// CGAL: a streamed segment tree (Zomorodian and Edelsbrunner), with its default cutoff.
#include "libraries.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

namespace {

template <int D> void find(const Boxes &boxes, Pairs &pairs) {
    namespace intersection = CGAL::Box_intersection_d;
    using Box = intersection::Box_with_info_d<float, D, std::uint32_t>;
    std::vector<Box> sorted;
    sorted.reserve(boxes.count);
    for (std::size_t id = 0; id < boxes.count; ++id) {
        float min[D], max[D];
        for (int axis = 0; axis < D; ++axis) {
            min[axis] = boxes.min(id, axis);
            max[axis] = boxes.max(id, axis);
        }
        sorted.emplace_back(min, max, static_cast<std::uint32_t>(id));
    }
    auto keep = [&](const Box &a, const Box &b) { pairs.push_back({a.info(), b.info()}); };
    const std::ptrdiff_t cutoff = 10;
    CGAL::box_self_intersection_d(sorted.begin(), sorted.end(), keep, cutoff, intersection::CLOSED);
}

} // namespace

extern "C" void bench_cgal(const Boxes *boxes, Pairs *pairs) {
    boxes->dimensions == 2 ? find<2>(*boxes, *pairs) : find<3>(*boxes, *pairs);
}
