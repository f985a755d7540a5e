// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/option_values.h"
#include "cli/print.h"
#include "io/output_folder.h"
#include "io/text.h"
#include "live/growing_folder.h"
#include "live/session_stream.h"
#include "topple/device.h"
#include "topple/session.h"

namespace topple::cli {
namespace {

// What the user names in place of a folder.
constexpr const char* standard_input = "-";

struct LiveArguments {
    std::string from, out, backend = "auto", up, checkpoint;
    SessionOptions options;
    std::optional<double> idle_s;
    unsigned threads = 0;
    bool quiet = false;
};

using Clock = std::chrono::steady_clock;
double since_s(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

std::string text_of(const Thing& thing, const Scene& scene) {
    std::string out = "thing " + std::to_string(thing.id);
    if (thing.object < 0) return out;
    const Object& object = scene.objects[static_cast<std::size_t>(thing.object)];
    if (!object.name.empty()) out += " (" + object.name + ")";
    if (!object.grounded && object.seen_enough && object.unsafety_category != "none")
        out += ", " + object.unsafety_category;
    return out;
}

// Whether it is of the room, and not of what is known of it.
bool is_of_the_room(Change change) {
    return change == Change::came || change == Change::moved || change == Change::gone;
}

void print_changes(const LiveScene& found, double took_s) {
    const Scene& scene = found.result->scene;
    std::size_t things = 0;
    for (const Object& object : scene.objects) things += !object.grounded;
    print("%s, %s; %.1f s\n", io::counted(found.frames.size(), "frame").c_str(),
          io::counted(things, "thing").c_str(), took_s);
    for (const Thing& thing : found.things) {
        if (!is_of_the_room(thing.change)) continue;
        print("  %s: %s", to_string(thing.change), text_of(thing, scene).c_str());
        if (thing.change == Change::moved) print(", by %.2f m", thing.moved_m);
        print("\n");
    }
    std::fflush(stdout);
}

// Before an update knows of it.
void print_glance(const Session& session) {
    for (const Appeared& one : session.glance()) {
        const auto& [x, y, z] = one.middle_m;
        const auto& [wide, deep, high] = one.size_m;
        print("  seen: %.2f x %.2f x %.2f m at (%.2f, %.2f, %.2f), about %.2g kg", wide, deep, high,
              x, y, z, one.mass_kg);
        if (!one.unsafety_category.empty()) print(", %s", one.unsafety_category.c_str());
        print("\n");
    }
    std::fflush(stdout);
}

// called: what messages call it.
std::unique_ptr<live::Feed> feed_of(const std::string& named, const std::string& called,
                                    const std::string& out) {
    if (named == standard_input) return std::make_unique<live::SessionStream>(STDIN_FILENO, called);
    std::error_code error;
    if (!std::filesystem::is_directory(named, error))
        throw Error(ErrorKind::input, named + ": No such folder");
    io::check_not_replaced(named, out);
    return std::make_unique<live::GrowingFolder>(named);
}

int run(LiveArguments& a) {
    constexpr auto pause = std::chrono::milliseconds(100);
    constexpr std::size_t most_at_once = 500;
    constexpr double patience_s = 5;  // until it is said what is waited for
    if (!a.up.empty()) a.options.parse.up = parse_up("--up", a.up);
    catch_interrupts();
    const bool is_folder = a.from != standard_input;
    const std::string called = is_folder ? a.from : "standard input";
    const auto feed = feed_of(a.from, called, a.out);
    // Whether the file is there or not.
    if (!a.checkpoint.empty())
        io::check_not_replaced(std::filesystem::absolute(a.checkpoint).parent_path(), a.out);
    a.options.parse.device = device::open_device(a.backend, a.threads);
    a.options.parse.cancelled = [] { return interrupted() != 0; };
    a.options.source = called;
    OutputOptions output;
    output.threads = a.threads;
    output.cancelled = a.options.parse.cancelled;
    if (is_folder) output.command = {"topple", "parse", a.from, "-o", a.out};
    if (!a.quiet)
        print("following %s, with results in %s; it ends %s\n", called.c_str(), a.out.c_str(),
              a.idle_s
                  ? ("after " + io::short_number(*a.idle_s) + " s without anything new").c_str()
              : is_folder ? "with Ctrl-C"
                          : "where that does");
    std::fflush(stdout);

    std::unique_ptr<Session> session;
    std::size_t written = 0;  // frames that the output is of
    auto last = Clock::now();
    std::string said;
    live::Feed::Reading reading;
    reading.most = most_at_once;
    reading.told = [&](const std::string& line) { print_to(stderr, "%s\n", line.c_str()); };
    try {
        while (interrupted() == 0) {
            if (!session) {
                session = feed->begin(a.options, a.checkpoint);
                if (session && session->next_frame() > 0 && !a.quiet)
                    print("going on from %s: %s\n", a.checkpoint.c_str(),
                          io::counted(session->frames().size(), "frame").c_str());
                // At once, as one that can't be written is of no use.
                if (session && !a.checkpoint.empty()) session->checkpoint(a.checkpoint);
            }
            if (session && feed->read(*session, reading)) {
                if (!a.quiet) print_glance(*session);
                const auto start = Clock::now();
                const auto found = session->update();
                write_outputs(*found, a.out, output);
                if (!a.checkpoint.empty()) session->checkpoint(a.checkpoint);
                written = found->frames.size();
                if (!a.quiet) print_changes(*found, since_s(start));
                last = Clock::now();
                reading.is_last = false;
                continue;
            }
            if (reading.is_last || feed->ended()) break;
            reading.is_last = a.idle_s && since_s(last) >= *a.idle_s;
            if (reading.is_last) continue;
            if (!a.quiet && since_s(last) > patience_s && !feed->waits_for().empty() &&
                feed->waits_for() != said) {
                said = feed->waits_for();
                print_to(stderr, "waiting: %s\n", said.c_str());
            }
            std::this_thread::sleep_for(pause);
        }
    } catch (const Error&) {
        if (interrupted() == 0) throw;
    }
    if (interrupted() != 0) {
        if (written == 0) return interrupted_exit();
        print_to(stderr, "topple: interrupted; %s is of %s\n", a.out.c_str(),
                 io::counted(written, "frame").c_str());
        return 128 + interrupted();
    }
    if (const std::string missing = feed->missing_from(written > 0 ? a.out : ""); !missing.empty())
        throw Error(ErrorKind::input, missing);
    if (written == 0) throw Error(ErrorKind::input, called + ": no frame came");
    return 0;
}

}  // namespace

Command add_live(CLI::App& app) {
    auto a = std::make_shared<LiveArguments>();
    app.add_option(
           "FOLDER", a->from,
           "Sequence folder (depth/*.png, intrinsics.json, a trajectory) into which another\n"
           "program writes frames, and corrects poses; or - for messages on standard input\n"
           "(docs/live.md)")
        ->required();
    app.add_option("-o,--output", a->out, "Folder for the results, written anew at each update")
        ->required();
    app.add_option("--backend", a->backend,
                   "auto (a real GPU if there is one, else native), native, opencl, vulkan")
        ->capture_default_str();
    app.add_option("--voxel", a->options.parse.voxel_m,
                   "Edge of a solid voxel in metres (default: found from the frames)")
        ->check(number_above_0);
    app.add_option("--up", a->up,
                   "Up in the trajectory's frame, X,Y,Z, as from an IMU (default: found)");
    app.add_flag_function(
        "--keep-gone", [a](std::int64_t) { a->options.forget_gone = false; },
        "Count readings, too, at places that later frames see through");
    app.add_option(
        "--checkpoint", a->checkpoint,
        "File that is written with each update, and gone on from where it is there: frames,\n"
        "and the ids of things, outlive a crash");
    app.add_option(
           "--idle", a->idle_s,
           "Seconds without anything new after which it ends (default: at Ctrl-C); exit code 1\n"
           "where images that came are not in the results")
        ->check(number_above_0);
    app.add_option("--threads", a->threads, "Threads of the native backend (default: all cores)");
    app.add_flag("--quiet", a->quiet, "Print errors only");
    return [a] { return run(*a); };
}

}  // namespace topple::cli
