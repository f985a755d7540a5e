// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "io/open_file.h"

namespace topple::tiles {

// Keeps other processes, on this machine and on others that see the folder, from working in it.
// The system lets go of it when the process ends, however it ends.
class FolderLock {
  public:
    // Throws Error(input) that names the process which has the lock, or why there can be none.
    explicit FolderLock(const std::filesystem::path& folder);

    static constexpr const char* file_name = "topple-lock";

  private:
    io::Descriptor descriptor_;
};

}  // namespace topple::tiles
