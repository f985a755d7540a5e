// SPDX-License-Identifier: MIT
#include "points/frame_checks.h"

#include <array>
#include <cmath>

#include "io/text.h"

namespace topple {
namespace {

using geometry::PoseConvention;

// What poses are in a convention, and what gives those that are meant, in words and in NumPy's.
struct ConventionText {
    const char *words, *mend;
};
constexpr std::array<ConventionText, geometry::pose_conventions> texts{{
    {"camera to world", "each pose as it is"},
    {"world to camera", "the inverse of each pose (np.linalg.inv(pose))"},
    {"of a camera with y up and z back, as in OpenGL, Blender and ARKit",
     "each pose with its second and third columns negated (pose @ np.diag([1, -1, -1, 1]))"},
    {"world to camera, with the camera's y up and z back, as OpenGL's view matrix",
     "the inverse of each pose, with its second and third columns negated (np.linalg.inv(pose) @ "
     "np.diag([1, -1, -1, 1]))"},
    {"of a body with x ahead, y left and z up, as in ROS",
     "each pose with its columns in this order: the second negated, the third negated, the first, "
     "the fourth (pose @ [[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])"},
    {"world to body, with x ahead, y left and z up, as in ROS",
     "the inverse of each pose, with its columns in this order: the second negated, the third "
     "negated, the first, the fourth (np.linalg.inv(pose) @ [[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, "
     "0, 0], [0, 0, 0, 1]])"},
    {"made of quaternions with w first",
     "poses of their quaternions as x, y, z, w (q[[1, 2, 3, 0]])"},
    {"of transposed rotations (column-major, or quaternions with x, y, z negated)",
     "each pose with its 3 x 3 rotation transposed, as matrices are row-major (pose[:3, :3] = "
     "pose[:3, :3].T)"},
}};

std::string percent(double share) {
    return std::to_string(std::lround(100 * share)) + " %";
}

std::string counted_from_0(std::size_t frame) {
    return "frame " + std::to_string(frame) + " (counted from 0)";
}

// From which frame on, by how many pairs, and how far off.
std::string contradiction_text(const geometry::PoseContradiction& c, std::size_t frames) {
    std::string text = c.until >= frames ? "The frames contradict each other from " +
                                               counted_from_0(c.from) + " on: "
                       : c.until == c.from + 1
                           ? "One frame contradicts the others, " + counted_from_0(c.from) + ": "
                           : "Frames contradict the others from " + counted_from_0(c.from) +
                                 " to " + std::to_string(c.until - 1) + ": ";
    text += "of " + io::counted(c.pairs, "pair") + " of frames that look at the same place " +
            std::to_string(c.contradict) + (c.contradict == 1 ? " sees" : " see") +
            " through what the other shows, first " + std::to_string(c.against) + " and " +
            std::to_string(c.from) + ". ";
    if (c.way_m > 0)
        text += "Their cameras are off by about " + io::two_digits(c.way_m) + " m and " +
                io::two_digits(c.turn_deg) + "\u00b0. ";
    return text + "The poses were taken as they are, so that things are doubled" +
           (c.doubled_m > 0 ? ", about " + io::two_digits(c.doubled_m) + " m apart," : "") +
           " or too wide. ";
}

}  // namespace

void note_principal_point(const Intrinsics& k, ScanOrigin origin, std::vector<std::string>& notes) {
    const auto in_the_middle = [](double at, std::uint32_t size) {
        return at >= 0.25 * size && at <= 0.75 * size;
    };
    if (in_the_middle(k.cx, k.width) && in_the_middle(k.cy, k.height)) return;
    notes.push_back("The principal point (" + io::short_number(k.cx) + ", " +
                    io::short_number(k.cy) + ") lies outside of the middle half of the images of " +
                    std::to_string(k.width) + " x " + std::to_string(k.height) +
                    " pixels, so that all is seen askew unless they were cut out of larger ones: " +
                    "check cx and cy of " +
                    (origin == ScanOrigin::frames_folder ? "intrinsics.json" : "the intrinsics") +
                    ", mostly near (" + io::short_number(0.5 * (k.width - 1.0)) + ", " +
                    io::short_number(0.5 * (k.height - 1.0)) + ").");
}

std::string pose_note(const geometry::PoseComparison& frames, std::size_t count,
                      ScanOrigin origin) {
    const bool in_folder = origin == ScanOrigin::frames_folder;
    const geometry::PoseComparison::Verdict found = frames.verdict();
    if (!found.contradiction) return {};
    const std::vector<PoseConvention>& better = found.better;
    if (better.empty()) {
        const std::string text = contradiction_text(*found.contradiction, count);
        if (found.contradiction->same_pose)
            return text + "It has the pose of the frame before it: were the poses filled in?";
        return text +
               "After a jump (a loop was closed, or tracking was lost) or drift give mended poses, "
               "or leave these frames out; else check that the poses are those of the images, in "
               "their order, and in metres, and that fx, fy, cx, cy and depth_scale of " +
               (in_folder ? "intrinsics.json" : "the intrinsics") + " are the depth camera's.";
    }
    const auto agreeing = [&](PoseConvention convention) {
        return percent(found.agreement[static_cast<std::size_t>(convention)].agreeing_share());
    };
    std::string words, mends;
    for (const PoseConvention convention : better) {
        const ConventionText& text = texts[static_cast<std::size_t>(convention)];
        words.append(words.empty() ? "" : ", or ").append(text.words);
        mends.append(mends.empty() ? "" : ", or ").append(text.mend);
    }
    return "The poses seem to be in another convention: of the readings of " +
           io::counted(found.pairs, "pair") + " of frames that look at the same place " +
           agreeing(PoseConvention::camera_to_world) +
           " lie on what the other frame sees there, but " + agreeing(better.front()) +
           " if poses are taken to be " + words +
           (better.size() > 1 ? ", between which the frames do not tell" : "") +
           ". topple takes camera to world, camera x right, y down, z ahead: " +
           (in_folder ? "write into the file of poses" : "give as camera_to_world") + " " + mends +
           ".";
}

}  // namespace topple
