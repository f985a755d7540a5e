// SPDX-License-Identifier: MIT
#include "points/formats/obj_surface.h"

#include "io/text.h"

namespace topple::io {

std::string obj_surface(std::string_view bytes) {
    std::string out;
    out.reserve(bytes.size() + 1);
    Lines lines(bytes);
    bool goes_on = false, kept = false;  // a line that ends with \ is one with the next
    for (std::string_view line; lines.next(line);) {
        if (!goes_on) {
            std::string_view rest = line;
            const auto keyword = next_token(rest);
            kept = keyword.starts_with('v') || keyword == "f";
        }
        goes_on = line.ends_with('\\');
        if (kept) out.append(line).append(1, '\n');
    }
    return out;
}

std::string obj_points(std::string_view surface) {
    std::string rows;
    Lines lines(surface);
    for (std::string_view line; lines.next(line);) {
        const auto keyword = next_token(line);
        if (keyword == "f") return {};
        if (keyword == "v") rows.append(line).append(1, '\n');
    }
    std::size_t columns = 0;
    Lines first(rows);
    std::string_view row;
    for (first.next(row); !next_token(row).empty();) ++columns;
    return rows.empty() || columns < 6 ? rows : "x y z red green blue\n" + rows;
}

}  // namespace topple::io
