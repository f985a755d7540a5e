// SPDX-License-Identifier: MIT
#include "points/limited_fusion.h"

#include "io/text.h"
#include "points/budget.h"
#include "points/parse_memory.h"
#include "topple/error.h"

namespace topple {

LimitedFusion::LimitedFusion(const Frames& frames, double cell_m, const ParseOptions& options,
                             unsigned threads)
    : frames_(frames), options_(options), fusion_(frames.intrinsics, cell_m, threads) {
    if (memory_bound(options) == UINT64_MAX) return;
    const auto pixels =
        static_cast<double>(frames.count) * frames.intrinsics.width * frames.intrinsics.height;
    const auto beside = static_cast<std::uint64_t>(fusion_beside(pixels));
    check_memory(
        frames.source + ": to fuse " + io::counted(frames.count, "depth frame") + " takes at least",
        beside, options, "give points in their place");
    most_bytes_ = memory_bound(options) - beside;
    fusion_.set_most_bytes(most_bytes_);
}

void LimitedFusion::add(const DepthFrame& frame) {
    fusion_.add(frame);
    ++added_;
    check();
}

geometry::FusedCloud LimitedFusion::finish(const std::function<void()>& poll) {
    fusion_.flush();
    check();
    return fusion_.finish(poll);
}

void LimitedFusion::check() const {
    if (fusion_.bytes() <= most_bytes_) return;
    const std::string frames = added_ < frames_.count
                                   ? "the first " + std::to_string(added_) + " of " +
                                         io::counted(frames_.count, "depth frame")
                                   : io::counted(frames_.count, "depth frame");
    throw Error(ErrorKind::input,
                frames_.source + ": the surfaces of " + frames + " take more than the " +
                    memory_bound_text(options_) + "; allow more, or give fewer frames; " +
                    depth_scale_hint(frames_.count, frames_.intrinsics.depth_scale,
                                     frames_.typical_depth_m, frames_.origin));
}

}  // namespace topple
