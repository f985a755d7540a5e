// SPDX-License-Identifier: MIT
// The kernel dialect as C++20. A kernel becomes one function that runs a range of work-groups on the
// calling thread; its lanes are a loop that the compiler vectorises. See kernels/README.md.
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "device/kernel.h"

#define TOPPLE_NATIVE 1

namespace topple::kernels {
using uint = std::uint32_t;
}

#define STRUCT(T) struct T
#define STRUCT_END(T) ;
#define FN static inline __attribute__((always_inline))
#define CONST_ARRAY(T, n, c) static constexpr T n[c]

// KERNEL opens a namespace of the kernel's own; the generated file supplies LOAD_BINDINGS, which
// turns NativeArgs into the typed, non-aliasing pointers that the body names.
#define KERNEL(name, wg)                   \
    namespace name##_scope {               \
        constexpr uint group_size_ = (wg);
#define BUFFER_IN(i, T, n)
#define BUFFER_OUT(i, T, n)
#define BUFFER_INOUT(i, T, n)
#define PARAMS(T, n)
#define SHARED(T, n, count)

#define BEGIN                                                                                       \
    FN void lane_(BINDING_PARAMETERS const uint global_id_, const uint local_id_,                   \
                  const uint group_id_) {                                                           \
        (void)global_id_, (void)local_id_, (void)group_id_;
#define END                                                                                         \
    }                                                                                               \
    void RUN_NAME(const device::NativeArgs& args, uint first, uint last) {                               \
        LOAD_BINDINGS                                                                               \
        for (uint group = first; group < last; ++group) {                                           \
            _Pragma("GCC ivdep") for (uint lane = 0; lane < group_size_; ++lane) {                  \
                lane_(BINDING_ARGUMENTS group * group_size_ + lane, lane, group);                   \
            }                                                                                       \
        }                                                                                           \
    }                                                                                               \
    }

// Kernels with barriers: what stands between LANES and END_LANES runs for every lane of the group,
// then all lanes wait; what stands outside is uniform over the group.
#define BEGIN_GROUP                                                                                 \
    void RUN_NAME(const device::NativeArgs& args, uint first, uint last) {                               \
        LOAD_BINDINGS                                                                               \
        for (uint group_id_ = first; group_id_ < last; ++group_id_) {                               \
            SHARED_ARRAYS
#define END_GROUP \
    }             \
    }             \
    }
#ifdef TOPPLE_REVERSE_LANES  // finds races between lanes: the result must not depend on their order
#define LANES                                                                      \
    for (uint down_ = group_size_; down_ > 0; --down_) {                           \
        const uint local_id_ = down_ - 1, global_id_ = group_id_ * group_size_ + local_id_; \
        (void)global_id_;
#else
#define LANES                                                                      \
    _Pragma("GCC ivdep") for (uint local_id_ = 0; local_id_ < group_size_; ++local_id_) { \
        const uint global_id_ = group_id_ * group_size_ + local_id_;               \
        (void)global_id_;
#endif
#define END_LANES }

#define GLOBAL_ID global_id_
#define LOCAL_ID local_id_
#define GROUP_ID group_id_

#define ATOMIC_ADD(lvalue, v) std::atomic_ref(lvalue).fetch_add(v, std::memory_order_relaxed)
#define ATOMIC_MIN(lvalue, v) ::topple::kernels::atomic_min_(lvalue, v)
#define ATOMIC_OR(lvalue, v) std::atomic_ref(lvalue).fetch_or(v, std::memory_order_relaxed)
// Shared memory belongs to one thread here, so its atomics are plain.
#define SHARED_ADD(lvalue, v) ((lvalue) += (v))
#define SHARED_OR(lvalue, v) ((lvalue) |= (v))

namespace topple::kernels {
FN uint atomic_min_(uint& place, uint value) {
    std::atomic_ref<uint> a(place);
    uint seen = a.load(std::memory_order_relaxed);
    while (value < seen && !a.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
    return seen;
}
// NaN-free inputs are the kernels' contract; both operands are evaluated once.
FN float min(float a, float b) { return b < a ? b : a; }
FN float max(float a, float b) { return a < b ? b : a; }
FN int min(int a, int b) { return b < a ? b : a; }
FN int max(int a, int b) { return a < b ? b : a; }
FN uint min(uint a, uint b) { return b < a ? b : a; }
FN uint max(uint a, uint b) { return a < b ? b : a; }
FN float clamp(float v, float lo, float hi) { return min(max(v, lo), hi); }
FN float sqrt(float v) { return __builtin_sqrtf(v); }
FN float floor(float v) { return __builtin_floorf(v); }
FN float abs(float v) { return __builtin_fabsf(v); }
FN int abs(int v) { return v < 0 ? -v : v; }
FN uint float_bits(float v) { return __builtin_bit_cast(uint, v); }
FN float bits_float(uint v) { return __builtin_bit_cast(float, v); }
}  // namespace topple::kernels
