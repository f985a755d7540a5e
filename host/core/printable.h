// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace topple {

// `text` with what steers terminals (control and format characters), and what is no UTF-8, written
// as \xNN, cut after `most` bytes.
std::string printable(std::string_view text, std::size_t most = 60);

}  // namespace topple
