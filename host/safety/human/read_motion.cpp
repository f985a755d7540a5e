// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/ranked.h"
#include "core/vectors.h"
#include "io/text.h"
#include "safety/human/motion_formats.h"
#include "topple/motion.h"

namespace topple {
namespace {

using enum BodyJoint;
using Limb = std::array<BodyJoint, 3>;

// Lengths from hip to ankle and from shoulder to wrist, as fractions of stature (Drillis & Contini
// 1966, as in Winter 2009, Fig. 4.1).
constexpr double leg_share = 0.530 - 0.039, arm_share = 0.186 + 0.146;
constexpr std::array<Limb, 2> legs{
    {{left_hip, left_knee, left_ankle}, {right_hip, right_knee, right_ankle}}};
constexpr std::array<Limb, 2> arms{
    {{left_shoulder, left_elbow, left_wrist}, {right_shoulder, right_elbow, right_wrist}}};

double distance(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Median over the frames and sides of a limb's length; 0 where none was recorded.
double limb_length(const BodyMotion& motion, std::span<const Limb> limbs) {
    std::vector<double> lengths;
    for (const Limb& limb : limbs) {
        const auto &a = motion.of(limb[0]), &b = motion.of(limb[1]), &c = motion.of(limb[2]);
        if (a.empty() || b.empty() || c.empty()) continue;
        for (std::size_t f = 0; f < a.size(); ++f)
            lengths.push_back(distance(a[f], b[f]) + distance(b[f], c[f]));
    }
    return upper_median(lengths);
}

Vec3 mean(const BodyMotion& motion, std::initializer_list<BodyJoint> joints) {
    Vec3 sum{};
    double count = 0;
    for (const BodyJoint joint : joints) {
        for (const Vec3& p : motion.of(joint)) {
            for (std::size_t c = 0; c < 3; ++c) sum[c] += p[c];
            ++count;
        }
    }
    for (double& c : sum) c = count > 0 ? c / count : std::nan("");
    return sum;
}

// The axis of the file along which the body stands, signed.
std::optional<Vec3> found_up(const BodyMotion& motion) {
    const Vec3 top = mean(motion, {head, neck}),
               shoulders = mean(motion, {left_shoulder, right_shoulder}),
               hips = mean(motion, {pelvis, left_hip, right_hip}),
               feet = mean(motion, {left_ankle, right_ankle, left_toes, right_toes});
    for (const auto& [high, low] :
         {std::pair{top, feet}, {shoulders, feet}, {top, hips}, {shoulders, hips}, {hips, feet}}) {
        const Vec3 way{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
        if (!std::isfinite(way[0])) continue;
        std::size_t axis = 0;
        for (std::size_t c = 1; c < 3; ++c) {
            if (std::abs(way[c]) > std::abs(way[axis])) axis = c;
        }
        // A body that lies or crouches tells nothing.
        if (!(std::abs(way[axis]) > 0.85 * std::hypot(way[0], way[1], way[2]))) continue;
        Vec3 up{};
        up[axis] = way[axis] > 0 ? 1 : -1;
        return up;
    }
    return {};
}

// Turns all positions so that `up` becomes z.
void stand_up(BodyMotion& motion, const Vec3& up) {
    const double length = std::hypot(up[0], up[1], up[2]);
    const Vec3 z{up[0] / length, up[1] / length, up[2] / length};
    // Some axis across: the heading is found from the body itself.
    Vec3 x = std::abs(z[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    x = along(x, -dot(x, z), z);
    const double across = std::hypot(x[0], x[1], x[2]);
    for (double& c : x) c /= across;
    const Vec3 y = cross(z, x);
    for (auto& track : motion.track) {
        for (Vec3& p : track) p = {dot(p, x), dot(p, y), dot(p, z)};
    }
}

std::string metres(double m) {
    return io::short_number(std::round(100 * m) / 100) + " m";
}

// The file's unit in metres, so that the body has a human size.
double find_unit(const std::filesystem::path& file, BodyMotion& motion,
                 const MotionFileOptions& options) {
    const double size = motion.stature_m();  // in the file's unit as yet
    if (!(size > 0)) {
        io::fail(file,
                 "neither an arm (shoulder, elbow, wrist) nor a leg (hip, knee, ankle) was "
                 "recorded whole: the size of the body can't be checked");
    }
    if (options.unit_m) {
        const double stature = size * *options.unit_m;
        if (stature < 0.8 || stature > 2.4) {
            io::fail(file, "with a unit of " + io::short_number(*options.unit_m) +
                               " m the body would be " + metres(stature) +
                               " tall; expected 0.8 to 2.4 m");
        }
        return *options.unit_m;
    }
    struct Unit {
        double in_m;
        const char* name;
    };
    for (const Unit& unit : {Unit{1, "metres"},
                             {0.01, "centimetres"},
                             {0.001, "millimetres"},
                             {0.0254, "inches"},
                             {0.3048, "feet"}}) {
        const double stature = size * unit.in_m;
        if (stature < 1.3 || stature > 2.1) continue;
        if (unit.in_m != 1) {
            motion.notes.push_back("The motion was taken to be in " + std::string(unit.name) +
                                   ": the body is " + metres(stature) + " tall then.");
        }
        return unit.in_m;
    }
    const double unit = 1.75 / size;
    motion.notes.push_back(
        "The motion is in no usual unit; one of it was taken as " + io::short_number(unit) +
        " m, which makes the body 1.75 m tall. Give its unit where you know it.");
    return unit;
}

void check_motion_options(const MotionFileOptions& options) {
    const auto check = [](const char* name, const std::optional<double>& value) {
        if (value && !(*value > 0 && std::isfinite(*value)))
            throw Error(ErrorKind::usage, std::string(name) + " " + io::short_number(*value) +
                                              ": expected a number above 0");
    };
    check("motion_unit (--motion-unit)", options.unit_m);
    check("motion_rate (--motion-rate)", options.rate_hz);
    if (!options.up) return;
    const double length = std::hypot((*options.up)[0], (*options.up)[1], (*options.up)[2]);
    if (!(length > 0) || !std::isfinite(length))
        throw Error(ErrorKind::usage,
                    "motion_up (--motion-up): expected three numbers, not all zero");
}

}  // namespace

std::size_t BodyMotion::frames() const {
    std::size_t most = 0;
    for (const auto& t : track) most = std::max(most, t.size());
    return most;
}

double BodyMotion::stature_m() const {
    const double leg = limb_length(*this, legs);
    return leg > 0 ? leg / leg_share : limb_length(*this, arms) / arm_share;
}

BodyMotion read_motion(const std::filesystem::path& file, const MotionFileOptions& options) {
    check_motion_options(options);
    const io::FileBytes bytes = io::read_file(file, std::uint64_t{1} << 31);
    const std::string_view text = bytes.text();
    const bool bvh = text.substr(0, 4096).find("HIERARCHY") != std::string_view::npos;
    io::NamedMotion raw = bvh ? io::read_bvh(file, text) : io::read_joint_table(file, text);

    BodyMotion out;
    out.source = io::path_text(file);
    const auto matched = io::match_joints(raw.names);
    for (std::size_t joint = 0; joint < body_joint_count; ++joint) {
        if (matched[joint] != std::string::npos)
            out.track[joint] = std::move(raw.track[matched[joint]]);
    }
    out.step_s = options.rate_hz ? 1 / *options.rate_hz : raw.step_s;
    if (!(out.step_s > 0)) {
        io::fail(
            file,
            "has no column \"time\": say by motion_rate (--motion-rate) how many frames a second "
            "were recorded");
    }
    if (out.step_s > 0.2) {
        io::fail(file, "its frames are " + io::short_number(out.step_s) +
                           " s apart; expected at most 0.2 s, as speeds come from one to the next");
    }
    const double seconds = static_cast<double>(out.frames()) * out.step_s;
    if (out.frames() < 3 || seconds < 0.5) {
        io::fail(file, "holds " + io::counted(out.frames(), "frame") + ", " +
                           io::short_number(seconds) + " s; expected half a second at least");
    }
    const double unit = find_unit(file, out, options);
    for (auto& track : out.track) {
        for (Vec3& p : track) {
            for (double& c : p) c *= unit;
        }
    }
    const std::optional<Vec3> up = options.up ? options.up : found_up(out);
    if (!up) {
        out.notes.push_back("What is up in the motion can't be told from head and feet: " +
                            std::string(bvh ? "its second axis, y," : "its third axis, z,") +
                            " was taken.");
    }
    stand_up(out, up.value_or(bvh ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
    return out;
}

}  // namespace topple
