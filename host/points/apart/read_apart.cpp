// SPDX-License-Identifier: MIT
#include <string>
#include <system_error>

#include "child/process.h"
#include "child/program.h"
#include "io/text.h"
#include "points/apart/read_scan.h"
#include "points/apart/scan_message.h"
#include "points/formats/octomap.h"
#include "points/formats/read_cloud.h"
#include "vdb/read_volume.h"

namespace topple::reader {
namespace {

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;

// A limit that honest files stay far below: twice what was measured of their kind, or more.
child::Limits limits_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(file, error);
    const std::uint64_t bytes = error ? 0 : size;
    // Points of a mesh's faces take 140 MB of it, whatever its size; what else a library makes of a
    // mesh was checked before. A byte of a packed volume may be a row of voxels, and one of an
    // OctoMap four leaves, of which each is a node and a box.
    std::uint64_t fixed = 320 * mebibyte, of_a_byte = 40;
    if (vdb::looks_like_volume(file)) fixed = 64 * mebibyte, of_a_byte = 60;
    if (io::looks_like_octomap(file)) fixed = 160 * mebibyte, of_a_byte = 400;
    child::Limits limits;
    limits.memory_bytes = fixed + io::saturating_multiply(of_a_byte, bytes);
    limits.cpu_s = 8 + bytes / mebibyte;
    // A busy machine gives it a share of its time.
    limits.wall_s = 60 + 10 * static_cast<double>(limits.cpu_s);
    return limits;
}

// What a child answered, who knows the file by another name.
ScannedMap named_as_here(const child::Answer& answer, const std::filesystem::path& there,
                         const std::filesystem::path& file) {
    try {
        ScannedMap map = take_scan(answer);
        map.cloud.source = io::path_text(file);
        return map;
    } catch (const Error& error) {
        std::string text = error.what();
        const std::string name = io::path_text(there);
        if (text.starts_with(name)) text.replace(0, name.size(), io::path_text(file));
        throw Error(error.kind(), text);
    }
}

// What a reader of its own makes of the file; task: what it is to do.
ScannedMap read_by(const char* name, const char* task, const std::filesystem::path& file,
                   double unit_m, const std::function<void()>& poll) {
    const std::filesystem::path program = child::find_program(name);
    if (program.empty()) {
        throw Error(ErrorKind::usage,
                    io::path_text(file) + ": such files are read by the program " + name +
                        ", in a process of its own, which was not found beside this one; name its "
                        "folder in the environment variable TOPPLE_READERS, or, for a file that "
                        "you trust, say isolate = false (--no-isolate)");
    }
    const child::Limits limits = limits_of(file);
    const std::filesystem::path there = std::filesystem::absolute(file);
    const child::Ended ended =
        child::run(program.string(), {task, unit_text(unit_m), there.string()}, limits, poll);
    if (!ended.started)
        throw Error(ErrorKind::input, io::path_text(file) + ": is read by another program, and " +
                                          ended.how +
                                          "; or, for a file that you trust, say "
                                          "isolate = false (--no-isolate)");
    try {
        if (ended.answer.whole()) return named_as_here(ended.answer, there, file);
    } catch (const child::BadAnswer&) {
    }
    io::fail(file, "can't be read: its reader " +
                       (ended.answer.whole() ? "gave an answer that makes no sense" : ended.how) +
                       " within its limits of " + io::bytes_text(limits.memory_bytes) + " and " +
                       std::to_string(limits.cpu_s) +
                       " s; the file is damaged, or of another kind than its name says: write it "
                       "anew, or, if you trust it, say isolate = false (--no-isolate)");
}

}  // namespace

bool takes_others(const std::filesystem::path& file) {
    return io::looks_like_octomap(file) || vdb::looks_like_volume(file) || io::is_mesh(file);
}

ScannedMap read_scan(const std::filesystem::path& file, double unit_m,
                     const std::function<void()>& poll) {
    return vdb::looks_like_volume(file) ? vdb::read_volume(file, unit_m)
                                        : read_points(file, unit_m, poll);
}

ScannedMap read_scan_apart(const std::filesystem::path& file, double unit_m,
                           const std::function<void()>& poll) {
    std::error_code error;
    // What is no file is told by the reader here.
    if (std::filesystem::is_directory(file, error) || !takes_others(file))
        return read_scan(file, unit_m, poll);
    return read_by(vdb::looks_like_volume(file) ? child::volume_program : child::reader_program,
                   "scan", file, unit_m, poll);
}

ScannedMap read_volume_apart(const std::filesystem::path& file, const std::function<void()>& poll) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        io::fail(file, "is missing, or no file; parse the scan again");
    return read_by(child::volume_program, "states", file, 1, poll);
}

}  // namespace topple::reader
