// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "lab/scan/scan.h"
#include "lab/temporary_folder.h"
#include "topple/parse.h"

// Parses of scans of the families of rooms (lab/rooms/kinds.h), judged by what moves as one.
namespace topple::evaluation {

// A point's true object is that of the nearest point of truth within 6 cm. All that is fixed to the
// building is one ground with it. Judged are loose objects with 150 cm^2 in view and 30 points of
// the scan; rows and loads that the truth does not tell apart are none. NaN: there was none.
struct KindScore {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::string kind;
    std::uint64_t seed = 0;
    std::size_t points = 0, objects = 0;  // of the scan; judged
    // Mean over objects of the best IoU with a found object that is not grounded; share above 0.5.
    double miou = none, found = none;
    // The latter if every primitive were an object of its own, and if primitives were grouped by
    // the true object that most of each is.
    double found_alone = none, found_best = none;
    // Pairs of touching primitives: those of one true object that are in one found object, and the
    // share of truly fixed ones among those that are in one found object.
    double joint_recall = none, joint_precision = none;
    // Supports between objects that were found, and found ones that are true.
    double support_recall = none, support_precision = none;
    double swallowed = none;  // share of the judged objects' points in the ground
    double parse_s = 0;
};
KindScore judge_kind(const scenes::World& world, const scenes::Scan& scan, const Scene& scene);

// The room and the scan of a seed, in files for as long as this is there. Throws what these throw.
class ScannedKind {
  public:
    ScannedKind(const std::string& kind, const scenes::ScanOptions& options);
    std::filesystem::path input() const;

    const scenes::World world;
    const scenes::Scan scan;

  private:
    scenes::TemporaryFolder folder_{"topple_kind"};
};

// Makes, parses and judges one.
KindScore scan_and_judge(const std::string& kind, const scenes::ScanOptions& scan_options,
                         const ParseOptions& parse_options);

// A row of means for each kind, and of all.
std::string kinds_table(const std::vector<KindScore>& scores);
std::string kinds_csv(const std::vector<KindScore>& scores);

}  // namespace topple::evaluation
