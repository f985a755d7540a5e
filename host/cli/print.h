// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>

namespace topple::cli {

// As printf(), but what steers a terminal, or is no UTF-8, is written as \xNN: names of files and
// what stands in them may be a stranger's. Only line feeds of the format or its values stay.
[[gnu::format(printf, 1, 2)]] void print(const char* format, ...);
[[gnu::format(printf, 2, 3)]] void print_to(std::FILE* file, const char* format, ...);

}  // namespace topple::cli
