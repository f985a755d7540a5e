// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

// What things are numbered by, and tables of what is known of them: one by primitive does not take
// the number of an object.
namespace topple {

// The number of a thing, -1: of none. Integers become one, and it becomes an integer, by
// themselves; but never the number of another kind of things.
template <class Things>
class Id {
  public:
    constexpr Id() = default;
    template <std::integral Number>
    constexpr Id(Number number) : number_(static_cast<std::int32_t>(number)) {}
    constexpr operator std::int32_t() const { return number_; }
    constexpr std::size_t place() const { return static_cast<std::size_t>(number_); }

  private:
    std::int32_t number_ = -1;
};

using PrimitiveId = Id<struct Primitives>;
using ObjectId = Id<struct Objects>;

template <class Other, class Id>
concept OtherThan = !std::same_as<Other, Id>;

// A vector by id.
template <class Id, class T>
class Table : public std::vector<T> {
  public:
    using std::vector<T>::vector;
    Table(std::vector<T> list) : std::vector<T>(std::move(list)) {}
    template <OtherThan<Id> Other>
    Table(const Table<Other, T>&) = delete;
    decltype(auto) operator[](Id id) { return std::vector<T>::operator[](id.place()); }
    decltype(auto) operator[](Id id) const { return std::vector<T>::operator[](id.place()); }
};

// A look at a table that somebody else keeps.
template <class Id, class T>
class TableView : public std::span<const T> {
  public:
    TableView() = default;
    TableView(std::span<const T> list) : std::span<const T>(list) {}
    TableView(const std::vector<T>& list) : std::span<const T>(list) {}
    template <OtherThan<Id> Other>
    TableView(const Table<Other, T>&) = delete;
    const T& operator[](Id id) const { return std::span<const T>::operator[](id.place()); }
};

}  // namespace topple
