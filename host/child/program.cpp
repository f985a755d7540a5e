// SPDX-License-Identifier: MIT
#include "child/program.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

#include "topple/error.h"

namespace topple::child {
namespace {

namespace fs = std::filesystem;

bool can_be_run(const fs::path& file) {
    std::error_code error;
    return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

// Of the library that holds this code, and of the program that runs.
std::vector<fs::path> own_folders() {
    std::vector<fs::path> folders;
    std::error_code error;
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void*>(&find_program), &info) != 0 && info.dli_fname) {
        // Of a program this is the name that it was called by, in whatever folder.
        const fs::path file(info.dli_fname);
        if (file.is_absolute()) folders.push_back(fs::weakly_canonical(file, error).parent_path());
    }
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (!error) folders.push_back(program.parent_path());
    return folders;
}

}  // namespace

fs::path find_program(const char* name) {
    if (const char* folder = ::secure_getenv("TOPPLE_READERS"); folder && *folder) {
        const fs::path file = fs::absolute(folder) / name;
        if (can_be_run(file)) return file;
        throw Error(ErrorKind::usage,
                    "TOPPLE_READERS=" + std::string(folder) + ": there is no program " + name +
                        " in it; give the folder where topple-reader lies, or unset it");
    }
    for (const fs::path& folder : own_folders()) {
        for (const char* from : {"", TOPPLE_LIBEXEC_FROM_BIN, TOPPLE_LIBEXEC_FROM_LIB}) {
            const fs::path file = (folder / from / name).lexically_normal();
            if (can_be_run(file)) return file;
        }
    }
    const fs::path installed = fs::path(TOPPLE_LIBEXEC) / name;
    return can_be_run(installed) ? installed : fs::path();
}

}  // namespace topple::child
