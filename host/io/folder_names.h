// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <system_error>
#include <vector>

#include "io/open_file.h"

namespace topple::io {

// The names in a folder but "." and "..", in no order; `error` says why it can't be listed. Unlike
// std::filesystem::directory_iterator, which ends the program, it throws std::bad_alloc.
std::vector<std::string> folder_names(const FileName& folder, std::error_code& error);

}  // namespace topple::io
