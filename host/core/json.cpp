// SPDX-License-Identifier: MIT
#include "core/json.h"

#include <functional>
#include <mutex>

namespace topple {
namespace {

// Sixty thousand values. Parts are handed out one after the other, until all are back.
constexpr std::size_t reserve_bytes = 1 << 20, alignment = alignof(std::max_align_t);
alignas(std::max_align_t) std::byte reserve[reserve_bytes];
std::mutex mutex;  // of the two below
std::size_t used = 0, parts = 0;

bool is_reserve(const void* memory) {
    const auto* at = static_cast<const std::byte*>(memory);
    return !std::less<>()(at, reserve) && std::less<>()(at, reserve + reserve_bytes);
}

}  // namespace

void* allocate_json(std::size_t bytes) {
    if (void* memory = ::operator new(bytes, std::nothrow)) return memory;
    bytes = (bytes + alignment - 1) / alignment * alignment;
    const std::lock_guard lock(mutex);
    if (bytes > reserve_bytes - used) throw std::bad_alloc();
    void* memory = reserve + used;
    used += bytes;
    ++parts;
    return memory;
}

void release_json(void* memory) noexcept {
    if (!is_reserve(memory)) {
        ::operator delete(memory);
        return;
    }
    const std::lock_guard lock(mutex);
    if (--parts == 0) used = 0;
}

}  // namespace topple
