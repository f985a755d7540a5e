// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/staging_folder.h"
#include "scale/folder_lock.h"

namespace topple::tiles {

// Where a cloud larger than memory is worked on. What a killed run has finished there is taken up
// again by the next one with the same manifest, but for what is damaged; with another manifest it
// is removed first. One process works there at a time, and nobody but its user can look in.
class WorkFolder {
  public:
    // `folder`: empty for one in the system's place for temporary files, which nobody takes up
    // again. `manifest`: one line that names the input and all that what is in the folder depends
    // on. poll: called now and then. Throws Error(input) where the folder can't be made, is at work
    // under another process, is another user's or a link, or holds files that are not topple's:
    // these stay as they are.
    WorkFolder(
        const std::filesystem::path& folder, const std::string& manifest,
        const std::function<void()>& poll = [] {});
    // Removes the folder if it is temporary or finished() was called.
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }
    bool has(const std::string& file) const;
    bool taken_up() const { return taken_up_; }  // an earlier run's
    // Of an earlier run's files those that were damaged, and are to be made anew.
    const std::vector<std::string>& damaged() const { return damaged_; }
    void finished() { remove_ = true; }

  private:
    void make(const std::filesystem::path& folder);
    void take_up(const std::string& text, const std::function<void()>& poll);
    void remove_all() noexcept;
    void remove_empty();  // the folder, and what was made to hold it

    std::filesystem::path folder_;
    std::optional<io::StagingFolder> temporary_;
    std::optional<FolderLock> lock_;
    std::vector<std::string> damaged_;
    int parents_ = 0;  // how many folders above it were made
    bool remove_ = false, taken_up_ = false;
};

// Whether this is a work folder with that manifest.
bool is_work_folder(const std::filesystem::path& folder, const std::string& manifest);

}  // namespace topple::tiles
