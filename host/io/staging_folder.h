// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/open_file.h"

namespace topple::io {

// Where everything is written first: a hidden folder .topple-<random> that only its user can look
// into, in the folder where the result shall be, so that the result gets its place by a rename. It
// goes with this object, and by remove_pending_outputs() where a signal ends the program. Of a
// process that was killed it is removed by the next one made in the same place: it holds a lock,
// which the system lets go of with the process, and a mark that says whose it is.
class StagingFolder {
  public:
    // where: a folder that is there. parents: its innermost folders that go, too, with a signal.
    // Throws Error(input).
    explicit StagingFolder(const std::filesystem::path& where, int parents = 0);
    // In the system's place for temporary files.
    static StagingFolder temporary();
    StagingFolder(StagingFolder&& other) noexcept;
    StagingFolder& operator=(StagingFolder&&) = delete;
    ~StagingFolder();

    const std::filesystem::path& path() const { return path_; }

  private:
    void lock(const std::filesystem::path& file);

    std::filesystem::path path_;
    Descriptor lock_;
    int slot_ = -1;  // in the list of what remove_pending_outputs() removes
};

// Removes what killed processes have left in a folder.
void remove_abandoned(const std::filesystem::path& where);

}  // namespace topple::io
