// SPDX-License-Identifier: MIT
// The kernel dialect as C++20. A kernel becomes one function that runs a range of work-groups on the
// calling thread; its lanes are a loop that the compiler vectorises. See kernels/README.md. All of it stands in
// the namespace of the kernels, DIALECT_NAMESPACE, where it hides the standard library's functions of these names.
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "topple/kernels/kernel.h"

#ifdef __FAST_MATH__
#error "kernels give the same bits on all backends, so they can't be compiled with -ffast-math"
#endif

#define TOPPLE_NATIVE 1

namespace DIALECT_NAMESPACE {
using uint = std::uint32_t;
using Bound_ = ::topple::device::NativeArgs;
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

// Names that end in an underscore belong to the dialect: a kernel may call its arrays what it likes.
#define BEGIN                                                                                  \
    FN void lane_(BINDING_PARAMETERS const uint global_id_, const uint local_id_,              \
                  const uint group_id_) {                                                      \
        (void)global_id_, (void)local_id_, (void)group_id_;
#define END                                                                                    \
    }                                                                                          \
    void RUN_NAME(const Bound_& args_, uint first_group_, uint last_group_) {                  \
        LOAD_BINDINGS                                                                          \
        for (uint group_id_ = first_group_; group_id_ < last_group_; ++group_id_) {            \
            EACH_LANE_(local_id_) {                                                            \
                lane_(BINDING_ARGUMENTS group_id_* group_size_ + local_id_, local_id_,         \
                      group_id_);                                                              \
            }                                                                                  \
        }                                                                                      \
    }                                                                                          \
    }

// Kernels with barriers: what stands between LANES and END_LANES runs for every lane of the group,
// then all lanes wait; what stands outside is uniform over the group.
#define BEGIN_GROUP                                                                            \
    void RUN_NAME(const Bound_& args_, uint first_group_, uint last_group_) {                  \
        LOAD_BINDINGS                                                                          \
        for (uint group_id_ = first_group_; group_id_ < last_group_; ++group_id_) {            \
            SHARED_ARRAYS
#define END_GROUP \
    }             \
    }             \
    }
