// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/session.h"

namespace topple::io {

// things.json of docs/output.md. Throws Error(input) where it can't be written.
void write_things_json(const std::filesystem::path& file, const LiveScene& found);

}  // namespace topple::io
