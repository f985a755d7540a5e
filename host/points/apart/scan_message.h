// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "child/message.h"
#include "core/space_map.h"
#include "topple/error.h"

namespace topple::reader {

// A scan, or the error in its place, as a child's answer.
void write_scan(const ScannedMap& map, int descriptor = child::answer_descriptor);
void write_error(const Error& error, int descriptor = child::answer_descriptor);

// What a child answered. Throws the Error that it sent, and child::BadAnswer where the answer is
// none of a scan: counts that differ, coordinates or normals out of range, boxes inside out.
ScannedMap take_scan(const child::Answer& answer);

// In a child: the scan that `read` makes of the task's file, or why it can't, is the answer.
// unit: as unit_text() writes it.
void answer_scan(const std::string& unit, const std::filesystem::path& file,
                 const std::function<ScannedMap(const std::filesystem::path&, double)>& read);

// Exact: the child gets the same bits.
std::string unit_text(double unit_m);

}  // namespace topple::reader
