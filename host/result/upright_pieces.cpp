// SPDX-License-Identifier: MIT
#include "result/upright_pieces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "fitted/boosted_trees.h"
#include "io/text.h"
#include "objects/object_boxes.h"

namespace topple {
namespace {

// What is likelier the room's is taken to be.
constexpr double sure = 0.9;
// Of furniture that matters where it falls; thinner is a panel, longer a wall or a row of units.
constexpr double lowest_m = 0.4, thinnest_m = 0.12, longest_m = 2;
constexpr std::size_t listed = 3;

double two_decimals(double value) {
    return std::round(100 * value) / 100 + 0.0;
}

bool is_upright(const ObjectBox& box) {
    const auto [depth, width] = std::minmax(box.size_m[0], box.size_m[1]);
    return box.size_m[2] >= lowest_m && depth >= thinnest_m && width <= longest_m;
}

bool lies_within(const ObjectBox& a, const ObjectBox& b, double slack_m) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (std::abs(a.middle_m[axis] - b.middle_m[axis]) + a.size_m[axis] / 2 >
            b.size_m[axis] / 2 + slack_m)
            return false;
    return true;
}

// By primitive, whether it touches a floor.
std::vector<bool> on_floor(const SolidParts& parts, const ObjectStage& objects) {
    std::vector<bool> out(objects.object_of_primitive.size(), false);
    for (const physics::TouchingPair& pair : objects.contacts.pairs) {
        if (parts.solids->role(pair.a) == Role::floor) out[pair.b] = true;
        if (parts.solids->role(pair.b) == Role::floor) out[pair.a] = true;
    }
    return out;
}

// Numbers of the building's primitives that may be things that stand; -1 for all others.
std::vector<std::int32_t> doubtful(const SolidParts& parts, const ObjectStage& objects) {
    const std::vector<bool> stands = on_floor(parts, objects);
    std::vector<std::int32_t> out;
    std::int32_t next = 0;
    for (std::size_t p = 0; p < objects.object_of_primitive.size(); ++p) {
        const auto o = static_cast<std::size_t>(objects.object_of_primitive[p]);
        const Role role = parts.solids->role(static_cast<std::int32_t>(p));
        const bool doubted = stands[p] && objects.objects[o].grounded &&
                             parts.shell_log_odds[p] < fitted::log_odds(sure) &&
                             (role == Role::none || role == Role::fixture);
        out.push_back(doubted ? next++ : -1);
    }
    return out;
}

// The largest first, without what lies within a larger one.
std::vector<ObjectBox> upright_boxes(const SolidParts& parts, const ObjectStage& objects) {
    const std::vector<std::int32_t> number = doubtful(parts, objects);
    const auto count = std::ranges::count_if(number, [](std::int32_t n) { return n >= 0; });
    std::vector<ObjectBox> all, out;
    if (count > 0) all = object_boxes(*parts.solids, number, static_cast<std::size_t>(count));
    std::erase_if(all, std::not_fn(is_upright));
    std::ranges::stable_sort(all, std::greater{}, [](const ObjectBox& b) {
        return b.size_m[0] * b.size_m[1] * b.size_m[2];
    });
    for (const ObjectBox& box : all)
        if (std::ranges::none_of(out, [&](const ObjectBox& larger) {
                return lies_within(box, larger, 2 * parts.solids->voxel_m());
            }))
            out.push_back(box);
    return out;
}

}  // namespace

std::string upright_pieces_note(const SolidParts& parts, const ObjectStage& objects,
                                const ToInput& to_input) {
    // What somebody said of the building is known.
    if (std::ranges::any_of(objects.told.corrections, [](const AppliedCorrection& c) {
            return c.held && c.correction.kind == Correction::Kind::fixed;
        }))
        return {};
    const std::vector<ObjectBox> boxes = upright_boxes(parts, objects);
    if (boxes.empty()) return {};
    const bool one = boxes.size() == 1;
    std::string text = "The building holds " + io::counted(boxes.size(), "upright piece") +
                       " that may be " + (one ? "a thing" : "things") + ", and then can fall: ";
    for (std::size_t n = 0; n < std::min(listed, boxes.size()); ++n) {
        const ObjectBox& box = boxes[n];
        Vec3 top = to_input.place({box.middle_m[0], box.middle_m[1], box.top_m()});
        Vec3 size = box.size_m;
        for (double& v : top) v = two_decimals(v);
        for (double& v : size) v = two_decimals(v);
        text += (n ? "; " : "") + short_number(size[0]) + " x " + short_number(size[1]) + " x " +
                short_number(size[2]) + " m, top at " + io::vector_text(top);
    }
    if (boxes.size() > listed) text += "; and smaller ones";
    return text +
           ". Of what is one, say `apart` in corrections (--corrections), with a spot on it "
           "and one on the floor.";
}

}  // namespace topple
