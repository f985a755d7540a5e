// SPDX-License-Identifier: MIT
#include "io/output_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "io/folder_names.h"
#include "io/pending_outputs.h"
#include "io/text.h"

namespace topple::io {
namespace fs = std::filesystem;
namespace {

// What topple writes; an earlier output may hold these and nothing else. scene.json is written
// last.
constexpr std::array<std::string_view, 18> our_files{
    "parse.cache",     "solids.bin",     "points.ply",     "solid.ply",      "volume.vdb",
    "report.html",     "objects.glb",    "map.bt",         "view-photo.png", "view-objects.png",
    "view-risk.png",   "view-walks.png", "view-human.png", "view-wind.png",  "view-earthquake.png",
    "landscapes.json", "verify.json",    "scene.json"};

bool is_our_scene(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string start(256, '\0');
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(stream.gcount()));
    return start.find("topple.scene/") != std::string::npos;
}

// Throws unless `folder` is missing, empty or an earlier output. `ignored`: a name not to look at.
void check_replaceable(const fs::path& folder, const fs::path& ignored) {
    std::error_code error;
    const auto status = fs::symlink_status(folder, error);
    if (status.type() == fs::file_type::not_found) return;
    if (status.type() != fs::file_type::directory) {
        fail(folder, "exists and is no folder; choose another output folder");
    }
    std::vector<std::string> names = folder_names(folder, error);
    std::erase(names, ignored.native());
    if (error) fail(folder, "can't be listed: " + error.message());
    if (names.empty()) return;
    std::sort(names.begin(), names.end());
    if (!is_our_scene(folder / "scene.json")) {
        fail(folder, "holds files (" + printable(names.front()) +
                         ") but no scene.json, so it is no output of topple and is left as it is; "
                         "choose an empty or a new folder");
    }
    for (const auto& name : names) {
        if (std::find(our_files.begin(), our_files.end(), name) == our_files.end()) {
            fail(folder, "holds " + in_quotes(name) +
                             ", which topple did not write; move it away or choose another folder");
        }
    }
}

fs::path resolved(const fs::path& destination) {
    if (destination.empty()) throw Error(ErrorKind::input, "the output folder's name is empty");
    std::error_code error;
    auto path = fs::absolute(destination, error);
    if (!error) path = fs::weakly_canonical(path, error);
    if (error || !path.is_absolute()) {
        fail(destination,
             "can't be used as output folder: " +
                 (error ? error.message() : std::string("the current folder is gone")));
    }
    if (!path.has_filename()) path = path.parent_path();
    if (!path.has_filename())
        fail(destination, "can't be used as output folder; name a new folder");
    return path;
}

// Replacing the folder that a shell stands in would leave the shell in a folder that is gone.
bool is_current_folder(const fs::path& folder) {
    std::error_code error;
    return fs::equivalent(folder, fs::current_path(error), error);
}

// Moves a file, by copy where the two places are on different file systems. The target appears
// whole.
void move_file(const fs::path& from, const fs::path& to) {
    if (std::rename(from.c_str(), to.c_str()) == 0) return;
    if (errno != EXDEV) fail(to, std::string("can't be written: ") + std::strerror(errno));
    const auto part = to.parent_path() / (".part-" + to.filename().string());
    std::error_code error;
    fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
    if (!error) fs::rename(part, to, error);
    if (error) {
        std::error_code ignored;
        fs::remove(part, ignored);
        fail(to, "can't be written: " + error.message());
    }
    fs::remove(from, error);
}

// Moves our files from one folder into another. scene.json goes first from the target and comes
// last: its presence says that the others belong to it.
void move_files(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::remove(to / "scene.json", error);
    for (const auto name : our_files) {
        if (fs::exists(from / name, error)) {
            move_file(from / name, to / name);
        } else {
            fs::remove(to / name, error);
        }
    }
}

}  // namespace

