// SPDX-License-Identifier: MIT
#include "points/formats/text_columns.h"

#include <algorithm>
#include <string>
#include <vector>

#include "io/text.h"

namespace topple::io {
namespace {

// Lines with something in them that decide on all others.
constexpr std::size_t most_lines = 200;

std::string_view without_comment(std::string_view line) {
    line = line.substr(0, line.find('#'));
    return line.substr(0, line.find("//"));
}

// The field up to the next separator outside of quotes; `more`: whether another follows.
std::string_view next_field(std::string_view& line, char separator, bool& more) {
    const auto start = line.find_first_not_of(" \t");
    std::size_t from = 0;
    if (start != std::string_view::npos && line[start] == '"')
        from = std::min(line.find('"', start + 1), line.size());
    const auto end = line.find(separator, from);
    std::string_view field = trimmed(line.substr(0, end));
    more = end != std::string_view::npos;
    line.remove_prefix(more ? end + 1 : line.size());
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
        field = trimmed(field.substr(1, field.size() - 2));
    return field;
}

// The field up to the next white space, without a comma that ends it, as in "1,5, 2,5, 3,5".
std::string_view next_word(std::string_view& line) {
    std::string_view word = next_token(line);
    if (word.ends_with(',')) word.remove_suffix(1);
    return word;
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool are_digits(std::string_view text) {
    return std::ranges::all_of(text, is_digit);
}

std::string_view without_sign(std::string_view field) {
    if (!field.empty() && (field.front() == '-' || field.front() == '+')) field.remove_prefix(1);
    return field;
}

bool starts_as_number(std::string_view field) {
    field = without_sign(field);
    return !field.empty() &&
           (is_digit(field.front()) || field.front() == '.' || field.front() == ',');
}

// "1.234.567" of '.': groups of three digits, but for the first.
bool is_grouped(std::string_view digits, char mark) {
    auto at = digits.find(mark);
    if (at == std::string_view::npos || at < 1 || at > 3 || !are_digits(digits.substr(0, at)))
        return false;
    for (; !digits.substr(at).empty(); at += 4) {
        if (digits[at] != mark || digits.size() < at + 4 || !are_digits(digits.substr(at + 1, 3)))
            return false;
    }
    return true;
}

// "" or "E+03".
bool is_exponent(std::string_view text) {
    if (text.empty()) return true;
    const std::string_view digits = without_sign(text.substr(1));
    return (text.front() == 'e' || text.front() == 'E') && !digits.empty() && are_digits(digits);
}

// Whether it is a number with one `decimal` mark; `thousands`: and with such marks before it.
bool has_decimals(std::string_view field, char decimal, char thousands = 0) {
    field = without_sign(field);
    const auto at = field.find(decimal);
    if (at == std::string_view::npos) return false;
    const std::string_view whole = field.substr(0, at), rest = field.substr(at + 1);
    const auto digits = std::min(rest.find_first_of("eE"), rest.size());
    return (thousands ? is_grouped(whole, thousands) : are_digits(whole)) &&
           whole.size() + digits > 0 && are_digits(rest.substr(0, digits)) &&
           is_exponent(rest.substr(digits));
}

struct TextLine {
    std::uint64_t number;
    std::string_view text;
};

std::vector<TextLine> first_lines(std::string_view text) {
    std::vector<TextLine> out;
    Lines lines(text);
    for (std::string_view line; out.size() < most_lines && lines.next(line);) {
        line = trimmed(without_comment(line));
        std::uint64_t count = 0;
        if (!line.empty() && !(out.empty() && parse_count(line, count)))
            out.push_back({lines.number(), line});
    }
    return out;
}

// What fields have where commas do not separate them.
struct Seen {
    bool decimals = false;   // "1,5", "1.234,5"
    bool thousands = false;  // "1,234.5"
    bool separate = false;   // commas do separate: "1,2,3", "a,b"

    void add(std::string_view field) {
        const auto commas = std::ranges::count(field, ',');
        if (commas == 0) return;
        if (has_decimals(field, ',') || has_decimals(field, ',', '.'))
            decimals = true;
        else if (has_decimals(field, '.', ','))
            thousands = true;
        else
            separate = separate || commas > 1 || !starts_as_number(field);
    }
};

// The fields of a line whose commas are not yet known; `split` by which character they are split,
// 0: white space.
void look_at(std::string_view line, char split, Seen& seen) {
    std::vector<std::string_view> fields;
    for (bool more = true; more;) {
        if (split) {
            fields.push_back(next_field(line, split, more));
        } else {
            fields.push_back(next_word(line));
            more = !line.empty();
        }
    }
    if (!split && fields.size() < 3) {
        seen.separate = true;
        return;
    }
    for (const std::string_view field : fields) {
        // Words in a column of their own.
        if (!split || starts_as_number(field)) seen.add(field);
    }
}

// Where commas separate: whether each field is one, so that no white space does.
bool commas_alone(std::string_view line) {
    for (bool more = true; more;) {
        const std::string_view field = next_field(line, ',', more);
        if (starts_as_number(field) && field.find_first_of(" \t;") != std::string_view::npos)
            return false;
    }
    return true;
}

// Whether the whole numbers between a line's commas may be halves of others; `sure`: some can't be
// anything else, as they begin with 0, or are -0.
bool are_halves(std::string_view line, bool& sure) {
    std::size_t count = 0;
    for (bool more = true; more; ++count) {
        const std::string_view field = next_field(line, ',', more);
        std::string_view digits = without_sign(field);
        const auto end = std::min(digits.find_first_of("eE"), digits.size());
        if (end == 0 || !are_digits(digits.substr(0, end)) || !is_exponent(digits.substr(end)))
            return false;
        digits = digits.substr(0, end);
        sure = sure || (digits.front() == '0' && digits.size() > 1) ||
               (field.front() == '-' && std::ranges::count(digits, '0') == std::ssize(digits));
    }
    return count >= 6 && count % 2 == 0;
}

}  // namespace

TextColumns::TextColumns(std::string_view text) {
    std::vector<TextLine> lines = first_lines(text);
    const auto starts = [](std::string_view line) {
        return starts_as_number(line.substr(line.starts_with('"')));
    };
    if (!lines.empty() && !starts(lines.front().text)) lines.erase(lines.begin());  // names
    const auto all = [&](const auto& has) {
        return !lines.empty() &&
               std::ranges::all_of(lines, [&](const TextLine& line) { return has(line.text); });
    };
    const auto have = [](char c) {
        return [c](std::string_view line) { return line.find(c) != std::string_view::npos; };
    };
    const bool quotes = std::ranges::any_of(
        lines, [](const TextLine& line) { return line.text.find('"') != std::string_view::npos; });
    const char split = all(have(';')) ? ';' : quotes && all(have(',')) ? ',' : '\0';
    Seen seen;
    for (const TextLine& line : lines) look_at(line.text, split, seen);
    if (!seen.separate && (seen.decimals || seen.thousands)) {
        commas_ = seen.thousands ? Commas::thousands : Commas::decimal;
        separator_ = split;
        return;
    }
    const auto any = [&](char c) {
        return std::ranges::any_of(lines, [&](const TextLine& line) { return have(c)(line.text); });
    };
    if (split == ';' && !seen.separate) {
        separator_ = ';';
    } else if (any(',') || any(';')) {
        commas_ = Commas::separate;
        if (all(have(',')) && all(commas_alone)) separator_ = ',';
    }
    if (separator_ != ',') return;
    bool sure = false;
    std::uint64_t first = 0;
    for (const TextLine& line : lines) {
        if (!are_halves(line.text, sure)) return;
        if (first == 0) first = line.number;
    }
    if (sure) halves_line_ = first;
}

std::size_t TextColumns::split(std::string_view line, Fields& fields) const {
    line = without_comment(line);
    std::size_t count = 0;
    if (separator_) {
        line = trimmed(line);
        for (bool more = !line.empty(); more && count < most_columns;)
            fields[count++] = next_field(line, separator_, more);
        return count;
    }
    const bool separate = commas_ == Commas::separate;
    while (count < most_columns) {
        const auto field = separate ? next_token(line, true) : next_word(line);
        if (field.empty()) break;
        fields[count++] = field;
    }
    return count;
}

bool TextColumns::number(std::string_view field, double& value) const {
    if (commas_ != Commas::decimal && commas_ != Commas::thousands)
        return parse_number(field, value);
    const bool decimal = commas_ == Commas::decimal;
    const char mark = decimal ? ',' : '.', group = decimal ? '.' : ',';
    if (field.find_first_of(",.") == std::string_view::npos) return parse_number(field, value);
    if (!has_decimals(field, mark) && !has_decimals(field, mark, group) &&
        (decimal || !is_grouped(without_sign(field), group)))
        return false;
    std::string plain(field);
    std::erase(plain, group);
    std::ranges::replace(plain, ',', '.');
    return parse_number(plain, value);
}

const char* TextColumns::rule() const {
    switch (commas_) {
        case Commas::none:
            return "";
        case Commas::separate:
            return ", where commas separate";
        case Commas::decimal:
            return ", where commas are decimals', as the file's first lines have them";
        case Commas::thousands:
            return ", where commas are thousands', as the file's first lines have them";
    }
    return "";
}

}  // namespace topple::io
