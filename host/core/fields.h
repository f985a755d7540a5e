// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

// Values as fields in a row, in this machine's byte order. Writers and readers take the same calls,
// so that one function lists a type's fields for both ways. After a value come the rules that it
// keeps to (core/field_rules.h): a reader refuses what breaks one, whatever checksum it has.
namespace topple {

template <class T>
concept Plain =
    std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool> && !std::is_pointer_v<T>;

// A Sink is one of these, and has put(const void*, std::size_t).
template <class Sink>
class FieldWriter {
  public:
    static constexpr bool writes = true;

    template <Plain T>
    void operator()(const T& value) {
        put(&value, sizeof(value));
    }
    void operator()(bool value) { (*this)(static_cast<std::uint8_t>(value)); }
    void operator()(const std::string& text) {
        (*this)(static_cast<std::uint64_t>(text.size()));
        put(text.data(), text.size());
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        if constexpr (Plain<T>) {
            put(values.data(), values.size() * sizeof(T));
        } else {
            for (const T& value : values) (*this)(value);
        }
    }
    template <class T, class Rule, class... Rules>
    void operator()(const T& value, const Rule&, const Rules&...) {
        (*this)(value);
    }
    void expect(bool) {}

  private:
    void put(const void* data, std::size_t size) { static_cast<Sink&>(*this).put(data, size); }
};

// A Source is one of these, and has take(count, each), which returns so many bytes or refuses what
// holds no more; left(), how many there are; [[noreturn]] refuse(), of what no writer wrote; and
// taken(), which hears that all so far was copied.
template <class Source>
class FieldReader {
  public:
    static constexpr bool writes = false;

    template <Plain T>
    void operator()(T& value) {
        std::memcpy(&value, source().take(1, sizeof(value)), sizeof(value));
    }
    void operator()(bool& value) {
        std::uint8_t byte = 0;
        (*this)(byte);
        expect(byte <= 1);
        value = byte != 0;
    }
    void operator()(std::string& text) {
        const std::uint64_t size = count();
        text.assign(reinterpret_cast<const char*>(source().take(size, 1)), size);
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        const std::uint64_t size = count();
        values.clear();
        if constexpr (Plain<T>) {
            const std::byte* from = source().take(size, sizeof(T));
            values.resize(size);
            if (size > 0) std::memcpy(values.data(), from, size * sizeof(T));
            source().taken();
        } else {
            for (std::uint64_t n = 0; n < size; ++n) {
                T value{};
                (*this)(value);
                values.push_back(std::move(value));
            }
        }
    }
    template <class T, class Rule, class... Rules>
    void operator()(T& value, const Rule& rule, const Rules&... rules) {
        (*this)(value);
        expect(rule(value) && (rules(value) && ...));
    }
    // For rules about several values.
    void expect(bool holds) {
        if (!holds) source().refuse();
    }
    // The next value by itself.
    template <class T>
    T value() {
        T out{};
        (*this)(out);
        return out;
    }
    // How many fields follow: each takes a byte at least.
    std::uint64_t count() {
        const auto size = value<std::uint64_t>();
        expect(size <= source().left());
        return size;
    }

  private:
    Source& source() { return static_cast<Source&>(*this); }
};

// A list of what is no plain value: fields(io, item) lists those of one.
template <class Io, class List, class Fields>
void list_fields(Io& io, List& list, const Fields& fields) {
    if constexpr (Io::writes) {
        io(static_cast<std::uint64_t>(list.size()));
        for (const auto& item : list) fields(io, item);
    } else {
        const std::uint64_t count = io.count();
        list.clear();
        for (std::uint64_t n = 0; n < count; ++n) fields(io, list.emplace_back());
    }
}

// A map, by ascending key: fields(io, value) lists those of one.
template <class Io, class Map, class Fields>
void map_fields(Io& io, Map& map, const Fields& fields) {
    if constexpr (Io::writes) {
        io(static_cast<std::uint64_t>(map.size()));
        for (const auto& [key, value] : map) {
            io(key);
            fields(io, value);
        }
    } else {
        const std::uint64_t count = io.count();
        map.clear();
        for (std::uint64_t n = 0; n < count; ++n) {
            const auto key = io.template value<typename Map::key_type>();
            io.expect(map.empty() || key > map.rbegin()->first);
            fields(io, map[key]);
        }
    }
}

}  // namespace topple
