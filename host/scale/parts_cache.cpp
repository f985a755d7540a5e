// SPDX-License-Identifier: MIT
#include "scale/parts_cache.h"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>
#include <type_traits>
#include <utility>

#include "core/build_id.h"
#include "device/cancelling.h"
#include "io/open_file.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "scale/binary_file.h"
#include "scale/parts_fields.h"
#include "scale/work_files.h"
#include "topple/version.h"

namespace topple {
namespace {

namespace fs = std::filesystem;

// Changes with what is written below.
constexpr std::string_view parts_mark = "topple groundwork 6";

void add_text(Checksum& sum, std::string_view text) {
    const std::uint64_t size = text.size();
    sum.add(&size, sizeof(size));
    sum.add(text.data(), text.size());
}

// What is larger takes blocks, or is none of what is parsed in one piece.
constexpr std::uint64_t largest_file_bytes = std::uint64_t{4} << 30;

// False where it can't be read: whoever reads it next says why.
bool add_file(Checksum& sum, const io::FileName& name, const ParseOptions& options) {
    std::optional<io::OpenFile> file;
    try {
        file.emplace(name);
    } catch (const Error&) {
        return false;
    }
    const std::uint64_t size = file->size;
    if (size > largest_file_bytes) return false;
    add_text(sum, name.path().filename().string());
    sum.add(&size, sizeof(size));
    std::vector<char> piece(1 << 20);
    for (std::uint64_t left = size; left > 0;) {
        end_if_cancelled(options);
        const std::uint64_t count = std::min<std::uint64_t>(left, piece.size());
        if (file->read(piece.data(), count) < count) return false;
        sum.add(piece.data(), count);
        left -= count;
    }
    return true;
}

// The files right in a folder of the scan, by name; part: "." for the scan's own.
bool add_files_of(Checksum& sum, const fs::path& scan, const fs::path& part,
                  const ParseOptions& options) {
    std::error_code error;
    if (!fs::is_directory(scan / part, error)) return true;
    std::vector<std::string> names = io::folder_names(io::FileName::in(scan, part), error);
    if (error) return false;
    std::ranges::sort(names);
    for (const std::string& name : names) {
        if (!fs::is_regular_file(scan / part / name, error)) continue;
        if (!add_file(sum, io::FileName::in(scan, part / name), options)) return false;
    }
    return true;
}

bool add_input(Checksum& sum, const fs::path& input, const ParseOptions& options) {
    std::error_code error;
    if (!fs::is_directory(input, error)) {
        // Parts of these lie in other files.
        const std::string kind = io::lower_case(input.extension().string());
        return kind != ".gltf" && kind != ".obj" && add_file(sum, input, options);
    }
    for (const char* part : {"", "depth", "color"}) {
        add_text(sum, part);
        if (!add_files_of(sum, input, *part ? part : ".", options)) return false;
    }
    return true;
}

void add_options(Checksum& sum, const ParseOptions& options) {
    const auto add = [&](const auto& value) { sum.add(&value, sizeof(value)); };
    add_text(sum, version);
    add_text(sum, build_id());
    const device::DeviceInfo& info = options.device->info();
    add_text(sum, device::to_string(info.backend));
    // The native backend's results are those of every processor and number of threads.
    if (info.backend != device::Backend::native) {
        add_text(sum, info.name);
        add_text(sum, info.driver);
    }
    add(options.voxel_m);
    add(options.unit_m);
    add(options.max_memory_bytes);
    add(options.density_kg_m3);
    add(options.up.value_or(Vec3{}));
    add(options.coordinates);
}

}  // namespace

PartsCache::PartsCache(const fs::path& input, const ParseOptions& options)
    : file_(options.cache_file), notice_(options.notice) {
    io::check_replaceable_file(file_);
    if (!tiles::has_mark(file_))
        io::fail(file_, "exists and is no cache of topple; choose another name");
    Checksum sum;
    add_text(sum, parts_mark);
    add_options(sum, options);
    if (add_input(sum, input, options)) key_ = sum.value();
}

std::optional<FoundParts> PartsCache::read() const {
    std::error_code error;
    if (!key_ || !fs::is_regular_file(file_, error)) return std::nullopt;
    const auto tell = [&](const std::string& line) {
        if (notice_) notice_(line);
    };
    try {
        tiles::BinaryReader file(file_);
        if (file.value<Checksum::Value>() != *key_) return std::nullopt;
        FoundParts out = read_parts(file);
        tell("going on from " + file_.filename().string() +
             ", which holds what an earlier parse found");
        return out;
    } catch (const Error&) {
        tell(file_.filename().string() +
             " is damaged or no cache of this program; it is made anew");
        return std::nullopt;
    }
}

void PartsCache::write(const FoundParts& found) const {
    try {
        io::PendingFile pending(file_);
        tiles::BinaryWriter file(pending.path());
        file(*key_);
        write_parts(file, found);
        file.finish(false);
        pending.commit();
    } catch (const Error& failed) {
        if (notice_) notice_(std::string(failed.what()) + "; the next parse begins anew");
    }
}

}  // namespace topple
