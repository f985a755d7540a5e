// SPDX-License-Identifier: MIT
#include "io/replace_file.h"

#include <fstream>
#include <string>
#include <system_error>

#include "io/file_writer.h"
#include "io/text.h"

namespace topple::io {
namespace fs = std::filesystem;

void replace_file(const fs::path& file, std::string_view text) {
    fs::path fresh = file;
    std::string name = ".";
    name.append(file.filename().string()).append(".topple-tmp");
    fresh.replace_filename(name);
    std::error_code error;
    try {
        write_file(fresh, text);
    } catch (...) {
        fs::remove(fresh, error);
        throw;
    }
    fs::rename(fresh, file, error);
    if (!error) return;
    const std::string why = error.message();
    fs::remove(fresh, error);
    fail(file, "can't be written: " + why);
}

void check_own_file(const fs::path& file, std::string_view mark, const char* what) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(file, error))) return;
    std::string start(1024, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(stream.gcount()));
    if (start.find(mark) == std::string::npos) fail(file, std::string("exists and ").append(what));
}

}  // namespace topple::io
