// SPDX-License-Identifier: MIT
#include "topple/compare.h"

#include <utility>

#include "compare/align.h"
#include "compare/matching.h"
#include "compare/side.h"
#include "topple/error.h"

namespace topple {

Comparison compare(const std::filesystem::path& a, const std::filesystem::path& b,
                   const CompareOptions& options) {
    const auto poll = [&] {
        if (options.cancelled && options.cancelled())
            throw Error(ErrorKind::cancelled, "cancelled");
    };
    comparing::Side of_a = comparing::read_side(a, poll), of_b = comparing::read_side(b, poll);
    Comparison out;
    out.alignment = comparing::align(of_a, of_b, poll);
    out.things = comparing::match_things(of_a, of_b, out.alignment.a_from_b);
    out.a = std::move(of_a.scene);
    out.b = std::move(of_b.scene);
    return out;
}

}  // namespace topple
