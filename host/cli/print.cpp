// SPDX-License-Identifier: MIT
#include "cli/print.h"

#include <cstdarg>
#include <string>
#include <string_view>

#include "core/printable.h"

namespace topple::cli {
namespace {

void print_list(std::FILE* file, const char* format, std::va_list values) {
    std::va_list again;
    va_copy(again, values);
    const int length = std::vsnprintf(nullptr, 0, format, again);
    va_end(again);
    if (length < 0) return;
    std::string text(static_cast<std::size_t>(length), '\0');
    std::vsnprintf(text.data(), text.size() + 1, format, values);
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t end = rest.find('\n');
        const std::string line = printable(rest.substr(0, end), std::string::npos);
        std::fwrite(line.data(), 1, line.size(), file);
        if (end == std::string_view::npos) return;
        std::fputc('\n', file);
        rest.remove_prefix(end + 1);
    }
}

}  // namespace

void print(const char* format, ...) {
    std::va_list values;
    va_start(values, format);
    print_list(stdout, format, values);
    va_end(values);
}

void print_to(std::FILE* file, const char* format, ...) {
    std::va_list values;
    va_start(values, format);
    print_list(file, format, values);
    va_end(values);
}

}  // namespace topple::cli
