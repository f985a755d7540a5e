// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace topple::io {

// What whoever made a scan has to say of it, a sentence each: the lines of topple-notes.txt in a
// folder of frames, or of NAME.topple-notes.txt beside a file NAME, where there is one. Programs
// that convert scans write it. UTF-8; of more than 50 lines, and of more than 1000 bytes in one,
// the rest is left out, and the last note says so. Throws Error(input) where it can't be read.
std::vector<std::string> scan_notes(const std::filesystem::path& scan);

}  // namespace topple::io
