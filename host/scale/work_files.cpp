// SPDX-License-Identifier: MIT
#include "scale/work_files.h"

#include <algorithm>
#include <array>
#include <optional>
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

// Reads a file from end to end. What is in it whoever reads it asks.
void check_binary(const fs::path& file) {
    const BinaryReader whole(file);
}

// Whether `check` finds nothing wrong with what it reads. Memory that runs out is no damage.
template <class Check>
bool is_whole(const Check& check) {
    try {
        check();
        return true;
    } catch (const Error&) {
        return false;
    }
}

// Of the points that were sorted into bins, with their colours.
bool points_are_whole(const fs::path& folder, const std::function<void()>& poll) {
    std::optional<SpilledPoints> points;
    bool whole = is_whole([&] { points.emplace(folder); });
    for (std::size_t bin = 0; whole && bin < points->bins().size(); ++bin) {
        poll();
        whole = is_whole(
            [&] { points->read(bin, [](std::span<const Point>, std::span<const Rgb8>) {}); });
    }
    return whole;
}

}  // namespace

bool is_work_file(const std::string& name) {
    std::string_view rest = name;
    if (rest.ends_with(part_suffix)) rest.remove_suffix(part_suffix.size());
    static constexpr std::array<std::string_view, 6> single{
        manifest_name, FolderLock::file_name, "points.bin", "colours.bin", "bins.bin", layout_name};
    if (std::ranges::find(single, rest) != single.end()) return true;
    static constexpr std::array<std::string_view, 4> numbered{"cells-", "order-", "places-",
                                                              block_prefix};
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
    const std::set<std::string> names = names_in(folder);
    const auto remove = [&](const std::string& name) {
        poll();
        fs::remove(folder / name, error);
    };
    for (const std::string& name : names) {
        if (name.ends_with(part_suffix)) {
            remove(name);
        } else if (const auto bin = bin_of_name(name)) {
            poll();
            if (is_whole([&] { check_thinned(folder, *bin); })) continue;
            damaged.push_back(name);
            remove_thinned(folder, *bin);
        } else if (name == layout_name || name.starts_with(block_prefix)) {
            poll();
            const bool whole = is_whole([&] {
                if (name == layout_name)
                    read_layout(folder);
                else
                    check_binary(folder / name);
            });
            if (whole) continue;
            damaged.push_back(name);
            remove(name);
        } else if (name == "bins.bin") {
            if (points_are_whole(folder, poll)) continue;
            damaged.push_back(name);
            remove(name);
        }
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
