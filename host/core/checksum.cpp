// SPDX-License-Identifier: MIT
#include "core/checksum.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace topple {
namespace {

Checksum::Value as_value(const XXH128_hash_t& hash) {
    return {hash.low64, hash.high64};
}

}  // namespace

struct Checksum::State {
    XXH3_state_t state;
};

Checksum::Checksum() : state_(std::make_unique<State>()) {
    XXH3_128bits_reset(&state_->state);
}
Checksum::~Checksum() = default;

void Checksum::add(const void* bytes, std::size_t count) {
    if (count > 0) XXH3_128bits_update(&state_->state, bytes, count);
}

Checksum::Value Checksum::value() const {
    return as_value(XXH3_128bits_digest(&state_->state));
}

Checksum::Value Checksum::of(const void* bytes, std::size_t count) {
    return as_value(XXH3_128bits(bytes, count));
}

}  // namespace topple
