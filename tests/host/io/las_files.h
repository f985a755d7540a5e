// SPDX-License-Identifier: MIT
#pragma once

#include "files.h"

namespace topple::test {

// A LAS file of points in thousandths.
struct LasFile {
    unsigned minor = 2, format = 0;
    std::array<double, 3> scale{1e-3, 1e-3, 1e-3}, offset{0, 0, 0};
    std::vector<std::array<std::int32_t, 3>> points;
    std::vector<std::size_t> withheld;                  // which of them
    std::vector<std::array<std::uint16_t, 3>> colours;  // of formats that have them
    std::vector<std::string> records, records_behind;   // variable length; extended: LAS 1.4
    std::array<double, 3> extent{};                     // as the header has it, from 0 on

    std::string bytes() const {
        constexpr std::array<std::uint16_t, 11> record{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
        const auto header = static_cast<std::uint16_t>(minor == 4 ? 375 : minor == 3 ? 235 : 227);
        std::string out = "LASF";
        out.resize(24, '\0');
        out.push_back('\1');
        out.push_back(static_cast<char>(minor));
        out.resize(94, '\0');
        append<std::uint16_t>(out, header);
        std::string between;
        for (const std::string& one : records) between += one;
        append<std::uint32_t>(out, static_cast<std::uint32_t>(header + between.size()));
        append<std::uint32_t>(out, static_cast<std::uint32_t>(records.size()));
        out.push_back(static_cast<char>(format));
        append<std::uint16_t>(out, record[format]);
        append<std::uint32_t>(out, minor == 4 ? 0 : static_cast<std::uint32_t>(points.size()));
        out.resize(131, '\0');
        for (const double v : scale) append(out, v);
        for (const double v : offset) append(out, v);
        for (const double v : extent) {
            append(out, v);
            append(out, 0.0);
        }
        out.resize(header, '\0');
        if (minor == 4) {
            std::string count;
            append<std::uint64_t>(count, points.size());
            out.replace(247, 8, count);
            std::string behind;
            append<std::uint64_t>(behind, header + between.size() + points.size() * record[format]);
            append<std::uint32_t>(behind, static_cast<std::uint32_t>(records_behind.size()));
            out.replace(235, 12, behind);
        }
        out += between;
        for (std::size_t n = 0; n < points.size(); ++n) {
            std::string point;
            for (const std::int32_t v : points[n]) append(point, v);
            point.resize(record[format], '\0');
            constexpr std::array<std::uint16_t, 11> colour_at{0, 0,  20, 28, 0, 28,
                                                              0, 30, 30, 0,  30};
            if (n < colours.size()) {
                std::string colour;
                for (const std::uint16_t v : colours[n]) append(colour, v);
                point.replace(colour_at[format], 6, colour);
            }
            for (const std::size_t w : withheld) {
                if (w == n) point[15] = static_cast<char>(format >= 6 ? 0x04 : 0x80);
            }
            out += point;
        }
        for (const std::string& last : records_behind) out += last;
        return out;
    }
};

}  // namespace topple::test