#define LANES                                                        \
    EACH_LANE_(local_id_) {                                          \
        const uint global_id_ = group_id_ * group_size_ + local_id_; \
        (void)global_id_;
#define END_LANES }

// ivdep: no lane reads what another writes between two barriers, so the lanes may be vectorised.
#ifdef TOPPLE_REVERSE_LANES  // finds races between lanes: the result must not depend on their order
#define EACH_LANE_(lane) for (uint down_ = group_size_, lane = down_ - 1; down_ > 0; --down_, --lane)
#else
#define EACH_LANE_(lane) _Pragma("GCC ivdep") for (uint lane = 0; lane < group_size_; ++lane)
#endif

// Runs over the ITEMS of a work-item, none of which touches what another does: in vectors. GCC would unroll
// so short a loop before it looks for vectors, and then find none; and it doesn't see that arrays of the
// work-item's own overlap no buffer.
#define EACH_ITEM(i) _Pragma("GCC unroll 1") _Pragma("GCC ivdep") for (int i = 0; i < ITEMS; i++)

// to[i] = from[base + place[i]], with place[i] from 0 to NEAR_WORDS - 1, all of which can be read: processors
// that choose among two vectors need no gather for that.
#define NEAR_WORDS (2 * ITEMS)
#define LOAD_NEAR(to, from, base, place) \
    ::DIALECT_NAMESPACE::load_near_<ITEMS>(to, (from) + (base), place);

// They go past the caches, where the processor can, and LINES_STORED waits for them.
#define STORE_LINE(to, at, from, base) ::DIALECT_NAMESPACE::store_line_((to) + (at), (from) + (base));
#define LINES_STORED ::DIALECT_NAMESPACE::lines_stored_();

#define GLOBAL_ID global_id_
#define LOCAL_ID local_id_
#define GROUP_ID group_id_

// All atomics return the value from before.
#define ATOMIC_ADD(lvalue, v) std::atomic_ref(lvalue).fetch_add(v, std::memory_order_relaxed)
#define ATOMIC_OR(lvalue, v) std::atomic_ref(lvalue).fetch_or(v, std::memory_order_relaxed)
#define ATOMIC_AND(lvalue, v) std::atomic_ref(lvalue).fetch_and(v, std::memory_order_relaxed)
#define ATOMIC_MIN(lvalue, v) ::DIALECT_NAMESPACE::atomic_min_(lvalue, v)
#define ATOMIC_MAX(lvalue, v) ::DIALECT_NAMESPACE::atomic_max_(lvalue, v)
#define SHARED_ADD(lvalue, v) ::DIALECT_NAMESPACE::shared_add_(lvalue, v)
#define SHARED_OR(lvalue, v) ::DIALECT_NAMESPACE::shared_or_(lvalue, v)
#define SHARED_MIN(lvalue, v) ::DIALECT_NAMESPACE::shared_min_(lvalue, v)
#define SHARED_MAX(lvalue, v) ::DIALECT_NAMESPACE::shared_max_(lvalue, v)

namespace DIALECT_NAMESPACE {
template <class T>
FN T atomic_min_(T& place, std::type_identity_t<T> value) {
    std::atomic_ref<T> a(place);
    T seen = a.load(std::memory_order_relaxed);
    while (value < seen && !a.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
    return seen;
}
template <class T>
FN T atomic_max_(T& place, std::type_identity_t<T> value) {
    std::atomic_ref<T> a(place);
    T seen = a.load(std::memory_order_relaxed);
    while (seen < value && !a.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
    return seen;
}
// Shared memory belongs to one thread here, so its atomics need no lock; volatile, since the lanes'
// loop must not be vectorised over two lanes that meet in one place.
template <class T>
FN T shared_add_(volatile T& place, std::type_identity_t<T> value) {
    const T seen = place;
    place = seen + value;
    return seen;
}
template <class T>
FN T shared_or_(volatile T& place, std::type_identity_t<T> value) {
    const T seen = place;
    place = seen | value;
    return seen;
}
template <class T>
FN T shared_min_(volatile T& place, std::type_identity_t<T> value) {
    const T seen = place;
    place = value < seen ? value : seen;
    return seen;
}
template <class T>
FN T shared_max_(volatile T& place, std::type_identity_t<T> value) {
    const T seen = place;
    place = seen < value ? value : seen;
    return seen;
}
template <int items, class T>
FN void load_near_(T (&to)[items], const T* from, const int (&place)[items]) {
#if defined(__AVX512F__) && !defined(__clang__)  // which has not the builtin, here and below
    if constexpr (items == 16) {
        typedef T Words __attribute__((vector_size(64)));
        typedef int Places __attribute__((vector_size(64)));
        Words low, high;
        Places at;
        std::memcpy(&low, from, 64);
        std::memcpy(&high, from + 16, 64);
        std::memcpy(&at, place, 64);
        low = __builtin_shuffle(low, high, at);
        std::memcpy(to, &low, 64);
        return;
    }
#endif
    for (int i = 0; i < items; i++) to[i] = from[place[i]];
}
FN void store_line_(uint* to, const uint* from) {
#if defined(__AVX512F__) && !defined(__clang__)
    typedef long long Line __attribute__((vector_size(64)));
    Line line;
    std::memcpy(&line, from, sizeof(line));
    __builtin_ia32_movntdq512(reinterpret_cast<Line*>(to), line);
#elif defined(__AVX2__) && !defined(__clang__)
    typedef long long Half __attribute__((vector_size(32)));
    for (int k = 0; k < 16; k += 8) {
        Half half;
        std::memcpy(&half, from + k, sizeof(half));
        __builtin_ia32_movntdq256(reinterpret_cast<Half*>(to + k), half);
    }
#else
    std::memcpy(to, from, 64);
#endif
}
FN void lines_stored_() {
#ifdef __AVX2__
    __builtin_ia32_sfence();
#endif
}
// NaN-free inputs are the kernels' contract. Of two zeros the first is taken, on every backend; both
// operands are evaluated once.
FN float min(float a, float b) { return b < a ? b : a; }
FN float max(float a, float b) { return a < b ? b : a; }
FN int min(int a, int b) { return b < a ? b : a; }
FN int max(int a, int b) { return a < b ? b : a; }
FN uint min(uint a, uint b) { return b < a ? b : a; }
FN uint max(uint a, uint b) { return a < b ? b : a; }
FN float clamp(float v, float lo, float hi) { return min(max(v, lo), hi); }
FN int clamp(int v, int lo, int hi) { return min(max(v, lo), hi); }
FN uint clamp(uint v, uint lo, uint hi) { return min(max(v, lo), hi); }
FN float sqrt(float v) { return __builtin_sqrtf(v); }
FN float floor(float v) { return __builtin_floorf(v); }
FN float abs(float v) { return __builtin_fabsf(v); }
FN int abs(int v) { return v < 0 ? -v : v; }
FN uint float_bits(float v) { return __builtin_bit_cast(uint, v); }
FN float bits_float(uint v) { return __builtin_bit_cast(float, v); }
FN uint mul_high(uint a, uint b) { return static_cast<uint>((std::uint64_t{a} * b) >> 32); }
FN uint bit_count(uint v) { return static_cast<uint>(__builtin_popcount(v)); }
}  // namespace DIALECT_NAMESPACE
