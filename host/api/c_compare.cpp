// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include "api/c_support.h"
#include "topple/compare.h"

using namespace topple;
using namespace topple::c_api;

struct topple_comparison {
    Alignment alignment;
    std::vector<ComparedThing> things;
};

static_assert(int{TOPPLE_BECAME_SAME} == int(Became::same) &&
              int{TOPPLE_BECAME_MOVED} == int(Became::moved) &&
              int{TOPPLE_BECAME_CAME} == int(Became::came) &&
              int{TOPPLE_BECAME_WENT} == int(Became::went) &&
              int{TOPPLE_BECAME_MERGED} == int(Became::merged) &&
              int{TOPPLE_BECAME_UNSEEN} == int(Became::unseen));

int topple_compare(const char* a, const char* b, topple_comparison** comparison, uint64_t* things,
                   topple_status* status) {
    return guarded(status, [&] {
        needed(comparison, "comparison") = nullptr;
        needed(a, "a");
        needed(b, "b");
        Comparison found = compare(a, b);
        if (things) *things = found.things.size();
        *comparison = new topple_comparison{found.alignment, std::move(found.things)};
    });
}

void topple_comparison_release(topple_comparison* comparison) {
    delete comparison;
}

int topple_comparison_alignment(const topple_comparison* comparison, topple_alignment* alignment,
                                topple_status* status) {
    return guarded(status, [&] {
        const Alignment& from = needed(comparison, "comparison").alignment;
        topple_alignment out{};
        std::copy(from.a_from_b.begin(), from.a_from_b.end(), out.a_from_b);
        out.same_frame = from.same_frame;
        out.seen = from.seen;
        out.agreeing = from.agreeing;
        out.next_agreeing = from.next_agreeing;
        out.error_m = from.error_m;
        give(out, alignment, "alignment");
    });
}

int topple_comparison_thing(const topple_comparison* comparison, uint64_t index,
                            topple_compared_thing* thing, topple_status* status) {
    return guarded(status, [&] {
        const ComparedThing& from = item(needed(comparison, "comparison").things, index, "thing");
        topple_compared_thing out{};
        out.a = from.a;
        out.b = from.b;
        out.became = static_cast<std::int32_t>(from.became);
        out.less_safe = from.less_safe;
        out.safer = from.safer;
        out.stands_otherwise = from.stands_otherwise;
        out.moved_m = from.moved_m;
        out.free = from.free;
        out.solid = from.solid;
        give(out, thing, "thing");
    });
}
