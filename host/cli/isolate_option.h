// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

namespace topple::cli {

// --no-isolate, which clears `isolate`.
inline void add_isolate_option(CLI::App& app, bool& isolate) {
    app.add_flag_function(
        "--no-isolate", [&isolate](std::int64_t) { isolate = false; },
        "Read meshes, OctoMaps and OpenVDB files in this process, not in one of its own with\n"
        "limits of memory and time: for large files that you trust");
}

}  // namespace topple::cli
