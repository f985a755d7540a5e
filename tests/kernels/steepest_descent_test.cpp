// SPDX-License-Identifier: MIT
#include "steepest_descent.hpp"

#include <cmath>

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/steepest_descent_oracle.h"

namespace topple::test {
namespace {

class SteepestDescent : public EachBackend {
  protected:
    // A torus of triangles, six neighbours each, padded to whole blocks.
    void check(std::uint32_t width, std::uint32_t height, std::uint32_t candidates, bool coarse) {
        const std::uint32_t size = width * height, padded = (size + 127) / 128 * 128;
        std::vector<std::uint32_t> neighbour(std::size_t{size} * 6),
            planes(std::size_t{padded} * 6);
        const int steps[6][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}};
        for (std::uint32_t v = 0; v < padded; ++v) {
            for (std::uint32_t k = 0; k < 6; ++k) {
                std::uint32_t w = v;
                if (v < size) {
                    const std::uint32_t x =
                        (v % width + width + static_cast<std::uint32_t>(steps[k][0])) % width;
                    const std::uint32_t y =
                        (v / width + height + static_cast<std::uint32_t>(steps[k][1])) % height;
                    w = y * width + x;
                    neighbour[v * 6 + k] = w;
                }
                planes[std::size_t{k} * padded + v] = w;
            }
        }
        Random random(size + candidates);
        std::vector<float> energy = random.floats(std::size_t{padded} * candidates, -1, 1);
        if (coarse) {  // plateaus and ties
            for (float& e : energy) e = std::floor(e * 4) / 4;
        }
        const device::Buffer<float> energy_buffer(*device, energy, "energy");
        const device::Buffer<std::uint32_t> neighbours(*device, planes, "neighbour");
        const Guarded<std::uint32_t> down(*device, energy.size(), "down");
        device::Queue queue(*device);
        queue.add<kernels::SteepestDescent>(
            energy.size(), {.energy = energy_buffer, .neighbour = neighbours, .down = down.slice()},
            {.candidate_count = candidates, .padded_directions = padded});
        queue.run();
        std::vector<std::uint32_t> want;
        for (std::uint32_t n = 0; n < candidates; ++n) {
            const auto from = energy.begin() + static_cast<std::ptrdiff_t>(n) * padded;
            const auto row = oracle::steepest_descent({from, from + size}, neighbour, 6);
            want.insert(want.end(), row.begin(), row.end());
            for (std::uint32_t v = size; v < padded; ++v) want.push_back(v);  // padding
        }
        EXPECT_TRUE(same(down.download(), want));
        EXPECT_TRUE(down.untouched());
    }
};
TOPPLE_ON_EACH_FORM(SteepestDescent);

TEST_P(SteepestDescent, MatchesTheOracle) {
    check(7, 5, 0, false);
    for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
             {1, 1}, {127, 1}, {16, 8}, {43, 3}, {31, 29}}) {
        SCOPED_TRACE(width * height);
        for (const std::uint32_t candidates : {1u, 3u, 17u})
            check(width, height, candidates, candidates == 3);
    }
}

TEST_P(SteepestDescent, ManyDirections) {
    check(251, 97, 5, false);
    check(251, 97, 5, true);
}

}  // namespace
}  // namespace topple::test
