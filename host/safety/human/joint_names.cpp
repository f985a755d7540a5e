// SPDX-License-Identifier: MIT
#include <algorithm>
#include <initializer_list>

#include "safety/human/motion_formats.h"

namespace topple::io {
namespace {

enum class Side { none, left, right };

struct SidedName {
    Side side = Side::none;
    std::string stem;  // lower-case letters and digits
};

bool take_front(std::string& text, std::string_view part) {
    if (!text.starts_with(part)) return false;
    text.erase(0, part.size());
    return true;
}
bool take_back(std::string& text, std::string_view part) {
    if (!text.ends_with(part)) return false;
    text.erase(text.size() - part.size());
    return true;
}

// "mixamorig:LeftForeArm", "elbow_l" and "R_Elbow" are left forearm, left elbow and right elbow.
SidedName sided(std::string_view name) {
    const auto colon = name.rfind(':');
    if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
    std::string stem, marked;  // `marked` keeps a mark where words were told apart
    for (const char c : name) {
        const bool upper = c >= 'A' && c <= 'Z';
        const bool word = upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (!word) {
            marked += '_';
            continue;
        }
        const char lower = upper ? static_cast<char>(c - 'A' + 'a') : c;
        // "LElbow" is a left elbow, "leg" is none.
        if (upper && stem.size() == 1 && (stem == "l" || stem == "r")) marked += '_';
        marked += lower;
        stem += lower;
    }
    SidedName out{Side::none, stem};
    const auto is = [&](Side side, std::string_view word, std::string_view letter) {
        const std::string front = std::string(letter).append("_");
        const std::string back = std::string("_").append(letter);
        if (take_front(out.stem, word) || take_back(out.stem, word)) {
            out.side = side;
        } else if (marked.starts_with(front)) {
            out.stem.erase(0, 1);
            out.side = side;
        } else if (marked.ends_with(back)) {
            out.stem.pop_back();
            out.side = side;
        }
    };
    is(Side::left, "left", "l");
    if (out.side == Side::none) is(Side::right, "right", "r");
    return out;
}

}  // namespace

std::array<std::size_t, body_joint_count> match_joints(const std::vector<std::string>& names) {
    std::vector<SidedName> known;
    for (const std::string& name : names) known.push_back(sided(name));
    std::vector<bool> used(names.size());
    std::array<std::size_t, body_joint_count> out;
    out.fill(std::string::npos);
    // The first of the stems that is there and serves no other joint.
    const auto match = [&](BodyJoint joint, Side side,
                           std::initializer_list<std::string_view> stems) {
        for (const std::string_view stem : stems) {
            for (std::size_t n = 0; n < known.size(); ++n) {
                if (used[n] || known[n].side != side || known[n].stem != stem) continue;
                used[n] = true;
                out[static_cast<std::size_t>(joint)] = n;
                return;
            }
        }
    };
    match(BodyJoint::pelvis, Side::none, {"hips", "pelvis", "spinebase", "midhip", "hip", "root"});
    match(BodyJoint::neck, Side::none, {"neck", "spineshoulder", "neck1"});
    match(BodyJoint::head, Side::none, {"head", "headtop", "nose"});
    // In a skeleton of bones a joint has the name of the bone that it begins.
    for (const Side side : {Side::left, Side::right}) {
        const auto offset = [&](BodyJoint left) {
            const auto by = static_cast<std::size_t>(BodyJoint::right_shoulder) -
                            static_cast<std::size_t>(BodyJoint::left_shoulder);
            return static_cast<BodyJoint>(static_cast<std::size_t>(left) +
                                          (side == Side::right ? by : 0));
        };
        using enum BodyJoint;
        match(offset(left_shoulder), side, {"arm", "upperarm", "uparm", "shldr", "shoulder"});
        match(offset(left_elbow), side, {"forearm", "lowerarm", "elbow"});
        match(offset(left_wrist), side, {"wrist", "hand"});
        match(offset(left_fingers), side,
              {"handtip", "fingertip", "fingers", "handindex1", "index1", "hand"});
        match(offset(left_hip), side, {"upleg", "upperleg", "thigh", "hip"});
        match(offset(left_knee), side, {"knee", "leg", "lowerleg", "shin", "calf"});
        match(offset(left_ankle), side, {"ankle", "foot"});
        match(offset(left_toes), side, {"toebase", "toes", "toe", "footindex", "bigtoe", "foot"});
    }
    return out;
}

}  // namespace topple::io
