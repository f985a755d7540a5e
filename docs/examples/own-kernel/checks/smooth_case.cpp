#include <memory>

#include "smooth.hpp"
#include "topple/kernel_testing/case.h"

// A million heights, each of which is read once from memory.
topple::perf::Prepared smooth_case(topple::device::Device& device) {
    constexpr std::uint32_t count = 1u << 20;
    std::vector<float> heights(count), weights(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        heights[i] = static_cast<float>(i % 1000u) * 0.01f;
        weights[i] = 1.0f + static_cast<float>(i % 7u);
    }
    struct Buffers {
        topple::device::Buffer<float> height, weight, smoothed;
    };
    using topple::perf::upload;
    auto on = std::make_shared<Buffers>(Buffers{upload(device, heights, "height"),
                                                upload(device, weights, "weight"),
                                                {device, count, "smoothed"}});
    return {{.items = count,
             .unit = "heights",
             .bytes = 12.0 * count,
             .operations = 8.0 * count,
             .divisions = count},
            [on](topple::device::Queue& queue) {
                queue.add<my_app::Smooth>(
                    count, {.height = on->height, .weight = on->weight, .smoothed = on->smoothed},
                    {.count = count});
            },
            {},
            [on] { return topple::perf::Hash().add(on->smoothed.download()).value(); }};
}
