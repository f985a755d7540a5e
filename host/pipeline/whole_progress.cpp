// SPDX-License-Identifier: MIT
#include "pipeline/whole_progress.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "safety/disturbances.h"

namespace topple {
namespace {

// Percent of the time of a parse, in the order in which they run: of a cloud in one piece, of
// frames, and of a cloud in blocks. Means over the parses of docs/performance.md#progress.
struct StageShares {
    std::string_view stage;
    std::array<double, 3> percent;
};
constexpr int none = -1;  // there is no such stage
constexpr std::array<StageShares, 34> table{{
    {"cache", {0, 0, 0}},
    {"sorting", {none, none, 1.2}},
    {"spacing", {none, none, 6.9}},
    {"thinning", {none, none, 1.3}},
    {"ingest", {32, 29, none}},
    {"normals", {3.3, 2.4, none}},
    {"frame", {2.4, 1.8, 8.3}},
    {"layout", {none, none, 0.4}},
    {"blocks", {none, none, 55}},
    {"joining", {none, none, 0.8}},
    {"splitting", {2.6, 2.4, none}},
    {"merging", {5, 5.5, none}},
    {"shell", {2, 1.6, none}},
    {"voxels", {7.9, 0.6, none}},
    {"carving", {1.9, 5, none}},
    {"filling", {13, 13, none}},
    {"bodies", {0, 0, 0}},
    {"contacts", {1, 1.2, 0.6}},
    {"joints", {1.2, 1.5, 2.9}},
    {"grouping", {1, 5.1, 0.4}},
    {"masses", {0, 0.1, 0}},
    {"borders", {1.7, 2.9, 0.7}},
    {"supports", {3.4, 10, 0.3}},
    {"barriers", {4.6, 7.8, 2.3}},
    {"alternatives", {2.5, 1, 1.5}},
    {"field human", {1.9, 0.9, 3.9}},
    {"field wind", {1.5, 2.8, 0.4}},
    {"field earthquake", {11, 3.7, 12}},
    {"field reach", {0.5, 0.5, 0.5}},
    {"falls", {0.1, 0.2, 0}},
    {"gusts", {0, 0, 0}},
    {"risk", {1.5, 0.6, 0.9}},
    {"advice", {0.8, 1.3, 1.4}},
    {"assembly", {0.3, 0.3, 0.1}},
}};
constexpr std::string_view field = "field ";

}  // namespace

WholeProgress::WholeProgress(Input input, const ParseOptions& options)
    : whole_(input == Input::frames ? Way::frames : Way::cloud), way_(whole_) {
    for (const safety::DisturbanceKind* kind : safety::acting_kinds(options))
        disturbances_.emplace_back(kind->name);
}

double WholeProgress::percent(std::size_t stage, Way way) {
    return table[stage].percent[static_cast<std::size_t>(way)];
}

double WholeProgress::share_of(std::size_t stage) const {
    const std::string_view name = table[stage].stage;
    const bool asked =
        !name.starts_with(field) ||
        std::ranges::find(disturbances_, name.substr(field.size())) != disturbances_.end();
    return asked ? std::max(percent(stage, way_), 0.0) : 0;
}

double WholeProgress::left_from(std::size_t stage) const {
    double sum = 0;
    for (std::size_t n = stage; n < table.size(); ++n) sum += share_of(n);
    return sum;
}

double WholeProgress::operator()(const std::string& stage, double done) {
    if (stage != stage_) {
        if (known_) done_ = std::max(done_, (*this)(stage_, 1));
        const auto at = std::ranges::find(table, stage, &StageShares::stage);
        const auto number = static_cast<std::size_t>(at - table.begin());
        // A stage that runs again tells nothing new.
        known_ = at != table.end() && (stage_.empty() || number > number_);
        stage_ = stage;
        start_ = done_;
        if (!known_) return done_;
        number_ = number;
        if (percent(number, Way::blocks) == none)
            way_ = whole_;
        else if (percent(number, whole_) == none)
            way_ = Way::blocks;
    }
    const double left = known_ ? left_from(number_) : 0;
    if (left > 0) {
        const double here = share_of(number_) / left * std::clamp(done, 0.0, 1.0);
        done_ = std::max(done_, start_ + (1 - start_) * here);
    }
    return done_;
}

}  // namespace topple
