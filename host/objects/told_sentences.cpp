// SPDX-License-Identifier: MIT
#include "objects/told_sentences.h"

namespace topple {
namespace {

bool goes_on(const Correction& before, const Correction& c) {
    using Kind = Correction::Kind;
    if (c.was.empty() || c.was != before.was) return false;
    if (c.kind != before.kind) return before.kind == Kind::one_thing && c.kind == Kind::apart;
    return c.wall_m == before.wall_m && c.mass_kg == before.mass_kg &&
           c.coefficient == before.coefficient && c.name == before.name &&
           (c.at_m != before.at_m || c.from_m != before.from_m);
}

}  // namespace

std::vector<std::size_t> told_sentences(std::span<const AppliedCorrection> corrections) {
    std::vector<std::size_t> out;
    for (std::size_t n = 0; n < corrections.size(); ++n) {
        const bool more =
            n > 0 && goes_on(corrections[n - 1].correction, corrections[n].correction);
        out.push_back(n == 0 ? 1 : out.back() + (more ? 0 : 1));
    }
    return out;
}

}  // namespace topple
