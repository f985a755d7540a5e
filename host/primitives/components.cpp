// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/components.h"

#include "component_flatten.hpp"
#include "component_init.hpp"
#include "component_link.hpp"

namespace topple::primitives {

void connected_components(device::Queue& queue, Scratch& scratch, const Words& from,
                          const Words& to, const Words& components) {
    check_size(to, size(from), "the ends of edges");
    const device::DeviceInfo& info = queue.device().info();
    if (components.range.bytes > info.limits.max_binding_bytes)
        throw Error(ErrorKind::device, "connected components: " + std::to_string(size(components)) +
                                           " nodes are more than the " +
                                           std::to_string(info.limits.max_binding_bytes / 4) +
                                           " that " + info.name +
                                           " can bind; use the native backend");
    const auto nodes = static_cast<std::uint32_t>(size(components));
    const auto parent = scratch.take(nodes);
    queue.add<kernels::ComponentInit>(nodes, {.parent = parent}, {.nodes = nodes, .edges = 0});
    for (const Tile& tile : tiles(queue.device(), size(from)))
        queue.add<kernels::ComponentLink>(tile.count,
                                          {.from = part(from, tile.first, tile.count),
                                           .to = part(to, tile.first, tile.count),
                                           .parent = parent},
                                          {.nodes = nodes, .edges = tile.count});
    queue.add<kernels::ComponentFlatten>(nodes, {.parent = parent, .component = components},
                                         {.nodes = nodes, .edges = 0});
}

}  // namespace topple::primitives
