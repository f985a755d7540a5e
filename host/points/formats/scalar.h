// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

// The number types that point cloud files store.
namespace topple::io {

enum class Scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

inline std::size_t bytes_of(Scalar type) {
    constexpr std::array<std::size_t, 10> bytes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return bytes[static_cast<std::size_t>(type)];
}

template <class T>
T load_as(const char* from, bool swapped) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), from, sizeof(T));
    if (swapped) std::ranges::reverse(bytes);
    return std::bit_cast<T>(bytes);
}

// Whether all of them lie within; `at` may be any number that a file states.
inline bool lies_in(std::string_view bytes, std::uint64_t at, std::uint64_t count) {
    return at <= bytes.size() && count <= bytes.size() - at;
}

// The little-endian number there; 0 where it does not lie within.
template <class T>
T value_at(std::string_view bytes, std::uint64_t at) {
    return lies_in(bytes, at, sizeof(T))
               ? load_as<T>(bytes.data() + at, std::endian::native == std::endian::big)
               : T{};
}

// The number at `from`, which need not be aligned; `swapped` where its byte order is not the
// host's.
inline double load_scalar(Scalar type, const char* from, bool swapped) {
    switch (type) {
        case Scalar::i8:
            return load_as<std::int8_t>(from, swapped);
        case Scalar::u8:
            return load_as<std::uint8_t>(from, swapped);
        case Scalar::i16:
            return load_as<std::int16_t>(from, swapped);
        case Scalar::u16:
            return load_as<std::uint16_t>(from, swapped);
        case Scalar::i32:
            return load_as<std::int32_t>(from, swapped);
        case Scalar::u32:
            return load_as<std::uint32_t>(from, swapped);
        case Scalar::i64:
            return static_cast<double>(load_as<std::int64_t>(from, swapped));
        case Scalar::u64:
            return static_cast<double>(load_as<std::uint64_t>(from, swapped));
        case Scalar::f32:
            return load_as<float>(from, swapped);
        case Scalar::f64:
            return load_as<double>(from, swapped);
    }
    return 0;
}

// Whether data of the given byte order must be swapped on this host.
inline bool must_swap(bool big_endian) {
    return big_endian != (std::endian::native == std::endian::big);
}

}  // namespace topple::io
