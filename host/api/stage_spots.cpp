// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <string>

#include "report/part_spots.h"
#include "topple/error.h"
#include "topple/stages.h"

namespace topple::stages {

std::vector<std::int64_t> label_spots(const Voxels& solid) {
    constexpr std::int32_t most_labels = 65534, farthest = 1 << 20;
    const auto wrong = [](const std::string& what) {
        throw Error(ErrorKind::usage, "label_spots: " + what);
    };
    const std::size_t count = solid.i.size();
    if (solid.j.size() != count || solid.k.size() != count || solid.label.size() != count ||
        solid.state.size() != count)
        wrong("i, j, k, label and state differ in length");
    std::int32_t labels = 0;
    std::vector<report::Cell> cells(count);
    report::CellTable table;
    for (std::size_t n = 0; n < count; ++n) {
        const std::int32_t label = solid.label[n];
        if (label < -1 || label >= most_labels)
            wrong("label " + std::to_string(label) + " is none from -1 to " +
                  std::to_string(most_labels - 1));
        report::Cell& cell = cells[n];
        cell.index = {solid.i[n], solid.j[n], solid.k[n]};
        for (const std::int32_t at : cell.index)
            if (at <= -farthest || at >= farthest)
                wrong("voxel " + std::to_string(at) + " is further than 2^20 from 0");
        cell.group = static_cast<std::uint16_t>(label + 1);
        cell.completed = solid.state[n] != 1;
        cell.exposed = 1;  // those inside name their label as well
        table.insert(cell.index, static_cast<std::uint32_t>(n));
        labels = std::max(labels, label + 1);
    }
    const auto inner = report::inner_cells(cells, table, static_cast<std::size_t>(labels) + 1);
    std::vector<std::int64_t> out;
    for (std::size_t group = 1; group < inner.size(); ++group)
        out.push_back(inner[group] == report::CellTable::absent ? -1 : std::int64_t{inner[group]});
    return out;
}

}  // namespace topple::stages
