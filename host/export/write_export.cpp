// SPDX-License-Identifier: MIT
#include "export/write_export.h"

#include <string>
#include <system_error>

#include "io/replace_file.h"
#include "io/text.h"

namespace topple::exports {

void check_export_file(const std::filesystem::path& file) {
    io::check_own_file(file, export_mark);
}

void write_export(const std::filesystem::path& file, std::string_view text) {
    check_export_file(file);
    const std::filesystem::path folder = file.parent_path();
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) io::fail(folder, "can't be made: " + error.message());
    io::replace_file(file, text);
}

}  // namespace topple::exports
