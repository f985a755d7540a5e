// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

// The page's parts, embedded at build time by embed_page.py from page/ and from three.js.
namespace topple::report::page {

extern const std::string_view html;  // with @STYLE@, @THREE@, @CONTROLS@, @SCRIPT@, @TITLE@, @DATA@
extern const std::string_view style;
extern const std::string_view script;
extern const std::string_view three;
extern const std::string_view controls;

}  // namespace topple::report::page
