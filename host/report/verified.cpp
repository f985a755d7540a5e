// SPDX-License-Identifier: MIT
#include "report/verified.h"

#include <string_view>

#include "io/replace_file.h"
#include "io/text.h"
#include "report/embedded.h"

namespace topple::report {

bool add_verification(const std::filesystem::path& report, const std::string& json) {
    constexpr std::string_view begin = "<script type=\"application/json\" id=\"verified\">";
    constexpr std::string_view end = "</script>";
    const io::FileBytes bytes =
        io::read_file(io::FileName::beside(report, report.filename()), std::uint64_t{256} << 20);
    const std::string_view page = bytes.text();
    // In what is embedded before it no < begins anything: the first is the page's own.
    const std::size_t at = page.find(begin);
    if (at == page.npos) return false;
    const std::size_t from = at + begin.size(), to = page.find(end, from);
    if (to == page.npos) return false;
    std::string out;
    out.reserve(page.size() + json.size());
    out.append(page.substr(0, from)).append(script_safe(json)).append(page.substr(to));
    io::replace_file(report, out);
    return true;
}

}  // namespace topple::report
