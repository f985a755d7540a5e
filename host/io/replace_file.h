// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/staging_folder.h"

namespace topple::io {

// A file that is there whole or not at all: it is written at path(), in a staging folder beside its
// place, and commit() renames it. An earlier file of that name is there until then. Throws
// Error(input) where something else than a regular file has the name: a link is never written
// through, nor replaced, and a folder never moved.
class PendingFile {
  public:
    explicit PendingFile(const std::filesystem::path& file);
    std::filesystem::path path() const { return staging_.path() / file_.filename(); }
    void commit();

  private:
    std::filesystem::path file_;
    StagingFolder staging_;
};

// Writes a whole text so.
void replace_file(const std::filesystem::path& file, std::string_view text);

// Throws Error(input) where what has that name is no regular file: where it can't be replaced.
void check_replaceable_file(const std::filesystem::path& file);

// The first bytes of a regular file; empty where there is none, where it can't be read, and of a
// link.
std::string beginning_of(const std::filesystem::path& file, std::size_t bytes);

// Throws Error(input) where there is a file of that name whose first kilobyte does not hold `mark`:
// it is another program's. Of an empty one nothing is lost.
void check_own_file(const std::filesystem::path& file, std::string_view mark,
                    const char* what = "is no export of topple; choose another folder");

}  // namespace topple::io
