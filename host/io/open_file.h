// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/descriptor.h"
#include "io/text.h"

// The one way in which files of others are opened.
namespace topple::io {

using topple::Descriptor;

// A file's name, by whose word it is taken. What the user names is taken as it stands, links and
// all. What a scan names, or a folder of one, is looked for in that folder only: links that lead
// out of it are refused, as are "..", and names from the root on.
class FileName {
  public:
    FileName(std::filesystem::path named_by_user) : path_(std::move(named_by_user)) {}
    static FileName in(const std::filesystem::path& folder, const std::filesystem::path& name);
    // In the folder in which `file` lies. That folder is not the scan's, so that not even a link
    // within it is followed.
    static FileName beside(const std::filesystem::path& file, const std::filesystem::path& name);

    const std::filesystem::path& path() const { return path_; }
    // Whether anything has that name, be it a link that leads nowhere.
    bool is_there() const;

    // As open(2); -1, with errno, where it can't be. The root of what a scan names is looked up
    // anew each time.
    int open(int flags) const;

  private:
    std::filesystem::path path_, root_, name_;  // root_ empty: named by the user
    bool may_be_link_ = true;
};

// A regular file, open for reading: what is asked of it from here on is asked of the descriptor,
// whatever has its name by then. Never waits: FIFOs and devices are refused. Throws Error(input).
struct OpenFile {
    explicit OpenFile(const FileName& file);
    // Up to `bytes`, fewer only at the end. Throws Error(input).
    std::size_t read(char* into, std::size_t bytes) const;

    FileName name;
    Descriptor descriptor;
    std::uint64_t size = 0;
};

// As the one of text.h.
FileBytes read_file(const FileName& file, std::uint64_t limit = UINT64_MAX);

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

// The names in a folder but "." and "..", in no order; `error` says why it can't be listed. Unlike
// std::filesystem::directory_iterator, which ends the program, it throws std::bad_alloc.
std::vector<std::string> folder_names(const FileName& folder, std::error_code& error);

// openat() below `folder`, which stays beneath it; for kernels without openat2() and for tests the
// second, which follows no link at all. errno is EXDEV where a link or name leads out, ELOOP where
// there is a link that may not be followed.
int open_beneath(int folder, const std::filesystem::path& name, int flags, bool links = true);
int open_stepwise(int folder, const std::filesystem::path& name, int flags);

// Why a file can't be opened, after errno: "can't be read: Permission denied", or what is wrong
// with a link.
std::string why_not_opened(int error);

}  // namespace topple::io
