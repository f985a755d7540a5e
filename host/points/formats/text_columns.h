// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace topple::io {

// Without the white space at both ends.
inline std::string_view trimmed(std::string_view text) {
    constexpr std::string_view white = " \t\r\v\f";
    const auto first = text.find_first_not_of(white);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(white) - first + 1);
}

// How a text with a point a line is written: what stands between its numbers, and what its commas
// mean. Both are decided once, by its first lines:
//   - Where each of them has semicolons, these alone separate, and where each has commas that
//     separate, these alone do: then each field has its place, be it empty, and may stand in double
//     quotes. Else white space separates, and so do commas and semicolons, if there are any.
//   - Where other things separate fields with a comma each, as in "1,5;2,5;3,5" and "1,5 2,5 3,5",
//     commas are those of decimals, and points those of thousands ("1.234,5"). In "1,234.5;2;3" it
//     is the other way round.
class TextColumns {
  public:
    // Columns beyond these are not looked at.
    static constexpr std::size_t most_columns = 256;
    using Fields = std::array<std::string_view, most_columns>;

    explicit TextColumns(std::string_view text);

    // The fields of a line, without comments and quotes; returns how many.
    std::size_t split(std::string_view line, Fields& fields) const;
    // False where it is no number as this text writes them.
    bool number(std::string_view field, double& value) const;
    // Whether a line's fields keep their places where some of them are empty.
    bool keeps_places() const { return separator_ != 0; }
    // The line of the first of whole numbers between commas that seem to be halves of others, as
    // "1,05,2,75,3,1" has them; 0: none.
    std::uint64_t halves_line() const { return halves_line_; }
    // What else is to be said of a field that is no number; begins with a comma, or is empty.
    const char* rule() const;

  private:
    enum class Commas : std::uint8_t { none, separate, decimal, thousands };

    char separator_ = 0;  // 0: white space, and commas and semicolons as commas_ says
    Commas commas_ = Commas::none;
    std::uint64_t halves_line_ = 0;
};

}  // namespace topple::io
