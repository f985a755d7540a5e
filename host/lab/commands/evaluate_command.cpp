// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/choice.h"
#include "cli/interrupt.h"
#include "cli/print.h"
#include "io/replace_file.h"
#include "lab/commands/commands.h"
#include "lab/evaluation/bases.h"
#include "lab/evaluation/groupings.h"
#include "lab/evaluation/kind_score.h"
#include "lab/evaluation/measures.h"
#include "lab/evaluation/ray_ends.h"
#include "lab/evaluation/room.h"
#include "lab/evaluation/segmentation_picture.h"
#include "lab/evaluation/tables.h"
#include "lab/rooms/kinds.h"
#include "lab/scan/files.h"
#include "topple/device.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

struct EvaluateArguments {
    std::string backend = "auto", out = "evaluation";
    evaluation::RoomOptions options;
    unsigned seeds = 8, first = 1;
    bool groupings = false, fit_joints = false, bases = false, rays = false, measures = false;
    bool frames_of_things = false;   // of --measures: depth frames, not clean points
    std::string thing;               // of --measures: those whose names begin so
    std::vector<std::string> kinds;  // of rooms; none: those of --furniture
    scenes::ScanOptions scan{.kind = scenes::ScanKind::sparse};
};

void check(const EvaluateArguments& a) {
    const auto in_range = [](const char* option, unsigned value, unsigned most) {
        if (value >= 1 && value <= most) return;
        throw Error(ErrorKind::usage, std::string(option) + " " + std::to_string(value) +
                                          ": expected 1 to " + std::to_string(most));
    };
    in_range("--seeds", a.seeds, 1000);
    in_range("--frames", a.options.camera.frames, 1000);
    check_options(a.options.parse);
    if ((a.groupings || a.fit_joints || a.bases) && a.options.camera.single) {
        throw Error(ErrorKind::usage,
                    "--single: --groupings, --fit-joints and --bases take rooms of several frames");
    }
}

void keep(const EvaluateArguments& a, const char* name, const std::string& text) {
    io::replace_file(std::filesystem::path(a.out) / name, text);
}

// Prints a table, and keeps it.
void tell(const EvaluateArguments& a, const char* name, const std::string& table) {
    std::fputs(table.c_str(), stdout);
    keep(a, name, table);
}

// Calls use() once for each room, with its options.
template <typename Use>
void for_each_room(EvaluateArguments& a, const Use& use) {
    for (unsigned n = 0; n < a.seeds; ++n) {
        a.options.room.seed = a.options.camera.seed = a.first + n;
        print_to(stderr, "room %u of %u\n", n + 1, a.seeds);
        use();
    }
}

void print_weights(EvaluateArguments& a) {
    evaluation::JointExamples examples;
    for_each_room(a,
                  [&] { evaluation::add_examples(evaluation::scan_parts(a.options), examples); });
    for (const double w : evaluation::fit_joints(examples.joints, examples.fixed))
        print("%.4f, ", w);
    print("\n%zu joints of %u rooms\n", examples.joints.size(), a.seeds);
}

void compare_groupings(EvaluateArguments& a) {
    std::vector<evaluation::Groupings> rooms;
    for_each_room(a, [&] {
        rooms.push_back(evaluation::compare_groupings(*a.options.parse.device,
                                                      evaluation::scan_parts(a.options),
                                                      evaluation::fitted_joint_weights));
    });
    tell(a, "groupings.txt", evaluation::table_of(rooms));
}

void judge_bases(EvaluateArguments& a) {
    evaluation::BasisCounts counts;
    for_each_room(a, [&] {
        const evaluation::RoomParts room = evaluation::scan_parts(a.options);
        evaluation::add_voxels(room.world, *room.solids, room.frame, counts);
    });
    tell(a, "bases.txt", evaluation::table_of(counts));
}

void judge_parses(EvaluateArguments& a) {
    std::vector<evaluation::RoomScore> scores;
    for_each_room(
        a, [&] { scores.push_back(evaluation::judge(evaluation::scan_and_parse(a.options))); });
    tell(a, "tables.txt", evaluation::tables(scores));
    keep(a, "scores.csv", evaluation::csv(scores));
    keep(a, "segmentation.svg", evaluation::segmentation_picture(scores));
    print("\nAll figures: %s\n", a.out.c_str());
}

void judge_kinds(EvaluateArguments& a) {
    std::vector<evaluation::KindScore> scores;
    for (const std::string& kind : a.kinds) {
        for (unsigned n = 0; n < a.seeds; ++n) {
            a.scan.seed = a.first + n;
            print_to(stderr, "%s %u of %u\n", kind.c_str(), n + 1, a.seeds);
            scores.push_back(evaluation::scan_and_judge(kind, a.scan, a.options.parse));
        }
    }
    tell(a, "kinds.txt", evaluation::kinds_table(scores));
    keep(a, "kinds.csv", evaluation::kinds_csv(scores));
}

void count_rays(EvaluateArguments& a) {
    evaluation::RayEndCounts counts;
    for (const std::string& kind : scenes::kinds()) {
        for (unsigned n = 0; n < a.seeds; ++n) {
            for (const scenes::ScanKind scan :
                 {scenes::ScanKind::walk, scenes::ScanKind::sparse, scenes::ScanKind::laser,
                  scenes::ScanKind::single}) {
                a.scan.kind = scan;
                a.scan.seed = a.first + n;
                print_to(stderr, "%s %u of %u, %s\n", kind.c_str(), n + 1, a.seeds,
                         scenes::to_string(scan));
                evaluation::add_rays(kind, a.scan, a.options.parse, counts);
            }
        }
    }
    tell(a, "rays.txt", evaluation::table_of(counts));
}

