// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

// The readers of files, by what they are fed with.
namespace topple::fuzz {

struct Reader {
    const char* name;  // of its folder in corpus/
    const char* file;  // the name that the input gets: extensions choose readers
    void (*read)(const std::filesystem::path& file);
    // What the file holds for an input; none: the input itself.
    std::string (*made)(std::string_view input) = nullptr;
    // Puts files beside it that it names; none: there are none.
    void (*put_beside)(const std::filesystem::path& folder) = nullptr;
};

// Of inputs, and of what topple wrote itself (own_files.h).
std::vector<Reader> readers();

// Has a reader read a file. It may return, or throw Error(input) of one printable line; what else
// happens is returned in words. Empty: nothing did.
std::string try_file(const Reader& reader, const std::filesystem::path& file);
// The same for an input, of which a file in that folder is made.
std::string try_input(const Reader& reader, const std::filesystem::path& folder,
                      std::string_view bytes);

}  // namespace topple::fuzz
