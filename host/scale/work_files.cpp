// SPDX-License-Identifier: MIT
#include "scale/work_files.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <system_error>

#include "io/open_file.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "scale/binary_file.h"
#include "scale/blocks.h"
#include "scale/folder_lock.h"
#include "scale/point_spill.h"
#include "scale/thinned_bin.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view part_suffix = ".part";

// Whether `check` finds nothing wrong with what it reads. That memory runs out, or the parse was
// cancelled, is no damage.
template <class Check>
bool is_whole(const Check& check) {
    try {
        check();
        return true;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        return false;
    }
}

// Reads each of the files from end to end. What is in it whoever reads it asks.
bool are_whole(const fs::path& folder, const std::vector<std::string>& names) {
    return is_whole([&] {
        for (const std::string& name : names) const BinaryReader whole(folder / name);
    });
}

// What an earlier run has finished with the file of this name: it is of use only together. None
// where nothing was finished with it.
std::vector<std::string> group_of(const std::string& name) {
    if (name == layout_name || name == bins_name || name.starts_with(block_prefix)) return {name};
    return files_of_thinned(name);
}

// Of the points that were sorted into bins, with their colours.
bool points_are_whole(const fs::path& folder, const std::function<void()>& poll) {
    return is_whole([&] {
        const SpilledPoints points(folder);
        for (std::size_t bin = 0; bin < points.bins().size(); ++bin) {
            poll();
            points.read(bin, [](std::span<const Point>, std::span<const Rgb8>) {});
        }
    });
}

}  // namespace

bool is_work_file(const std::string& name) {
    std::string_view rest = name;
    if (rest.ends_with(part_suffix)) rest.remove_suffix(part_suffix.size());
    static constexpr std::array<std::string_view, 6> single{
        manifest_name, FolderLock::file_name, "points.bin", "colours.bin", bins_name, layout_name};
    if (std::ranges::find(single, rest) != single.end()) return true;
    static constexpr std::array<std::string_view, 3> numbered{"cells-", "numbers-", block_prefix};
    return std::ranges::any_of(numbered, [&](std::string_view prefix) {
        return rest.size() > prefix.size() && rest.starts_with(prefix) &&
               rest.find_first_not_of("0123456789_-", prefix.size()) == std::string_view::npos;
    });
}

bool has_mark(const fs::path& file) {
    return file_mark.starts_with(io::beginning_of(file, file_mark.size()));
}

std::vector<std::string> remove_damaged(const fs::path& folder, const std::function<void()>& poll) {
    std::vector<std::string> damaged;
    std::error_code error;
    for (const std::string& name : names_in(folder)) {
        const bool unfinished = name.ends_with(part_suffix);
        const std::vector<std::string> files = unfinished ? std::vector{name} : group_of(name);
        if (files.empty()) continue;
        poll();
        if (!unfinished) {
            if (are_whole(folder, files) && (name != bins_name || points_are_whole(folder, poll)))
                continue;
            damaged.push_back(name);
        }
        for (const std::string& file : files) fs::remove(folder / file, error);
    }
    return damaged;
}

std::set<std::string> names_in(const fs::path& folder) {
    std::error_code error;
    const std::vector<std::string> names = io::folder_names(folder, error);
    if (error) io::fail(folder, "can't be read: " + error.message());
    return {names.begin(), names.end()};
}

}  // namespace topple::tiles