void judge_measures(EvaluateArguments& a) {
    const evaluation::MeasureOptions options{.frames = a.frames_of_things,
                                             .parse = a.options.parse};
    std::vector<scenes::MeasuredShape> shapes = scenes::measured_shapes();
    if (!a.thing.empty())
        std::erase_if(shapes, [&](const auto& shape) { return !shape.name.starts_with(a.thing); });
    if (shapes.empty()) {
        throw Error(ErrorKind::usage,
                    "--thing " + a.thing + ": no name of the things of --measures begins so");
    }
    std::vector<evaluation::MeasureScore> scores;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        print_to(stderr, "%s, %zu of %zu\n", shapes[s].name.c_str(), s + 1, shapes.size());
        for (unsigned n = 0; n < a.seeds; ++n)
            scores.push_back(evaluation::measure(shapes[s], a.first + n, options));
    }
    tell(a, "measures.txt", evaluation::measures_table(scores));
    keep(a, "measures.csv", evaluation::measures_csv(scores));
}

int run(EvaluateArguments& a) {
    check(a);
    if (!a.fit_joints) scenes::make_folder(a.out);
    catch_interrupts();
    a.options.parse.device = device::open_device(a.backend);
    a.options.parse.cancelled = [] { return interrupted() != 0; };
    try {
        if (a.fit_joints) {
            print_weights(a);
        } else if (a.measures) {
            judge_measures(a);
        } else if (a.rays) {
            count_rays(a);
        } else if (!a.kinds.empty()) {
            judge_kinds(a);
        } else if (a.groupings) {
            compare_groupings(a);
        } else if (a.bases) {
            judge_bases(a);
        } else {
            judge_parses(a);
        }
    } catch (const Error&) {
        if (interrupted() != 0) return interrupted_exit();
        throw;
    }
    return 0;
}

}  // namespace

Command add_evaluate(CLI::App& app) {
    auto a = std::make_shared<EvaluateArguments>();
    a->options.camera.frames = 40;
    a->options.parse.voxel_m = 0.02;
    // No score depends on the disturbances; wind is the quickest.
    a->options.parse.disturbances = {"wind"};
    app.add_option("-o,--output", a->out, "Folder for tables")->capture_default_str();
    app.add_option("--seeds", a->seeds, "How many rooms")->capture_default_str();
    app.add_option("--first", a->first, "Seed of the first room; the others follow")
        ->capture_default_str();
    CLI::Option* const frames =
        app.add_option("--frames", a->options.camera.frames, "Depth frames of each room")
            ->capture_default_str();
    CLI::Option* const groupings =
        app.add_flag("--groupings", a->groupings,
                     "Instead, compare ways of grouping the same primitives (the paper's Table 3): "
                     "each joint by itself, greedy, Swendsen-Wang cuts");
    CLI::Option* const fit_joints =
        app.add_flag(
               "--fit-joints", a->fit_joints,
               "Fit the weights by which --groupings judges joints by themselves, and print them")
            ->excludes(groupings);
    CLI::Option* const bases = app.add_flag("--bases", a->bases,
                                            "Instead, judge each rule of completion: the share of "
                                            "what it takes to be solid that is")
                                   ->excludes(groupings);
    CLI::Option* const rays =
        app.add_flag(
               "--rays", a->rays,
               "Instead, how often what nobody saw is solid, by what its six rays end at; rooms "
               "of all families, each as many as --seeds, scanned in four ways")
            ->excludes(groupings)
            ->excludes(fit_joints)
            ->excludes(bases);
    CLI::Option* const measures =
        app.add_flag("--measures", a->measures,
                     "Mass and barrier of 32 things of known measures instead, from clean points 4 "
                     "mm apart, each at as many places as --seeds")
            ->excludes(groupings)
            ->excludes(fit_joints)
            ->excludes(bases)
            ->excludes(rays);
    app.add_flag("--from-frames", a->frames_of_things,
                 "From the depth camera's noisy frames instead, with --measures")
        ->needs(measures);
    app.add_option("--thing", a->thing, "Only those things whose names begin so, with --measures")
        ->needs(measures);
    CLI::Option* const single =
        app.add_flag("--single", a->options.camera.single,
                     "One frame of each room, without its pose, as in the paper's 6.1 and 6.2");
    add_furniture(app, a->options.room.varied);
    std::vector<std::string> names = scenes::kinds();
    names.emplace_back("all");
    CLI::Option* const kinds =
        app.add_option("--kinds", a->kinds,
                       "Rooms of these families instead, a row of the table for each; or all")
            ->delimiter(',')
            ->check(one_of(names))
            ->excludes(groupings)
            ->excludes(fit_joints)
            ->excludes(measures)
            ->excludes(rays)
            ->excludes(single);
    add_scan(app, a->scan.kind)->needs(kinds);
    app.add_option("--tilt", a->options.room.tilt_deg,
                   "Tilt of the input's frame against the room, degrees")
        ->capture_default_str();
    CLI::Option* const voxel =
        app.add_option("--voxel", a->options.parse.voxel_m, "Edge of a solid voxel in metres")
            ->capture_default_str();
    app.add_option("--backend", a->backend,
                   "auto (a real GPU if there is one, else native), native, opencl, vulkan")
        ->capture_default_str();
    return [a, frames, voxel] {
        // The edge that fits the scan, as a parse chooses it.
        if ((a->rays || !a->kinds.empty()) && !*voxel)
            a->options.parse.voxel_m = ParseOptions{}.voxel_m;
        if (!a->kinds.empty()) {
            if (std::find(a->kinds.begin(), a->kinds.end(), "all") != a->kinds.end())
                a->kinds = scenes::kinds();
            if (*frames) a->scan.frames = a->options.camera.frames;
        }
        return run(*a);
    };
}

}  // namespace topple::cli
