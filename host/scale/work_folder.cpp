// SPDX-License-Identifier: MIT
#include "scale/work_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <string_view>
#include <system_error>

#include "io/file_writer.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "scale/work_files.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "topple.work/2\n";
constexpr std::uint64_t longest_manifest = 1u << 20;

std::string manifest_text(const std::string& manifest) {
    return std::string(first_line) + manifest + "\n";
}

// The manifest of what is there; empty where there is none that can be read.
std::string manifest_of(const fs::path& folder) {
    std::error_code error;
    if (!fs::exists(folder / manifest_name, error)) return {};
    try {
        return std::string(io::read_file(folder / manifest_name, longest_manifest).text());
    } catch (const Error&) {  // empty, as a full disk leaves it
        return {};
    }
}

constexpr const char* other_place =
    "; it is needed to work in: move that away, or choose another output folder";

// Throws unless the folder is a real one of this user's own.
void check_own(const fs::path& folder) {
    struct stat status {};
    if (::lstat(folder.c_str(), &status) != 0)
        io::fail(folder, std::string("can't be read: ") + std::strerror(errno));
    if (S_ISLNK(status.st_mode)) io::fail(folder, std::string("is a link") + other_place);
    if (!S_ISDIR(status.st_mode)) io::fail(folder, std::string("is no folder") + other_place);
    if (status.st_uid != ::geteuid())
        io::fail(folder, std::string("belongs to another user") + other_place);
}

// Throws unless all in the folder is what topple makes there: by the names, and where no manifest
// says so by the files' marks, too.
void check_contents(const fs::path& folder) {
    const bool known = manifest_of(folder).starts_with(first_line);
    for (const std::string& name : names_in(folder)) {
        struct stat status {};
        const bool regular = ::lstat((folder / name).c_str(), &status) == 0 &&
                             S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
        const bool marked = known || name == manifest_name || name == FolderLock::file_name;
        if (!is_work_file(name) || !regular || !(marked || has_mark(folder / name)))
            io::fail(folder, "holds " + io::in_quotes(name) +
                                 ", which this version of topple did not write" + other_place);
    }
}

}  // namespace

WorkFolder::WorkFolder(const fs::path& folder, const std::string& manifest,
                       const std::function<void()>& poll) {
    make(folder);
    try {
        io::remove_abandoned(folder_);
        check_contents(folder_);
        if (::chmod(folder_.c_str(), 0700) != 0)  // not before it is known to be topple's
            io::fail(folder_, std::string("can't be kept from others: ") + std::strerror(errno));
        lock_.emplace(folder_);
        take_up(manifest_text(manifest), poll);
    } catch (...) {
        if (remove_ && lock_)
            remove_all();
        else if (remove_)
            remove_empty();  // unless another run has begun there
        throw;
    }
    remove_ = folder.empty();
}

void WorkFolder::make(const fs::path& folder) {
    remove_ = true;  // who makes it removes it, until it is ready to be worked in
    if (folder.empty()) temporary_.emplace(io::StagingFolder::temporary());
    folder_ = temporary_ ? temporary_->path() / "work" : folder;
    std::error_code error;
    for (fs::path p = folder_.parent_path(); !p.empty() && !fs::exists(p, error);
         p = p.parent_path())
        ++parents_;
    if (folder_.has_parent_path()) fs::create_directories(folder_.parent_path(), error);
    if (::mkdir(folder_.c_str(), 0700) == 0) return;
    if (errno != EEXIST) io::fail(folder_, std::string("can't be made: ") + std::strerror(errno));
    remove_ = false;
    check_own(folder_);
}

void WorkFolder::take_up(const std::string& text, const std::function<void()>& poll) {
    taken_up_ = manifest_of(folder_) == text;
    if (taken_up_) {
        damaged_ = remove_damaged(folder_, poll);
        return;
    }
    std::error_code error;
    for (const std::string& name : names_in(folder_)) {
        if (name != FolderLock::file_name) fs::remove(folder_ / name, error);
        if (error) io::fail(folder_ / name, "can't be removed: " + error.message());
    }
    io::replace_file(folder_ / manifest_name, text);  // whole or not at all, too
    io::sync_folder(folder_);
}

WorkFolder::~WorkFolder() {
    if (remove_) remove_all();
}

// What topple did not write there, meanwhile, stays, and the folder with it.
void WorkFolder::remove_all() noexcept {
    try {
        std::error_code error;
        for (const std::string& name : names_in(folder_))
            if (is_work_file(name)) fs::remove(folder_ / name, error);
        remove_empty();
    } catch (const std::exception&) {
        // It stays: the next run takes it up.
    }
}

void WorkFolder::remove_empty() {
    std::error_code error;
    fs::path at = folder_;
    for (int i = 0; i <= parents_ && fs::remove(at, error); ++i) at = at.parent_path();
}

bool WorkFolder::has(const std::string& file) const {
    std::error_code error;
    return fs::exists(folder_ / file, error);
}

bool is_work_folder(const fs::path& folder, const std::string& manifest) {
    return manifest_of(folder) == manifest_text(manifest);
}

}  // namespace topple::tiles
