// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace topple::report {

// RFC 4648, with padding.
std::string base64(const void* bytes, std::size_t count);

}  // namespace topple::report
