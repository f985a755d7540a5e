// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace topple::tiles {

// Where a cloud larger than memory is worked on. What a killed run has finished there is taken up
// again by the next one with the same manifest; with another one it is removed first.
class WorkFolder {
  public:
    // `folder`: empty for one in the system's place for temporary files, which nobody takes up
    // again. `manifest`: one line that names the input and all that what is in the folder depends
    // on. Throws Error(input) where the folder can't be made or holds files that are not ours.
    WorkFolder(const std::filesystem::path& folder, const std::string& manifest);
    // Removes the folder if it is temporary or finished() was called.
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }
    bool has(const std::string& file) const;
    bool taken_up() const { return taken_up_; }  // an earlier run's
    void finished() { remove_ = true; }

  private:
    std::filesystem::path folder_;
    bool remove_ = false, taken_up_ = false;
};

// Whether this is a work folder with that manifest.
bool is_work_folder(const std::filesystem::path& folder, const std::string& manifest);

// The names of the files in a folder. Unlike asking for a name, this leaves no trace in a network
// file system's memory of what is missing, which would hide what another machine makes next.
std::set<std::string> names_in(const std::filesystem::path& folder);

}  // namespace topple::tiles
