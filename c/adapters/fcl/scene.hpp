// Boxes, spheres and cylinders at random places, as FCL's own tests of broad phases have them.
#ifndef SCENE_HPP
#define SCENE_HPP

#include <memory>
#include <random>
#include <vector>

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

template <class S> class scene {
public:
    /// `count` objects of `size`, in a cube that they fill to `density`. One in 50 is `longest` times as long as the others.
    scene(std::size_t count, S size, S density, S longest, unsigned seed) : random(seed) {
        side = size * std::cbrt(S(count) / density);
        for (std::size_t i = 0; i < count; i++) {
            const S extent = size * (i % 50 == 7 ? longest : 1);
            std::shared_ptr<fcl::CollisionGeometry<S>> shape;
            if (i % 3 == 0) shape = std::make_shared<fcl::Box<S>>(extent, size, size);
            if (i % 3 == 1) shape = std::make_shared<fcl::Sphere<S>>(extent / 2);
            if (i % 3 == 2) shape = std::make_shared<fcl::Cylinder<S>>(size / 2, extent);
            owned.push_back(std::make_unique<fcl::CollisionObject<S>>(shape));
            objects.push_back(owned.back().get());
            place(i);
        }
    }

    /// Puts an object anywhere.
    void place(std::size_t index) {
        fcl::Quaternion<S> turned(from(-1, 1), from(-1, 1), from(-1, 1), from(-1, 1));
        objects[index]->setTransform(turned.normalized(), fcl::Vector3<S>(from(0, side), from(0, side), from(0, side)));
        objects[index]->computeAABB();
    }
    /// Moves an object by at most `step` along each axis, and turns it.
    void move(std::size_t index, S step) {
        const fcl::Quaternion<S> turn(1, from(-S(0.1), S(0.1)), from(-S(0.1), S(0.1)), from(-S(0.1), S(0.1)));
        objects[index]->setTransform(turn.normalized() * objects[index]->getQuatRotation(),
                                     objects[index]->getTranslation() + fcl::Vector3<S>(from(-step, step), from(-step, step), from(-step, step)));
        objects[index]->computeAABB();
    }

    S from(S least, S most) { return std::uniform_real_distribution<S>(least, most)(random); }
    std::size_t below(std::size_t limit) { return random() % limit; }

    S side;
    std::vector<fcl::CollisionObject<S> *> objects;

private:
    std::mt19937 random;
    std::vector<std::unique_ptr<fcl::CollisionObject<S>>> owned;
};

#endif
