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
#include <string>
#include <string_view>
#include <system_error>

#include "io/open_file.h"
#include "io/pending_outputs.h"
#include "io/replace_file.h"
#include "io/text.h"

namespace topple::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* foreign =
    ", which topple did not write; move it away or choose another folder";

constexpr std::array<std::string_view, 25> parse_files{
    "parse.cache",    "solids.bin",         "points.ply",       "solid.ply",
    "volume.vdb",     "report.html",        "objects.glb",      "map.bt",
    "fields.vdb",     "field-human.png",    "field-wind.png",   "view-photo.png",
    "view-parts.png", "view-completed.png", "view-objects.png", "view-risk.png",
    "view-walks.png", "view-human.png",     "view-wind.png",    "view-earthquake.png",
    "view-reach.png", "landscapes.json",    "things.json",      "verify.json",
    "scene.json"};

bool is_numbered_image(std::string_view name) {
    return name.ends_with(".png") && name.find_first_not_of("0123456789") == name.size() - 4;
}

void check_images(const fs::path& folder) {
    std::error_code error;
    const auto type = fs::symlink_status(folder, error).type();
    if (type == fs::file_type::not_found) return;
    if (type != fs::file_type::directory) fail(folder, std::string("is no folder") + foreign);
    for (const std::string& name : folder_names(folder, error)) {
        if (!is_numbered_image(name)) fail(folder, "holds " + in_quotes(name) + foreign);
        check_replaceable_file(folder / name);
    }
    if (error) fail(folder, "can't be listed: " + error.message());
}

// Throws unless `folder` is missing, empty or an earlier output. `ignored`: a name not to look at.
void check_replaceable(const fs::path& folder, const OutputKind& kind,
                       const fs::path& ignored = {}) {
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
    const std::string_view told_by = kind.files.back();
    if (beginning_of(folder / told_by, 256).find(kind.mark) == std::string::npos) {
        fail(folder, "holds files (" + printable(names.front()) + ") but no " +
                         std::string(told_by) + " that topple wrote, so it is no " + kind.what +
                         " and is left as it is; choose an empty or a new folder");
    }
    for (const auto& name : names) {
        if (std::ranges::find(kind.folders, name) != kind.folders.end()) {
            check_images(folder / name);
        } else if (std::ranges::find(kind.files, name) != kind.files.end()) {
            check_replaceable_file(folder / name);
        } else {
            fail(folder, "holds " + in_quotes(name) + foreign);
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

// Moves our files from one folder into another, by copies where the two are on different file
// systems; each appears whole. The last of the kind goes first from the target: its presence says
// that the others belong to it.
void move_files(const fs::path& from, const fs::path& to, const OutputKind& kind) {
    std::optional<StagingFolder> copies;
    std::error_code error;
    const auto move_one = [&](const fs::path& name) {
        if (std::rename((from / name).c_str(), (to / name).c_str()) == 0) return;
        error.assign(errno, std::generic_category());
        if (errno == EXDEV) {
            if (!copies) copies.emplace(to);
            error.clear();
            fs::copy(from / name, copies->path() / name, fs::copy_options::recursive, error);
            if (!error) fs::rename(copies->path() / name, to / name, error);
        }
        if (error) fail(to / name, "can't be written: " + error.message());
    };
    ::unlink((to / kind.files.back()).c_str());
    for (const auto name : kind.folders) {
        check_images(to / name);
        remove_tree((to / name).c_str());
        if (fs::exists(from / name, error)) move_one(name);
    }
    for (const auto name : kind.files) {
        check_replaceable_file(to / name);
        if (fs::exists(from / name, error))
            move_one(name);
        else
            ::unlink((to / name).c_str());
    }
}

}  // namespace

const OutputKind output_of_parse{parse_files, "topple.scene/", {}, "output of topple"};

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

OutputFolder::OutputFolder(const fs::path& destination, const OutputKind& kind)
    : kind_(kind), destination_(resolved(destination)) {
    remove_abandoned(destination_);
    check_replaceable(destination_, kind_);
    try {
        make_parents();
        make_staging();
    } catch (...) {
        remove_parents();
        throw;
    }
}

void OutputFolder::make_parents() {
    std::error_code error;
    std::vector<fs::path> missing;
    for (auto parent = destination_.parent_path();
         parent.has_relative_path() && !fs::exists(parent, error) && !error;
         parent = parent.parent_path())
        missing.insert(missing.begin(), parent);
    for (const fs::path& parent : missing) {
        if (::mkdir(parent.c_str(), 0777) == 0)
            made_parents_.push_back(parent);
        else if (errno != EEXIST)
            fail(parent, std::string("can't be made: ") + std::strerror(errno));
    }
}

void OutputFolder::make_staging() {
    std::error_code error;
    const bool exists = fs::is_directory(destination_, error);
    try {
        staging_.emplace(destination_.parent_path(), static_cast<int>(made_parents_.size()));
    } catch (const Error&) {
        if (!exists) throw;
        staging_.emplace(destination_);  // it may be writable where its parent is not
    }
    if (::mkdir(folder().c_str(), 0777) != 0)
        fail(folder(), std::string("can't be made: ") + std::strerror(errno));
}

void OutputFolder::commit() {
    const bool inside = staging_->path().parent_path() == destination_;
    check_replaceable(destination_, kind_, inside ? staging_->path().filename() : fs::path());
    std::error_code error;
    if (!fs::exists(fs::symlink_status(destination_, error))) {
        if (std::rename(folder().c_str(), destination_.c_str()) != 0) {
            fail(destination_, std::string("can't be written: ") + std::strerror(errno));
        }
    } else if (inside || is_current_folder(destination_) || !exchange()) {
        move_files(folder(), destination_, kind_);
    }
    made_parents_.clear();
    staging_.reset();
}

// Whether the two could be exchanged: the earlier output is then in the staging folder, and goes
// with it. Not without one more look: somebody may have put a file in meanwhile.
bool OutputFolder::exchange() {
    struct stat status {};
    const fs::path made = folder();
    const auto turn = [&] {
        return ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, destination_.c_str(),
                           RENAME_EXCHANGE) == 0;
    };
    if (::lstat(destination_.c_str(), &status) != 0 ||
        ::chmod(made.c_str(), status.st_mode & 07777) != 0 || !turn())
        return false;
    try {
        check_replaceable(made, kind_);
    } catch (const Error&) {
        if (turn()) check_replaceable(destination_, kind_);
        throw;
    }
    return true;
}

void OutputFolder::remove_parents() noexcept {
    for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent)
        ::rmdir(parent->c_str());
    made_parents_.clear();
}

OutputFolder::~OutputFolder() {
    staging_.reset();
    remove_parents();
}

}  // namespace topple::io
