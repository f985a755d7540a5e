// SPDX-License-Identifier: MIT
#include "lab/scores/segmentation_score.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "topple/error.h"

namespace topple::scenes {

SegmentationScore segmentation_score(std::span<const std::int32_t> truth,
                                     std::span<const std::int32_t> predicted) {
    if (truth.size() != predicted.size()) {
        throw Error(ErrorKind::usage, "score: " + std::to_string(truth.size()) +
                                          " true labels against " +
                                          std::to_string(predicted.size()));
    }
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t> both;
    std::map<std::int32_t, std::uint64_t> of_truth, of_predicted, best_of_truth, best_of_predicted;
    std::uint64_t points = 0;
    for (std::size_t n = 0; n < truth.size(); ++n) {
        if (truth[n] < 0) continue;
        const std::int32_t p = std::max(predicted[n], -1);
        both[{truth[n], p}]++;
        of_truth[truth[n]]++;
        of_predicted[p]++;
        points++;
    }
    SegmentationScore out;
    if (points == 0) return out;
    std::map<std::int32_t, double> iou;
    for (const auto& [pair, count] : both) {
        const auto [t, p] = pair;
        best_of_truth[t] = std::max(best_of_truth[t], count);
        best_of_predicted[p] = std::max(best_of_predicted[p], count);
        iou[t] = std::max(iou[t], static_cast<double>(count) /
                                      static_cast<double>(of_truth[t] + of_predicted[p] - count));
    }
    const auto all = static_cast<double>(points);
    std::uint64_t covered = 0, kept = 0;
    for (const auto& [t, count] : best_of_truth) covered += count;
    for (const auto& [p, count] : best_of_predicted) kept += count;
    out.missing = 1 - static_cast<double>(covered) / all;
    out.false_alarm = 1 - static_cast<double>(kept) / all;
    out.hamming = (out.missing + out.false_alarm) / 2;
    for (const auto& [t, value] : iou) out.miou += value / static_cast<double>(iou.size());
    return out;
}

}  // namespace topple::scenes
