// Boxes that fall on a floor among static boxes, in a Bullet world with any broad phase.
#ifndef SCENE_HPP
#define SCENE_HPP

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

class scene {
public:
    // `moving` boxes fall in a block above `fixed` static boxes on a floor.
    scene(btBroadphaseInterface &broadphase, int moving, int fixed) : world(&dispatcher, &broadphase, &solver, &configuration) {
        world.setGravity(btVector3(0, -10, 0));
        int side = 1;
        while (side * side < (fixed > moving / 10 ? fixed : moving / 10)) side++;
        add(floor, 0, btVector3(0, -1, 0));
        for (int i = 0; i < fixed; i++) add(box, 0, btVector3(at(i % side, side), 0.5f, at(i / side, side)));
        for (int i = 0; i < moving; i++) {
            const int x = i % side, z = i / side % side, y = i / side / side;
            // Not in line, so that they topple.
            add(box, 1, btVector3(at(x, side) + 0.3f * float(y % 3), 4 + 1.3f * float(y), at(z, side) + 0.2f * float((x + y) % 4)));
        }
    }
    ~scene() {
        for (const auto &body : bodies) world.removeRigidBody(body.get());
    }
    void step() { world.stepSimulation(1 / 60.f, 0); }

private:
    static float at(int index, int side) { return 1.7f * float(index - side / 2); }

    void add(btCollisionShape &shape, float mass, const btVector3 &position) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
        info.m_startWorldTransform.setIdentity();
        info.m_startWorldTransform.setOrigin(position);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        world.addRigidBody(bodies.back().get());
    }

    btBoxShape floor{btVector3(1000, 1, 1000)}, box{btVector3(0.5f, 0.5f, 0.5f)};
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;

public:
    btDiscreteDynamicsWorld world;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
};

#endif
