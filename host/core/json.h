// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// JSON whose end needs no memory. nlohmann's destructor puts what a value holds on a stack that it
// allocates; where there is no memory for that it would end the program. Here that stack, and with
// it every array of values, is taken from a reserve then. Begin with Json::object() what is to be
// one: a null value that becomes one says so before it has the memory, and its end uses that.
namespace topple {

template <class T, class = void>
struct JsonSerializer : nlohmann::adl_serializer<T> {};

template <template <class, class, class...> class Map>
using BasicJson = nlohmann::basic_json<Map, std::vector, std::string, bool, std::int64_t,
                                       std::uint64_t, double, std::allocator, JsonSerializer>;
using Json = BasicJson<std::map>;
using OrderedJson = BasicJson<nlohmann::ordered_map>;  // objects keep the order they are made in

// What the system gives, else a part of the reserve; throws std::bad_alloc where that is used up.
void* allocate_json(std::size_t bytes);
void release_json(void* memory) noexcept;

template <class Value>
struct JsonAllocator {
    using value_type = Value;
    using size_type = std::size_t;
    using difference_type = std::ptrdiff_t;
    using propagate_on_container_move_assignment = std::true_type;
    using is_always_equal = std::true_type;

    Value* allocate(std::size_t count) {
        if (count > PTRDIFF_MAX / sizeof(Value)) throw std::bad_array_new_length();
        return static_cast<Value*>(allocate_json(count * sizeof(Value)));
    }
    void deallocate(Value* memory, std::size_t) noexcept { release_json(memory); }
    bool operator==(const JsonAllocator&) const = default;
};

}  // namespace topple

// The destructor's stack has the standard's allocator, whatever the values' is.
template <template <class, class, class...> class Map>
class std::allocator<topple::BasicJson<Map>>
    : public topple::JsonAllocator<topple::BasicJson<Map>> {
  public:
    allocator() = default;
    template <class Other>
    allocator(const std::allocator<Other>&) noexcept {}
    bool operator==(const allocator&) const = default;
};
