// SPDX-License-Identifier: MIT
#pragma once

#include <string>

// Text of tables. For this folder.
namespace topple::evaluation {

// Up to 255 characters, as printf does.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...);

// A share in percent, or a dash for none.
std::string percent(double share);

}  // namespace topple::evaluation
