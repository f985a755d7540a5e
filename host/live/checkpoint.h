// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/checksum.h"
#include "live/gone_things.h"
#include "live/kept_frame.h"
#include "live/known_things.h"
#include "topple/session.h"

namespace topple::live {

struct PosedFrame {
    std::shared_ptr<const KeptFrame> frame;
    Mat4 pose{};                                // as it was given
    std::shared_ptr<const DepthFrame> image{};  // ScanKind::image() of it; no file has it
};

struct KeptFrames {
    std::map<FrameId, PosedFrame> kept;
    FrameId next = 0;
    Checksum::Value last{};  // of the frame added last
};

// What the last update left for the next one.
struct Remembered {
    KnownThings things;
    std::map<FrameId, Mat4> poses;  // that it was parsed from
    std::vector<ThingPixels> gone;  // things that were left out
};

// What a session is beside its options.
struct Checkpoint {
    std::optional<Intrinsics> depth;  // none: its frames are sweeps of points
    std::optional<Intrinsics> colour;
    KeptFrames frames;
    Remembered remembered;

    // There whole or not at all, also after a loss of power. Throws Error(input) where it can't be
    // written, or where the file is there and none of topple's.
    void write(const std::filesystem::path& file) const;
    // Throws Error(input) where it is damaged, or none that write() makes.
    static Checkpoint read(const std::filesystem::path& file);
};

}  // namespace topple::live
