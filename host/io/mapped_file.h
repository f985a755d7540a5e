// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

#include "io/open_file.h"

namespace topple::io {

// A regular file's bytes, mapped and not held: for files larger than memory that are read once from
// front to back. Throws Error(input) where the file is missing, no regular file, unreadable or
// empty. Nobody may shorten the file meanwhile: reading beyond its end is a bus error.
class MappedFile {
  public:
    explicit MappedFile(const FileName& name);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::string_view text() const { return {data_, size_}; }
    // Gives back the memory of what was read so far; what is read again is mapped again.
    void release() const;

  private:
    const char* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace topple::io
