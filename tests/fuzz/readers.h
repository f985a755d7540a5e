// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>

// The readers of host/io, by what they are fed with.
namespace topple::fuzz {

struct Reader {
    const char* name;  // of its folder in corpus/
    const char* file;  // the name that the input gets: extensions choose readers
    void (*read)(const std::filesystem::path& file);
};

std::span<const Reader> readers();

// Has a reader read a file. It may return, or throw Error(input) of one printable line; what else
// happens is returned in words. Empty: nothing did.
std::string try_file(const Reader& reader, const std::filesystem::path& file);
// The same for these bytes, which become a file in that folder.
std::string try_input(const Reader& reader, const std::filesystem::path& folder,
                      std::string_view bytes);

}  // namespace topple::fuzz
