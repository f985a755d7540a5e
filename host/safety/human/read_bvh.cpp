// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "io/text.h"
#include "safety/human/motion_formats.h"

namespace topple::io {
namespace {

constexpr std::size_t no_parent = SIZE_MAX;
constexpr std::size_t most_joints = 4096;

using Mat3 = std::array<double, 9>;  // by rows

Mat3 times(const Mat3& a, const Mat3& b) {
    Mat3 out{};
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < 3; ++k) out[3 * r + c] += a[3 * r + k] * b[3 * k + c];
        }
    }
    return out;
}

Mat3 rotation(std::size_t axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    if (axis == 0) return {1, 0, 0, 0, c, -s, 0, s, c};
    if (axis == 1) return {c, 0, s, 0, 1, 0, -s, 0, c};
    return {c, -s, 0, s, c, 0, 0, 0, 1};
}

struct Channel {
    bool rotates = false;
    std::size_t axis = 0;
};
struct Joint {
    std::string name;
    std::size_t parent = no_parent;
    Vec3 offset{};
    std::vector<Channel> channels;
};

class BvhReader {
  public:
    BvhReader(const std::filesystem::path& file, std::string_view text)
        : file_(file), lines_(text) {}

    NamedMotion read() {
        expect("HIERARCHY");
        const std::string_view root = token();
        if (root != "ROOT") bad("expected ROOT, found " + in_quotes(root));
        read_skeleton();
        expect("MOTION");
        return read_frames();
    }

  private:
    [[noreturn]] void bad(const std::string& what) const {
        fail(file_, "line " + std::to_string(lines_.number()) + ": " + what);
    }
    std::string_view token() {
        std::string_view next;
        while ((next = next_token(line_)).empty()) {
            if (!lines_.next(line_)) bad("the file ends too early");
        }
        return next;
    }
    void expect(std::string_view word) {
        const std::string_view found = token();
        if (found != word)
            bad("expected " + std::string(word) + ", found " + in_quotes(found) +
                (word == "HIERARCHY" ? "; is it a BVH file?" : ""));
    }
    double number() {
        const std::string_view text = token();
        double value = 0;
        if (!parse_number(text, value) || !std::isfinite(value) || std::abs(value) > 1e9)
            bad("expected a number, found " + in_quotes(text));
        return value;
    }
    std::uint64_t count() {
        const std::string_view text = token();
        std::uint64_t value = 0;
        if (!parse_count(text, value)) bad("expected a count, found " + in_quotes(text));
        return value;
    }

    // From the root's name to the end of its block.
    void read_skeleton() {
        std::vector<std::size_t> open;  // the blocks around the place in the text
        std::string name(token());
        expect("{");
        add_joint(name, no_parent, open);
        while (!open.empty()) {
            const std::string_view word = token();
            Joint& joint = joints_[open.back()];
            if (word == "}") {
                open.pop_back();
            } else if (word == "OFFSET") {
                for (double& c : joint.offset) c = number();
            } else if (word == "CHANNELS") {
                read_channels(joint);
            } else if (word == "JOINT") {
                name = token();
                expect("{");
                add_joint(name, open.back(), open);
            } else if (word == "End") {
                expect("Site");
                expect("{");
                add_joint(joint.name + "End", open.back(), open);
            } else {
                bad("unknown word " + in_quotes(word));
            }
        }
    }
    void add_joint(const std::string& name, std::size_t parent, std::vector<std::size_t>& open) {
        if (joints_.size() == most_joints)
            bad("more than " + std::to_string(most_joints) + " joints");
        joints_.push_back({name, parent, {}, {}});
        open.push_back(joints_.size() - 1);
    }
    void read_channels(Joint& joint) {
        const std::uint64_t n = count();
        if (n > 6) bad("a joint has 6 channels at most, this one " + std::to_string(n));
        joint.channels.clear();
        for (std::uint64_t c = 0; c < n; ++c) {
            const std::string_view word = token();
            const std::string_view kind = word.empty() ? word : word.substr(1);
            if ((kind != "position" && kind != "rotation") || word[0] < 'X' || word[0] > 'Z')
                bad("unknown channel " + in_quotes(word));
            joint.channels.push_back({kind == "rotation", static_cast<std::size_t>(word[0] - 'X')});
        }
    }

    NamedMotion read_frames() {
        expect("Frames:");
        const std::uint64_t frames = count();
        expect("Frame");
        expect("Time:");
        NamedMotion out;
        out.step_s = number();
        if (!(out.step_s > 0)) bad("the frame time must be above 0 seconds");
        std::uint64_t channels = 0;
        for (const Joint& joint : joints_) channels += joint.channels.size();
        const std::uint64_t numbers =
            saturating_multiply(frames, std::max<std::uint64_t>(channels, joints_.size()));
        // Each number takes two bytes of the text or more.
        if (channels == 0 || numbers > most_motion_numbers ||
            saturating_multiply(frames, channels) > lines_.remaining()) {
            bad("says that " + counted(frames, "frame") + " of " + counted(channels, "number") +
                " follow, which can't be");
        }
        for (const Joint& joint : joints_) out.names.push_back(joint.name);
        out.track.resize(joints_.size());
        for (std::uint64_t f = 0; f < frames; ++f) add_frame(out);
        return out;
    }
    void add_frame(NamedMotion& out) {
        turn_.resize(joints_.size());
        for (std::size_t j = 0; j < joints_.size(); ++j) {
            const Joint& joint = joints_[j];
            Vec3 shift = joint.offset;
            Mat3 turn{1, 0, 0, 0, 1, 0, 0, 0, 1};
            bool placed = false;
            for (const Channel& channel : joint.channels) {
                const double value = number();
                if (channel.rotates) {
                    turn = times(turn, rotation(channel.axis, value));
                } else {
                    if (!placed) shift = {};  // the channels say where it is, not by how much
                    placed = true;
                    shift[channel.axis] = value;
                }
            }
            if (joint.parent == no_parent) {
                turn_[j] = turn;
                out.track[j].push_back(shift);
                continue;
            }
            const Mat3& from = turn_[joint.parent];
            turn_[j] = times(from, turn);
            Vec3 at = out.track[joint.parent].back();
            for (std::size_t r = 0; r < 3; ++r) {
                for (std::size_t c = 0; c < 3; ++c) at[r] += from[3 * r + c] * shift[c];
            }
            out.track[j].push_back(at);
        }
    }

    const std::filesystem::path& file_;
    Lines lines_;
    std::string_view line_;
    std::vector<Joint> joints_;  // parents before children
    std::vector<Mat3> turn_;
};

}  // namespace

NamedMotion read_bvh(const std::filesystem::path& file, std::string_view text) {
    return BvhReader(file, text).read();
}

}  // namespace topple::io
