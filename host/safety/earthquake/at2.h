// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

namespace topple::io {

// A record as PEER's databases hand it out: header lines, the last of which says how many samples
// there are and how far apart ("NPTS= 4000, DT= .0050 SEC", or "4000 0.0050 NPTS, DT"), and then
// the samples, several in a line.
struct At2Record {
    std::vector<double> values;
    double step_s = 0;
    std::set<double> units_m_s2;  // that its header names
};

// Nothing where the text begins with no such header. Throws Error(input) where what follows it is
// not that many finite numbers.
std::optional<At2Record> read_at2(const std::filesystem::path& file, std::string_view text);

}  // namespace topple::io
