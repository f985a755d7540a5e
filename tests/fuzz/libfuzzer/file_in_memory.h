// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::fuzz {

// Has topple's own open(), fstat(), read(), mmap() and close(), which the linker leads here, find
// these bytes as a regular file of that name: making, opening and cutting a real one takes a third
// of the time of a short input. Both arguments must outlive the reading.
void show_file(const char* path, std::string_view bytes);

}  // namespace topple::fuzz
