// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "points/formats/scalar.h"

// What readers and checks of PLY files share.
namespace topple::io {

enum class PlyEncoding : std::uint8_t { ascii, little, big };

struct PlyProperty {
    std::string name;
    Scalar type = Scalar::f32;
    std::optional<Scalar> list_count;  // the type of a list's length, where this is a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    bool has_lists() const {
        for (const auto& property : properties) {
            if (property.list_count) return true;
        }
        return false;
    }
    // Bytes of one item where all its lists are empty.
    std::uint64_t least_bytes() const {
        std::uint64_t bytes = 0;
        for (const auto& property : properties)
            bytes += bytes_of(property.list_count.value_or(property.type));
        return bytes;
    }
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_offset = 0;
    std::uint64_t lines = 0;  // of the header
};

// Throws Error(input) where the header can't be understood.
PlyHeader parse_ply_header(const std::filesystem::path& file, std::string_view bytes);

// Throws Error(input): the items of an element take more bytes than the file has left.
[[noreturn]] void ply_cut_short(const std::filesystem::path& file, const PlyElement& element,
                                std::uint64_t needed, std::uint64_t found);

// Steps over the items of a binary file. Throws Error(input) where they reach beyond its end.
class PlyItems {
  public:
    PlyItems(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header)
        : file_(file),
          at_(bytes.data() + header.data_offset),
          end_(bytes.data() + bytes.size()),
          swapped_(must_swap(header.encoding == PlyEncoding::big)) {}

    // That its items fit at all, all of their lists being empty.
    void expect(const PlyElement& element) const;
    void step_over_all(const PlyElement& element);
    // Moves behind item `index` of the element; writes where its properties start, unless null.
    void step_over(const PlyElement& element, std::uint64_t index, const char** starts);
    // Whether the file's byte order is not the machine's.
    bool swapped() const { return swapped_; }

  private:
    std::uint64_t left() const { return static_cast<std::uint64_t>(end_ - at_); }
    void take(const PlyElement& element, std::uint64_t index, std::uint64_t bytes);

    const std::filesystem::path& file_;
    const char* at_;
    const char* end_;
    bool swapped_;
};

// Walks over all that the header promises, faces too. Throws Error(input) where counts or lengths
// of lists contradict the file, where a value is no number of its type, or is of a type with 64
// bits: what a library would take on trust.
void check_ply(const std::filesystem::path& file, std::string_view bytes);

}  // namespace topple::io
