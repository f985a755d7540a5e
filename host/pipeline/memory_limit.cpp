// SPDX-License-Identifier: MIT
#include "pipeline/memory_limit.h"

#include "io/text.h"
#include "topple/error.h"

namespace topple {

void check_memory(const std::string& what, std::uint64_t need_bytes, const ParseOptions& options,
                  const std::string& mend) {
    const std::uint64_t limit = options.max_memory_bytes;
    if (limit == 0 || need_bytes <= limit) return;
    const std::string need = io::sufficient_bytes_text(need_bytes);
    std::string given = io::bytes_text(limit);
    // More digits, where three say the same of both.
    for (int digits = 4; given == need && digits < 12; ++digits)
        given = io::bytes_text(limit, digits);
    throw Error(ErrorKind::input, what + " " + need + ", more than the " + given +
                                      " of ParseOptions::max_memory_bytes: allow that much, or " +
                                      mend);
}

}  // namespace topple
