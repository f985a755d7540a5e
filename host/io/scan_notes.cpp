// SPDX-License-Identifier: MIT
#include "io/scan_notes.h"

#include <fstream>
#include <string_view>
#include <system_error>

#include "io/text.h"

namespace topple::io {
namespace {

constexpr std::size_t most_notes = 50, longest_note = 1000;

std::filesystem::path notes_file(const std::filesystem::path& scan) {
    constexpr const char* name = "topple-notes.txt";
    std::error_code error;
    if (std::filesystem::is_directory(scan, error)) return scan / name;
    return scan.string() + "." + name;
}

}  // namespace

std::vector<std::string> scan_notes(const std::filesystem::path& scan) {
    const std::filesystem::path file = notes_file(scan);
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return {};
    std::ifstream in(file, std::ios::binary);
    // No more than can be taken is read, however large it is.
    std::string text(most_notes * (longest_note + 2), '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!in && !in.eof()) fail(file, "can't be read; delete it, if it isn't needed");
    text.resize(static_cast<std::size_t>(in.gcount()));
    bool whole = in.eof();
    std::vector<std::string> out;
    Lines lines(text);
    for (std::string_view line; lines.next(line);) {
        if (line.empty()) continue;
        if (out.size() == most_notes) {
            whole = false;
            break;
        }
        whole = whole && line.size() <= longest_note;
        out.push_back(printable(line, longest_note));
    }
    if (!whole) out.push_back("More than that in " + path_text(file) + " was left out.");
    return out;
}

}  // namespace topple::io
