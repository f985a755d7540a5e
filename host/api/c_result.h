// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "topple/parse.h"
#include "topple/topple.h"

namespace topple::c_api {

// The arrays that a result hands out: where the library has them, or copied to memory of the
// caller's allocator.
class Arrays {
  public:
    explicit Arrays(const topple_allocator* allocator);
    ~Arrays();
    Arrays(const Arrays&) = delete;
    Arrays& operator=(const Arrays&) = delete;

    // Throws OutOfMemory, and std::bad_alloc.
    template <class T>
    const T* hand(const std::vector<T>& from) {
        if (from.empty()) return nullptr;
        if (!allocator_) return from.data();
        return static_cast<const T*>(copy(from.data(), from.size() * sizeof(T), alignof(T)));
    }
    // Three numbers each.
    const double* hand(const std::vector<Vec3>& from) {
        const Vec3* const first = hand<Vec3>(from);
        return first ? first->data() : nullptr;
    }

  private:
    struct Block {
        void* memory;
        std::size_t bytes;
    };
    const void* copy(const void* from, std::size_t bytes, std::size_t alignment);
    std::optional<topple_allocator> allocator_;
    std::vector<Block> blocks_;
};

}  // namespace topple::c_api

struct topple_result {
    topple_result(topple::ParseResult parsed, const topple_allocator* allocator);

    topple::ParseResult result;
    topple::c_api::Arrays arrays;
    // As C has them; their arrays are those of the above.
    topple_scene scene{};
    std::vector<topple_primitive> primitives;
    std::vector<topple_object> objects;
    std::vector<topple_contact> contacts;
    std::vector<topple_support> supports;
    std::vector<topple_correction> corrections;
    const std::int32_t *primitive = nullptr, *object = nullptr;  // by point
    const float* normal[3] = {nullptr, nullptr, nullptr};
    const std::uint64_t* index = nullptr;
};
