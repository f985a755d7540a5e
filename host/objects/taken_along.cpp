// SPDX-License-Identifier: MIT
#include "objects/taken_along.h"

#include <algorithm>
#include <cstddef>

#include "core/table.h"

namespace topple {
namespace {

using Holders = Table<ObjectId, std::vector<Support>>;

// Of two pieces that carry each other the lighter one is no support of the heavier.
bool carried_back(TableView<ObjectId, Body> objects, const Holders& holders, const Support& s) {
    const ObjectId by = s.supporter, on = s.supported;
    if (objects[by].grounded ||
        objects[by].candidate.body.mass_kg >= objects[on].candidate.body.mass_kg)
        return false;
    return std::ranges::any_of(holders[by],
                               [&](const Support& back) { return back.supporter == s.supported; });
}

std::vector<std::int32_t> along_with(TableView<ObjectId, Body> objects, const Holders& holders,
                                     std::size_t o) {
    Table<ObjectId, bool> gone(objects.size());
    gone[o] = true;
    for (bool more = true; more;) {
        more = false;
        for (std::size_t x = 0; x < holders.size(); ++x) {
            if (gone[x] || objects[x].grounded) continue;
            double all = 0, lost = 0;
            for (const Support& s : holders[x]) {
                if (carried_back(objects, holders, s)) continue;
                all += s.area_m2;
                if (gone[s.supporter]) lost += s.area_m2;
            }
            if (lost > 0 && 2 * lost >= all) gone[x] = more = true;
        }
    }
    gone[o] = false;
    std::vector<std::int32_t> out;
    for (std::size_t x = 0; x < gone.size(); ++x) {
        if (gone[x]) out.push_back(static_cast<std::int32_t>(x));
    }
    return out;
}

}  // namespace

std::vector<std::vector<std::int32_t>> taken_along(const ObjectStage& stage) {
    Holders holders(stage.objects.size());
    for (const Support& s : stage.supports) holders[s.supported].push_back(s);
    std::vector<std::vector<std::int32_t>> out(stage.objects.size());
    for (std::size_t o = 0; o < out.size(); ++o)
        if (!stage.objects[o].grounded) out[o] = along_with(stage.objects, holders, o);
    return out;
}

}  // namespace topple
