// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "topple/device.h"
#include "topple/error.h"
#include "topple/parse.h"
#include "topple/topple.h"

// What the parts of the C interface share.
struct topple_device {
    std::shared_ptr<topple::device::Device> device;
};

namespace topple::c_api {

// The caller's allocator gave nothing.
struct OutOfMemory {
    std::size_t bytes;
};

int set(topple_status* status, int code, std::string_view message) noexcept;
int set(topple_status* status, const Error& error) noexcept;

// Runs `body`, and makes a code and a message of what it throws.
template <class Body>
int guarded(topple_status* status, const Body& body) noexcept {
    try {
        body();
        return set(status, TOPPLE_OK, {});
    } catch (const OutOfMemory& e) {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "the allocator gave no %zu bytes", e.bytes);
        return set(status, TOPPLE_ERROR_MEMORY, text.data());
    } catch (const Error& e) {
        return set(status, e);
    } catch (const std::bad_alloc&) {
        return set(status, TOPPLE_ERROR_MEMORY, "memory ran out");
    } catch (const std::exception& e) {
        return set(status, TOPPLE_ERROR_INTERNAL, e.what());
    } catch (...) {
        return set(status, TOPPLE_ERROR_INTERNAL, "an exception of no known kind");
    }
}

// Throws Error(usage) naming the argument that is null.
template <class T>
T& needed(T* argument, const char* name) {
    if (!argument) throw Error(ErrorKind::usage, std::string(name) + " is NULL");
    return *argument;
}
// Of an array of so many: more than that is nowhere in memory, and would overflow what is reckoned
// with it.
template <class T>
T* array(T* argument, const char* name, std::uint64_t count) {
    constexpr std::uint64_t most = (std::uint64_t{1} << 47) / sizeof(T);
    if (!argument && count > 0) throw Error(ErrorKind::usage, std::string(name) + " is NULL");
    if (count > most)
        throw Error(ErrorKind::usage, std::string(name) + ": " + std::to_string(count) +
                                          " of them are more than fit into memory");
    return argument;
}
// Of rows of `each`.
template <class T>
T* array(T* argument, const char* name, std::uint64_t rows, std::uint64_t each) {
    constexpr std::uint64_t all = ~std::uint64_t{0};
    return array(argument, name, each > 0 && rows > all / each ? all : rows * each);
}

// Throws Error(usage) where there are not so many.
template <class Item>
const Item& item(const std::vector<Item>& items, std::uint64_t index, const char* what) {
    if (index >= items.size()) {
        throw Error(ErrorKind::usage, std::string(what) + " " + std::to_string(index) +
                                          ": there are " + std::to_string(items.size()));
    }
    return items[index];
}

// Of any version of a struct, sizeof is a multiple of its alignment: another size would cut a
// pointer in two.
template <class Struct>
void check_size(std::size_t size, const char* name) {
    if (size < sizeof(std::size_t) || size % alignof(Struct) != 0)
        throw Error(ErrorKind::usage, std::string(name) + ": size is " + std::to_string(size) +
                                          "; set it to sizeof of the struct");
}

// Sets a caller's struct of that size to defaults, and to zeros beyond what this library knows.
template <class Struct>
void begin(Struct* given, std::size_t size, const Struct& defaults = {}) {
    if (!given || size < sizeof(std::size_t)) return;
    std::memset(given, 0, size);
    std::memcpy(given, &defaults, std::min(size, sizeof(defaults)));
    given->size = size;
}

// The struct as this library knows it: the caller's part of it, and `defaults` beyond.
template <class Struct>
Struct known(const Struct* given, const Struct& defaults, const char* name) {
    Struct out = defaults;
    if (!given) return out;
    check_size<Struct>(given->size, name);
    std::memcpy(&out, given, std::min(given->size, sizeof(Struct)));
    out.size = sizeof(Struct);
    return out;
}

// Writes the caller's part of the struct, whose size stays.
template <class Struct>
void give(const Struct& from, Struct* to, const char* name) {
    needed(to, name);
    const std::size_t size = to->size;
    check_size<Struct>(size, name);
    std::memcpy(to, &from, std::min(size, sizeof(Struct)));
    to->size = size;
}

// Throws Error(usage) for a cloud without points to read.
CloudView view_of(const topple_cloud* cloud);
// Throws Error(usage) for frames without images to read.
FramesView frames_of(const topple_frames* frames);
Intrinsics intrinsics_of(const topple_intrinsics& from);
topple_options default_options();
// Its callbacks must not outlive `o`.
ParseOptions parse_options(const topple_options& o);

}  // namespace topple::c_api
