// SPDX-License-Identifier: MIT
#include "perf/peers/primitive_peers.h"

namespace topple::perf {

std::optional<PrimitivePeers> boost_compute_primitives(const PrimitiveInput&, unsigned) {
    return std::nullopt;
}

}  // namespace topple::perf
