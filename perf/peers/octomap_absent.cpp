// SPDX-License-Identifier: MIT
#include "perf/peers/octomap_carving.h"

// Stands for octomap_carving.cpp where the build found no OctoMap.
namespace topple::perf {

std::optional<PeerMap> octomap_carving(
    const Intrinsics&, std::span<const DepthFrame>, double,
    const std::function<void(std::int32_t, std::int32_t, std::int32_t, bool)>&) {
    return std::nullopt;
}

}  // namespace topple::perf
