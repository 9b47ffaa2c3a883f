// FCL: its dynamic tree, the broad phase that it recommends in general.
#include "libraries.h"

#include <memory>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

namespace {

// A geometry that is its bounding box and nothing else, so that no corner is computed and rounded.
struct Bounds final : fcl::CollisionGeometryd {
    Bounds(const fcl::Vector3d &min, const fcl::Vector3d &max) {
        aabb_local = fcl::AABBd(min, max);
        aabb_center = aabb_local.center();
        aabb_radius = (aabb_local.min_ - aabb_center).norm();
    }
    fcl::OBJECT_TYPE getObjectType() const override { return fcl::OT_GEOM; }
    fcl::NODE_TYPE getNodeType() const override { return fcl::GEOM_BOX; }
    void computeLocalAABB() override {}
};

std::uint32_t id(const fcl::CollisionObjectd *object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::size_t>(object->getUserData()));
}

bool keep(fcl::CollisionObjectd *a, fcl::CollisionObjectd *b, void *data) {
    static_cast<Pairs *>(data)->push_back({id(a), id(b)});
    return false;
}

} // namespace

extern "C" void bench_fcl(const Boxes *boxes, Pairs *pairs) {
    std::vector<fcl::CollisionObjectd> objects;
    std::vector<fcl::CollisionObjectd *> pointers;
    objects.reserve(boxes->count);
    pointers.reserve(boxes->count);
    for (std::size_t box = 0; box < boxes->count; ++box) {
        const fcl::Vector3d min(boxes->min(box, 0), boxes->min(box, 1), boxes->min(box, 2));
        const fcl::Vector3d max(boxes->max(box, 0), boxes->max(box, 1), boxes->max(box, 2));
        objects.emplace_back(std::make_shared<Bounds>(min, max));
        objects.back().setUserData(reinterpret_cast<void *>(box));
        pointers.push_back(&objects.back());
    }
    fcl::DynamicAABBTreeCollisionManagerd manager;
    manager.registerObjects(pointers);
    manager.setup();
    manager.collide(pairs, keep);
}
