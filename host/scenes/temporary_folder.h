// SPDX-License-Identifier: MIT
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "topple/error.h"

namespace topple::scenes {

// A new folder in the system's place for temporary files that goes away with its owner. Throws
// Error(input) where it can't be made.
class TemporaryFolder {
  public:
    explicit TemporaryFolder(const std::string& prefix) {
        std::string name = std::filesystem::temp_directory_path() / (prefix + "_XXXXXX");
        if (!::mkdtemp(name.data())) throw Error(ErrorKind::input, name + ": can't be made");
        path_ = name;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace topple::scenes
