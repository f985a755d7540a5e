// SPDX-License-Identifier: MIT
#include "io/folder_names.h"

#include <dirent.h>
#include <fcntl.h>

#include <cerrno>
#include <memory>

namespace topple::io {

std::vector<std::string> folder_names(const FileName& folder, std::error_code& error) {
    error.clear();
    const auto close = [](DIR* open) { ::closedir(open); };
    Descriptor descriptor(folder.open(O_RDONLY | O_DIRECTORY));
    const std::unique_ptr<DIR, decltype(close)> open(
        descriptor.get() < 0 ? nullptr : ::fdopendir(descriptor.get()), close);
    std::vector<std::string> names;
    if (!open) {
        error.assign(errno, std::generic_category());
        return names;
    }
    descriptor.release();  // the listing closes it
    for (;;) {
        errno = 0;
        const dirent* entry = ::readdir(open.get());
        if (!entry) break;
        std::string name = entry->d_name;
        if (name != "." && name != "..") names.push_back(std::move(name));
    }
    if (errno != 0) error.assign(errno, std::generic_category());
    return names;
}

}  // namespace topple::io
