// Boost.Geometry: an R-tree, packed from all boxes at once and then asked once for each box.
#include "libraries.h"

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

namespace {

namespace geometry = boost::geometry;
namespace index = boost::geometry::index;

template <int D> void find(const Boxes &boxes, Pairs &pairs) {
    using Point = geometry::model::point<float, D, geometry::cs::cartesian>;
    using Box = geometry::model::box<Point>;
    using Value = std::pair<Box, std::uint32_t>;
    std::vector<Value> values;
    values.reserve(boxes.count);
    for (std::uint32_t id = 0; id < boxes.count; ++id) {
        Point min, max;
        min.template set<0>(boxes.min(id, 0)), max.template set<0>(boxes.max(id, 0));
        min.template set<1>(boxes.min(id, 1)), max.template set<1>(boxes.max(id, 1));
        if constexpr (D == 3) {
            min.template set<2>(boxes.min(id, 2)), max.template set<2>(boxes.max(id, 2));
        }
        values.emplace_back(Box(min, max), id);
    }
    const index::rtree<Value, index::rstar<16>> tree(values);
    // In the order of the tree, so that one query finds in the cache what the last one used.
    for (const Value &wanted : tree) {
        auto keep = [&](const Value &found) {
            if (wanted.second < found.second) pairs.push_back({wanted.second, found.second});
        };
        tree.query(index::intersects(wanted.first), boost::make_function_output_iterator(keep));
    }
}

} // namespace

extern "C" void bench_boost(const Boxes *boxes, Pairs *pairs) {
    boxes->dimensions == 2 ? find<2>(*boxes, *pairs) : find<3>(*boxes, *pairs);
}
