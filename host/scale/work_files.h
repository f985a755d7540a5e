// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

// The files of a work folder: which names they have, and whether they are what was written.
namespace topple::tiles {

inline constexpr const char* manifest_name = "topple-work";
inline constexpr const char* block_prefix = "block-";

// Whether topple gives files of a work folder that name.
bool is_work_file(const std::string& name);

// Whether a file can be one of topple's by what it holds: nothing, or topple's mark at its front,
// as far as it goes.
bool has_mark(const std::filesystem::path& file);

// Looks at every file that an earlier run has left. Those that are damaged or not whole are
// removed, with those that are of use only together with them, so that they are made anew. Returns
// the names of what was damaged, but for what a killed run was just writing. poll: called now and
// then.
std::vector<std::string> remove_damaged(const std::filesystem::path& folder,
                                        const std::function<void()>& poll);

// The names of the files in a folder. Unlike asking for a name, this leaves no trace in a network
// file system's memory of what is missing, which would hide what another machine makes next.
std::set<std::string> names_in(const std::filesystem::path& folder);

}  // namespace topple::tiles
