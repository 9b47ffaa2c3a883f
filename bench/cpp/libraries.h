// What the libraries in C++ get and give. Each library is one function
//     extern "C" void bench_NAME(const Boxes *boxes, Pairs *pairs);
// that appends to `pairs`, which is empty.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

// `count` rows of 2 * `dimensions` floats, the minimum corner and then the maximum corner.
struct Boxes {
    const float *rows;
    std::size_t count;
    std::size_t dimensions;

    // A coordinate of a box; 0 on the axes that the boxes do not have.
    float min(std::size_t box, std::size_t axis) const {
        return axis < dimensions ? rows[2 * dimensions * box + axis] : 0.0f;
    }
    float max(std::size_t box, std::size_t axis) const {
        return axis < dimensions ? rows[2 * dimensions * box + dimensions + axis] : 0.0f;
    }

    bool overlap(std::size_t a, std::size_t b) const {
        for (std::size_t axis = 0; axis < dimensions; ++axis) {
            if (min(a, axis) > max(b, axis) || min(b, axis) > max(a, axis)) return false;
        }
        return true;
    }
};
