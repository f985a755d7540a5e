// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace topple::report {

// Puts what a simulator made of the scene, a verify.json, into a report that is there, in the place
// that the page keeps for it; an earlier one is replaced. False where the page has no such place:
// an older topple wrote it. Throws Error(input) where it can't be read or written.
bool add_verification(const std::filesystem::path& report, const std::string& json);

}  // namespace topple::report
