// SPDX-License-Identifier: MIT
#include "core/object_name.h"

#include <string>

namespace topple {
namespace {

// Bytes of letters outside of ASCII are at 0x80 and above.
bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
}

}  // namespace

bool name_has(std::string_view name, std::string_view words) {
    std::string small(name);
    for (char& c : small)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    for (std::size_t at = small.find(words); at != std::string::npos;
         at = small.find(words, at + 1)) {
        std::size_t end = at + words.size();
        if (end < small.size() && small[end] == 's') ++end;
        if ((at == 0 || !is_letter(small[at - 1])) &&
            (end == small.size() || !is_letter(small[end])))
            return true;
    }
    return false;
}

}  // namespace topple