void check_output(const fs::path& folder) {
    std::error_code error;
    if (fs::exists(folder / "scene.json", error)) return;
    fail(folder, fs::exists(folder, error)
                     ? "holds no output of topple: there is no scene.json in it; give the "
                       "folder that `topple parse` has written"
                     : "No such file or folder");
}

void check_not_replaced(const fs::path& input, const fs::path& destination) {
    const fs::path folder = resolved(destination);
    std::error_code error;
    if (!fs::exists(input, error)) return;
    const fs::path from = fs::canonical(input, error);
    if (error) return;  // who reads it says what is wrong with it
    const auto [end, unlike] = std::ranges::mismatch(folder, from);
    if (end != folder.end()) return;
    throw Error(ErrorKind::usage, path_text(input) + ": is " + (unlike == from.end() ? "" : "in ") +
                                      "the output folder " + path_text(destination) +
                                      ", which is replaced; choose another with -o");
}

OutputFolder::OutputFolder(const fs::path& destination) : destination_(resolved(destination)) {
    check_replaceable(destination_, {});
    std::error_code error;
    for (auto parent = destination_.parent_path();
         parent.has_relative_path() && !fs::exists(parent, error) && !error;
         parent = parent.parent_path()) {
        made_parents_.insert(made_parents_.begin(), parent);
    }
    for (auto made = made_parents_.begin(); made != made_parents_.end(); ++made) {
        if (::mkdir(made->c_str(), 0777) != 0 && errno != EEXIST) {
            const int reason = errno;
            const auto failed = *made;
            made_parents_.erase(made, made_parents_.end());
            forget();
            fail(failed, std::string("can't be made: ") + std::strerror(reason));
        }
    }
    try {
        make_temporary();
    } catch (...) {
        forget();
        throw;
    }
    slot_ = add_pending(temporary_, static_cast<int>(made_parents_.size()));
}

void OutputFolder::make_temporary() {
    auto parent = destination_.parent_path();
    for (int n = 0; n < 1000; ++n) {
        temporary_ = parent / (".topple-" + std::to_string(::getpid()) + "-" + std::to_string(n));
        if (::mkdir(temporary_.c_str(), 0777) == 0) return;
        if (errno == EEXIST) continue;
        const int reason = errno;
        std::error_code error;
        if (parent != destination_ && fs::is_directory(destination_, error)) {
            parent = destination_;  // it may be writable where its parent is not
            continue;
        }
        temporary_.clear();
        fail(parent, std::string("can't be written to: ") + std::strerror(reason) +
                         "; choose another output folder");
    }
    temporary_.clear();
    fail(parent, "is full of folders named .topple-*; remove those");
}

void OutputFolder::commit() {
    const bool inside = temporary_.parent_path() == destination_;
    check_replaceable(destination_, inside ? temporary_.filename() : fs::path());
    struct stat status {};
    const bool exists = ::stat(destination_.c_str(), &status) == 0;
    if (!exists) {
        if (std::rename(temporary_.c_str(), destination_.c_str()) != 0) {
            fail(destination_, std::string("can't be written: ") + std::strerror(errno));
        }
        temporary_.clear();
        made_parents_.clear();
    } else if (!inside && !is_current_folder(destination_) &&
               ::chmod(temporary_.c_str(), status.st_mode & 07777) == 0 &&
               ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, destination_.c_str(),
                           RENAME_EXCHANGE) == 0) {
        // The temporary folder is now the earlier output, which goes with it.
    } else {
        move_files(temporary_, destination_);
    }
    made_parents_.clear();
    forget();
}

void OutputFolder::forget() {
    if (!temporary_.empty()) remove_flat_folder(temporary_.c_str());
    temporary_.clear();
    std::error_code error;
    for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent) {
        fs::remove(*parent, error);
    }
    made_parents_.clear();
    forget_pending(slot_);
    slot_ = -1;
}

OutputFolder::~OutputFolder() {
    forget();
}

}  // namespace topple::io
