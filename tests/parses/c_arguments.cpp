// SPDX-License-Identifier: MIT
#include "parses/c_arguments.h"

namespace topple::parses {

void check_call(const char* function, int code, const topple_status& status) {
    const std::string at = std::string(function) + ": ";
    if (code < TOPPLE_OK || code >= TOPPLE_ERROR_INTERNAL)
        throw Broken{at + "code " + std::to_string(code) + ", " + status.message};
    if (status.code != code) throw Broken{at + "the status has another code"};
    const std::size_t length = ::strnlen(status.message, sizeof(status.message));
    if (length == sizeof(status.message)) throw Broken{at + "a message without an end"};
    if ((length == 0) != (code == TOPPLE_OK)) throw Broken{at + "a message that should not be"};
    for (std::size_t n = 0; n < length; ++n)
        if (static_cast<unsigned char>(status.message[n]) < 0x20)
            throw Broken{at + "a message of more than one line"};
}

Device open_native() {
    topple_device* opened = nullptr;
    topple_status status;
    check_call("topple_device_open", topple_device_open("native", 1, &opened, &status), status);
    return Device(opened);
}

double Arguments::number(double low, double high) {
    constexpr std::array<double, 6> odd{
        0, -1, 1e300, -1e-300, INFINITY, std::numeric_limits<double>::quiet_NaN()};
    return chance(0.1) ? odd[random_.below(odd.size())] : random_.uniform(low, high);
}

void Arguments::check(const char* function, int code) {
    // Where no status was given, the last call's is still there.
    if (status_.code != code) status_ = {code, ""};
    if (code != TOPPLE_OK && status_.message[0] == 0) std::strcpy(status_.message, "none");
    if (code == TOPPLE_OK) status_.message[0] = 0;
    check_call(function, code, status_);
}

topple_cloud Arguments::cloud() {
    topple_cloud c;
    topple_cloud_init(&c, sizeof(c));
    const PointCloud& from = scene_.cloud;
    c.x = from.x.data();
    c.y = or_null(from.y.data());
    c.z = from.z.data();
    c.count = chance(0.1) ? random_.below(from.size() + 1) : from.size();
    if (!from.nx.empty()) {
        c.nx = from.nx.data();
        c.ny = from.ny.data();
        c.nz = or_null(from.nz.data());
    }
    if (chance(0.05)) c.viewpoint_x = c.viewpoint_y = c.viewpoint_z = c.x;
    if (chance(0.03)) c.viewpoint_y = nullptr;
    if (chance(0.03)) c.count = huge_count();
    if (chance(0.05)) c.width = static_cast<std::uint32_t>(random_.bits());
    if (chance(0.05)) c.size = random_.below(2 * sizeof(c));
    return c;
}

topple_frames Arguments::frames() {
    constexpr std::uint32_t width = 16, height = 12;
    const std::uint64_t count = 1 + random_.below(3);
    depth_.assign(width * height, 0);
    for (std::uint16_t& d : depth_) d = static_cast<std::uint16_t>(1500 + random_.below(400));
    depth_m_.assign(depth_.begin(), depth_.end());
    for (float& d : depth_m_) d = static_cast<float>(number(1, 2));
    rgb_.assign(3 * depth_.size(), 90);
    pose_.clear();
    for (std::uint64_t n = 0; n < count; ++n) {
        pose_.insert(pose_.end(), {1, 0, 0, 0.1 * double(n), 0, 0, 1, 0, 0, -1, 0, 1, 0, 0, 0, 1});
        if (chance(0.1)) pose_[pose_.size() - 1 - random_.below(16)] = number(-2, 2);
    }
    frame_.assign(count, {});
    const bool metres = chance(0.3);
    for (topple_frame& f : frame_) {
        topple_frame_init(&f, sizeof(f));
        if (metres || chance(0.02)) f.depth_m = depth_m_.data();
        if (!metres) f.depth = or_null(depth_.data());
        if (chance(0.3)) f.rgb = rgb_.data();
        if (chance(0.03)) f.rgb_width = static_cast<std::uint32_t>(random_.below(width));
        if (chance(0.03)) f.size = random_.below(sizeof(f));
        if (chance(0.03)) f.depth_stride_bytes = static_cast<std::int64_t>(random_.below(16));
    }
    topple_frames out;
    topple_frames_init(&out, sizeof(out));
    out.intrinsics = {width,        height,       number(12, 16),   number(12, 16),
                      number(7, 9), number(5, 7), number(900, 1100)};
    if (chance(0.05)) out.intrinsics.width = static_cast<std::uint32_t>(random_.below(width));
    colour_ = out.intrinsics;
    if (chance(0.2)) out.colour_intrinsics = &colour_;
    out.count = count;
    out.camera_to_world = or_null(pose_.data());
    out.frames = or_null(frame_.data());
    if (!out.frames || chance(0.03)) {
        out.user = &frame_;
        out.load = [](std::uint64_t n, topple_frame* to, void* user) {
            const auto& all = *static_cast<std::vector<topple_frame>*>(user);
            if (n >= all.size()) return 7;
            *to = all[n];
            return 0;
        };
    }
    if (chance(0.03)) out.count = huge_count();
    if (chance(0.03)) out.size = random_.below(2 * sizeof(out));
    return out;
}

}  // namespace topple::parses
