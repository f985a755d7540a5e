// SPDX-License-Identifier: MIT
#include "child/environment.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace topple::child {

std::vector<std::string> plain_environment() {
    constexpr std::array<std::string_view, 3> names{"LD_LIBRARY_PATH", "LANG", "TZ"};
    std::vector<std::string> out;
    for (char** each = environ; each && *each; ++each) {
        const std::string_view variable(*each), name = variable.substr(0, variable.find('='));
        if (std::ranges::find(names, name) != names.end() || name.starts_with("LC_") ||
            name.ends_with("SAN_OPTIONS"))  // of sanitizers
            out.emplace_back(variable);
    }
    return out;
}

std::string found_in_path(const std::string& name) {
    const char* const path = std::getenv("PATH");
    for (std::string_view left = path ? path : ""; !left.empty();) {
        const std::string_view folder = left.substr(0, left.find(':'));
        left.remove_prefix(std::min(left.size(), folder.size() + 1));
        const std::string file = std::string(folder) + "/" + name;
        if (folder.starts_with('/') && ::access(file.c_str(), X_OK) == 0) return file;
    }
    return "";
}

}  // namespace topple::child
