// SPDX-License-Identifier: MIT
#include "cli/summary.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace topple::cli {
namespace {

constexpr std::size_t rows_shown = 12, sentences_shown = 3;

double risk_of(const Object& o, const std::string& disturbance) {
    const auto at = o.risk_J.find(disturbance);
    return at == o.risk_J.end() ? 0 : at->second;
}

// Why the riskiest are what they are: of those whose barrier is certain, where there are any. The
// others' risk says more about the scan.
void print_sentences(const std::vector<const Object*>& riskiest_first) {
    std::vector<const Object*> certain, doubtful;
    std::size_t unseen = 0;
    for (const Object* o : riskiest_first) {
        (barrier_within_error(*o) || !o->seen_enough ? doubtful : certain).push_back(o);
        unseen += !barrier_within_error(*o) && !o->seen_enough;
    }
    const auto& told = certain.empty() ? doubtful : certain;
    if (told.empty()) return;
    const std::size_t shown = std::min(sentences_shown, told.size());
    std::printf("\nThe %zu riskiest of the %zu whose barrier is %s", shown, told.size(),
                certain.empty() ? "within its error" : "certain");
    if (!certain.empty() && doubtful.size() > unseen)
        std::printf(
            "; that of %zu more is within its error of 0: they stand on edge, or the scan hardly "
            "shows their support",
            doubtful.size() - unseen);
    if (!certain.empty() && unseen > 0)
        std::printf("; %zu more have no rank, since nothing was seen to hold them", unseen);
    std::printf(":\n");
    for (std::size_t i = 0; i < shown; ++i) {
        const Object& o = *told[i];
        std::printf("Object %d: %s%s%s\n", o.id, o.why.sentence.c_str(),
                    o.advice.sentence.empty() ? "" : " ", o.advice.sentence.c_str());
    }
}

void print_objects(const Scene& scene) {
    std::map<std::int32_t, std::string> rests_on;
    for (const Support& s : scene.supports) {
        std::string& text = rests_on[s.supported];
        if (!text.empty()) text.append(",");
        text.append(std::to_string(s.supporter));
    }
    std::vector<const Object*> movable;
    for (const Object& o : scene.objects) {
        if (!o.grounded) movable.push_back(&o);
    }
    std::stable_sort(movable.begin(), movable.end(),
                     [](const Object* a, const Object* b) { return rank_of(*a) > rank_of(*b); });
    std::printf("\n%6s %8s %8s %9s %9s %6s %10s %10s %10s  %s\n", "object", "unsafety", "mass kg",
                "barrier J", "release J", "mode", "human J", "wind J", "quake J", "rests on");
    for (std::size_t i = 0; i < std::min(rows_shown, movable.size()); ++i) {
        const Object& o = *movable[i];
        char barrier[32], unsafety[32] = "-";
        if (o.seen_enough) std::snprintf(unsafety, sizeof(unsafety), "%.1f", o.unsafety);
        if (barrier_within_error(o))
            std::snprintf(barrier, sizeof(barrier), "0-%.2g", o.barrier_J + o.barrier_error_J);
        else
            std::snprintf(barrier, sizeof(barrier), "%.3g", o.barrier_J);
        std::printf("%6d %8s %8.3g %9s %9.3g %6s %10.3g %10.3g %10.3g  %s\n", o.id, unsafety,
                    o.mass_kg, barrier, o.release_J, o.mode.c_str(), risk_of(o, "human"),
                    risk_of(o, "wind"), risk_of(o, "earthquake"),
                    rests_on.contains(o.id) ? rests_on[o.id].c_str() : "-");
    }
    if (movable.size() > rows_shown)
        std::printf("   ... and %zu more in scene.json\n", movable.size() - rows_shown);
    print_sentences(movable);
}

}  // namespace

void print_summary(const Scene& scene, const std::filesystem::path& out) {
    double seconds = 0;
    for (const auto& [stage, s] : scene.timings_s) seconds += s;
    std::size_t grounded = 0, counted = 0;
    for (const Primitive& p : scene.primitives) counted += static_cast<std::size_t>(p.points);
    // Clouds that are parsed in blocks are known by a sample; their parts count all points.
    const char* sample = counted > scene.points.x.size() ? " (samples of the scan)" : "";
    for (const Object& o : scene.objects) grounded += o.grounded;
    std::printf(
        "%zu points%s, voxels of %.3g cm, %zu primitives, %zu objects (%zu fixed to the ground), "
        "%zu supports; %.1f s on %s (%s)\n",
        scene.points.x.size(), sample, 100 * scene.voxel_size_m, scene.primitives.size(),
        scene.objects.size(), grounded, scene.supports.size(), seconds, scene.backend.c_str(),
        scene.device.c_str());
    print_objects(scene);
    for (const std::string& note : scene.notes) std::printf("Note: %s\n", note.c_str());
    std::printf("\nReport: %s\n", (out / "report.html").c_str());
}

}  // namespace topple::cli
