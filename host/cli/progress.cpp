// SPDX-License-Identifier: MIT
#include "cli/progress.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "safety/disturbances.h"

namespace topple::cli {
namespace {

// What a stage does, short enough that the line fits on a terminal of 80 columns.
const char* what_it_does(const std::string& stage) {
    static constexpr std::array<std::pair<const char*, const char*>, 32> stages{
        {{"ingest", "reading the scan"},
         {"estimate", "measuring the scan"},
         {"sorting", "sorting the points into cubes on disk"},
         {"spacing", "measuring how dense the scan is"},
         {"thinning", "keeping one point a cell"},
         {"layout", "cutting the scan into blocks"},
         {"blocks", "turning each block's surfaces into solid parts"},
         {"joining", "joining parts across the blocks' borders"},
         {"normals", "fitting surface elements"},
         {"frame", "finding up and the walls' directions"},
         {"splitting", "growing smooth surfaces"},
         {"merging", "joining surfaces to parts"},
         {"shell", "telling the room layout from the things in it"},
         {"voxels", "turning surfaces into voxels"},
         {"carving", "casting rays through free space"},
         {"filling", "completing what is occluded"},
         {"bodies", "weighing the parts"},
         {"contacts", "finding what touches"},
         {"joints", "judging which parts are one solid"},
         {"cache", "what stays the same from parse to parse"},
         {"grouping", "sampling which parts are one object"},
         {"masses", "weighing the objects"},
         {"borders", "finding what carries what"},
         {"supports", "measuring how far the objects reach"},
         {"barriers", "what it takes to upset each object"},
         {"alternatives", "reading doubtful objects the other way"},
         {"falls", "seeing who passes where things would land"},
         {"gusts", "blowing harder and harder"},
         {"risk", "weighing disturbances by what they release"},
         {"advice", "looking for places where things are safer"},
         {"assembly", "collecting the results"},
         {"output", "writing the files"}}};
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds())
        if (stage == std::string("field ") + kind->name) return kind->words.doing;
    for (const auto& [name, what] : stages) {
        if (stage == name) return what;
    }
    return "";
}

// Between figures of how far a stage is, where there is no terminal.
constexpr double between_figures_s = 30;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Progress::Progress(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      stage_start_(start_),
      told_(start_) {}

void Progress::operator()(const std::string& stage, double done) {
    if (quiet_) return;
    if (stage != stage_) {
        if (!terminal_) finish();
        stage_ = stage;
        stage_start_ = told_ = Clock::now();
        if (!terminal_) std::fprintf(stderr, "%s: %s ...", stage.c_str(), what_it_does(stage));
        line_begun_ = true;
    }
    if (terminal_) {
        std::fprintf(stderr, "\r\033[K%4.0f s", seconds_since(start_));
        if (done > 0) std::fprintf(stderr, " %3.0f %%", 100 * done);
        std::fprintf(stderr, "  %s: %s%s", stage.c_str(), what_it_does(stage),
                     time_left(done).c_str());
    } else if (done > 0 && seconds_since(told_) > between_figures_s) {
        told_ = Clock::now();
        if (!line_begun_) std::fprintf(stderr, "%s:", stage.c_str());
        std::fprintf(stderr, " %.0f %% after %.0f s\n", 100 * done, seconds_since(start_));
        line_begun_ = false;
    }
    std::fflush(stderr);
}

// "", or ", about 3 min left". What an earlier run had done was no work of this one.
std::string Progress::time_left(double done) {
    constexpr double least_s = 3, least_share = 0.02;
    const double elapsed = seconds_since(start_);
    if (elapsed < least_s || done < first_done_) {
        first_done_ = done;
        first_s_ = elapsed;
        return "";
    }
    if (done - first_done_ < least_share || elapsed - first_s_ < least_s) return "";
    const double left = (elapsed - first_s_) / (done - first_done_) * (1 - done);
    char text[48];
    if (left < 90)
        std::snprintf(text, sizeof(text), ", about %.0f s left", std::ceil(left));
    else
        std::snprintf(text, sizeof(text), ", about %.0f min left", std::ceil(left / 60));
    return text;
}

void Progress::finish() {
    if (stage_.empty()) return;
    if (terminal_) {
        std::fprintf(stderr, "\r\033[K");
    } else {
        if (!line_begun_) std::fprintf(stderr, "%s:", stage_.c_str());
        std::fprintf(stderr, " %.2f s\n", seconds_since(stage_start_));
    }
    stage_.clear();
}

}  // namespace topple::cli
