// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "io/staging_folder.h"
#include "topple/error.h"

namespace topple::scenes {

// A new folder in the system's place for temporary files that goes away with its owner. Throws
// Error(input) where it can't be made.
class TemporaryFolder {
  public:
    explicit TemporaryFolder(const std::string& name)
        : staging_(io::StagingFolder::temporary()), path_(staging_.path() / name) {
        std::error_code error;
        if (!std::filesystem::create_directory(path_, error))
            throw Error(ErrorKind::input, path_.string() + ": can't be made");
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    io::StagingFolder staging_;
    std::filesystem::path path_;
};

}  // namespace topple::scenes
