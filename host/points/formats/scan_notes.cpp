// SPDX-License-Identifier: MIT
#include "points/formats/scan_notes.h"

#include <string_view>
#include <system_error>

#include "io/open_file.h"
#include "io/text.h"

namespace topple::io {
namespace {

constexpr std::size_t most_notes = 50, longest_note = 1000;

FileName notes_file(const std::filesystem::path& scan) {
    constexpr const char* name = "topple-notes.txt";
    std::error_code error;
    if (std::filesystem::is_directory(scan, error)) return FileName::in(scan, name);
    return FileName::beside(scan, scan.filename().string() + "." + name);
}

}  // namespace

std::vector<std::string> scan_notes(const std::filesystem::path& scan) {
    const FileName name = notes_file(scan);
    const std::filesystem::path& file = name.path();
    std::error_code error;
    if (!name.is_there() ||
        std::filesystem::is_directory(std::filesystem::symlink_status(file, error)))
        return {};
    const OpenFile open(name);
    // No more than can be taken is read, however large it is.
    std::string text(most_notes * (longest_note + 2), '\0');
    text.resize(open.read(text.data(), text.size()));
    bool whole = text.size() == open.size;
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
