#include <cstdio>

#include "smooth.hpp"
#include "topple/kernels/queue.h"

// my_app [FORM]: smooths a step of heights, on native, opencl, vulkan or vulkan_as_gpu.
int main(int argc, char** argv) try {
    using topple::device::Buffer;
    const auto device = topple::device::open_form(argc > 1 ? argv[1] : "native");
    std::vector<float> heights, weights;
    for (int i = 0; i < 100; ++i) {
        heights.push_back(i < 50 ? 0.1f : 0.7f);
        weights.push_back(1.0f + static_cast<float>(i % 7));
    }
    const Buffer<float> height(*device, heights, "height"), weight(*device, weights, "weight");
    const Buffer<float> smoothed(*device, heights.size(), "smoothed");
    topple::device::Queue queue(*device);
    queue.add<my_app::Smooth>(heights.size(),
                              {.height = height, .weight = weight, .smoothed = smoothed},
                              {.count = static_cast<std::uint32_t>(heights.size())});
    queue.run();
    for (const float value : smoothed.download()) std::printf("%a\n", double{value});
} catch (const topple::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
