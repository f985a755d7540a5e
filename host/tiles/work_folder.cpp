// SPDX-License-Identifier: MIT
#include "tiles/work_folder.h"

#include <stdlib.h>

#include <system_error>

#include "io/file_writer.h"
#include "io/text.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

constexpr const char* manifest_file = "topple-work";
constexpr const char* first_line = "topple.work/1\n";

std::string manifest_text(const std::string& manifest) {
    return first_line + manifest + "\n";
}

// The manifest of what is there; empty where there is none.
std::string manifest_of(const fs::path& folder) {
    std::error_code error;
    if (!fs::exists(folder / manifest_file, error)) return {};
    return std::string(io::read_file(folder / manifest_file, 1u << 20).text());
}

fs::path temporary_folder() {
    std::error_code error;
    fs::path pattern = fs::temp_directory_path(error);
    if (error) pattern = "/tmp";
    std::string name = pattern / "topple-XXXXXX";
    if (!::mkdtemp(name.data())) io::fail(pattern, "no folder can be made there");
    return name;
}

}  // namespace

WorkFolder::WorkFolder(const fs::path& folder, const std::string& manifest) {
    const std::string text = manifest_text(manifest);
    if (folder.empty()) {
        folder_ = temporary_folder();
        remove_ = true;
    } else {
        folder_ = folder;
        std::error_code error;
        fs::create_directories(folder_, error);
        if (error) io::fail(folder_, "can't be made: " + error.message());
        const std::string found = manifest_of(folder_);
        taken_up_ = found == text;
        if (!taken_up_ && !fs::is_empty(folder_, error)) {
            if (!found.starts_with(first_line))
                io::fail(folder_,
                         "holds files that are not topple's; it is needed to work in: move "
                         "them, or choose another output folder");
            for (const auto& entry : fs::directory_iterator(folder_, error))
                fs::remove(entry.path(), error);
        }
    }
    if (!taken_up_) io::write_file(folder_ / manifest_file, text);
}

WorkFolder::~WorkFolder() {
    if (!remove_) return;
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

bool WorkFolder::has(const std::string& file) const {
    std::error_code error;
    return fs::exists(folder_ / file, error);
}

bool is_work_folder(const fs::path& folder, const std::string& manifest) {
    return manifest_of(folder) == manifest_text(manifest);
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        names.insert(at->path().filename().string());
    if (error) io::fail(folder, "can't be read: " + error.message());
    return names;
}

}  // namespace topple::tiles
