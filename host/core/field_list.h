// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <ranges>
#include <tuple>
#include <type_traits>

// How core/result_fields.h says what a result holds. All that writes, reads, checks, hands out or
// describes a result goes through these lists: a field that stands there is in scene.json, in C by
// topple_result_numbers(), and in Python with its stub, its help and its column.
namespace topple {

// What a value must keep to when it is read. "or none" takes -1, too.
enum class Rule : std::uint8_t {
    any,
    own_place,  // the item's number in its list
    primitives,
    primitives_or_none,
    objects,
    objects_or_none,
    corrections,  // from 1 on
    two_or_none,  // of a list
    finite
};

// What a file's null stands for; numbers that are not finite are written as null.
enum class Null : std::uint8_t { nan, infinity, refused };

// What is said of few fields.
struct Note {
    const char* python = nullptr;  // its name there, where that is another
    // Where a file lacks this field, which is then one of an earlier version, this one keeps its
    // default: itself, or the first of those that came with it. Otherwise each file has it.
    const char* since = nullptr;
    const char* one_of = nullptr;  // the words that a text may be, as Python writes them
    Rule rule = Rule::any;
    Null null = Null::nan;
    bool rows = false;        // a row of all heights for each direction
    bool if_any = false;      // written where it is not empty
    bool whole_null = false;  // null as a whole where it is empty, or a vector not finite
    bool or_none = false;     // None in Python where it is empty, or no number
    bool elsewhere = false;   // not in scene.json
};

// One field of an item. `member` points to a member, or is a function of the item. to_c: where C
// has it, members of a struct of topple.h, the second one for how many there are.
template <class Member, class... ToC>
struct Field {
    const char* name;
    Member member;
    const char* words;  // its meaning and unit
    Note note;
    std::tuple<ToC...> to_c;
};

template <class Member, class... ToC>
requires(std::is_member_object_pointer_v<ToC>&&...) constexpr auto field(const char* name,
                                                                         Member member,
                                                                         const char* words,
                                                                         Note note, ToC... to_c) {
    return Field<Member, ToC...>{name, member, words, note, {to_c...}};
}
template <class Member, class... ToC>
requires(std::is_member_object_pointer_v<ToC>&&...) constexpr auto field(const char* name,
                                                                         Member member,
                                                                         const char* words,
                                                                         ToC... to_c) {
    return field(name, member, words, Note{}, to_c...);
}

// All that is said of a kind of item: its name, what it is, and its fields in the order of a file.
// Kinds without a name are rows of numbers.
template <class... Fields>
struct Kind {
    const char* name;
    const char* words;
    std::tuple<Fields...> fields;
};
template <class... Fields>
constexpr auto described(const char* name, const char* words, Fields... fields) {
    return Kind<Fields...>{name, words, {fields...}};
}

template <class Item>
inline constexpr auto kind = nullptr;  // of what has no list
// What Python has under one more name, for what is asked for most: fields that are functions.
template <class Item>
inline constexpr auto shortcuts = std::tuple{};
template <class Item>
concept Listed = !std::is_null_pointer_v<std::remove_cv_t<decltype(kind<Item>)>>;

// visit(field) for each field of the kind.
template <Listed Item, class Visit>
void fields(const Visit& visit) {
    std::apply([&](const auto&... each) { (visit(each), ...); }, kind<Item>.fields);
}
// visit(field, value) for each field of an item.
template <Listed Item, class Visit>
void fields(const Item& item, const Visit& visit) {
    fields<Item>([&](const auto& field) { visit(field, std::invoke(field.member, item)); });
}

template <class T, template <class...> class Of>
inline constexpr bool is_a = false;
template <template <class...> class Of, class... Ts>
inline constexpr bool is_a<Of<Ts...>, Of> = true;

template <class T>
inline constexpr std::size_t array_size = 0;
template <class T, std::size_t count>
inline constexpr std::size_t array_size<std::array<T, count>> = count;

// Numbers, and lists of them.
template <class T>
inline constexpr bool of_numbers = std::is_arithmetic_v<T> && !std::is_same_v<T, char>;
template <std::ranges::range T>
inline constexpr bool of_numbers<T> = of_numbers<std::ranges::range_value_t<T>>;

// Whether there is nothing to say: an empty text or list, a number that is none.
template <class T>
bool is_none(const T& value) {
    if constexpr (std::is_floating_point_v<T>)
        return std::isnan(value);
    else if constexpr (array_size<T> == 3)
        return !std::isfinite(value[0]);
    else if constexpr (requires(T list) { list.clear(); })
        return value.empty();
    else
        return false;
}

}  // namespace topple
