// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::test {

// A BVH file of the lower half of a body, y up, in centimetres over `scale`; it walks along z, and
// bends its left knee to 90 degrees in its last frame.
inline std::string bvh(int frames, double step_s, double scale = 1) {
    const auto offset = [&](double x, double y, double z) {
        return "OFFSET " + std::to_string(x * scale) + " " + std::to_string(y * scale) + " " +
               std::to_string(z * scale) + "\n";
    };
    std::string text = "HIERARCHY\nROOT Hips\n{\n" + offset(0, 0, 0) +
                       "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n";
    for (const bool left : {true, false}) {
        const std::string side = left ? "Left" : "Right";
        text.append("JOINT ")
            .append(side)
            .append("UpLeg\n{\n")
            .append(offset(left ? 10 : -10, 0, 0));
        text.append("CHANNELS 3 Zrotation Yrotation Xrotation\nJOINT ").append(side);
        text.append("Leg\n{\n").append(offset(0, -45, 0));
        text.append("CHANNELS 3 Zrotation Yrotation Xrotation\nJOINT ").append(side);
        text.append("Foot\n{\n").append(offset(0, -40, 0));
        text.append("CHANNELS 3 Zrotation Yrotation Xrotation\nEnd Site\n{\n");
        text.append(offset(0, -5, 12)).append("}\n}\n}\n}\n");
    }
    text.append("}\nMOTION\nFrames: ").append(std::to_string(frames));
    text.append("\nFrame Time: ").append(std::to_string(step_s)).append("\n");
    for (int f = 0; f < frames; ++f) {
        text.append("0 ").append(std::to_string(90 * scale)).append(" ");
        text.append(std::to_string(f * scale)).append(" 0 0 0  0 0 0  0 0 ");
        text.append(f + 1 == frames ? "90" : "0").append("  0 0 0  0 0 0 0 0 0 0 0 0\n");
    }
    return text;
}

}  // namespace topple::test
