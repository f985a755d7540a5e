// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "topple/cloud_view.h"
#include "topple/frames_view.h"
#include "topple/parse.h"

namespace topple {

// What each pixel of a depth image shows of a parsed scene: rows from the upper one down, each from
// left to right. -1: nothing that is known, as the pixel has no reading, or what it shows was not
// there in the parse, or belongs to nothing in it.
struct FrameLabels {
    std::uint32_t width = 0, height = 0;
    std::vector<std::int32_t> primitive, object;  // ids
};

// The same of points, by point.
struct PointLabels {
    std::vector<std::int32_t> primitive, object;
};

// Finds the parts and objects of a result in depth frames or sweeps of points: those that were
// parsed, or others that were taken in the same place. A pixel, or a point, shows what the point of
// the result belongs to that is nearest to its reading, within the edge of a voxel, or three
// standard deviations of a reading from so far away, if that is more.
//
// Holds 20 bytes for each point of the result, which it does not need any more. May be asked by
// several threads at once.
class FrameLabeller {
  public:
    // Throws Error(usage) for a result without its points' coordinates, and of a cloud that was
    // parsed in blocks.
    explicit FrameLabeller(const ParseResult& result);
    ~FrameLabeller();
    FrameLabeller(FrameLabeller&&) noexcept;
    FrameLabeller& operator=(FrameLabeller&&) noexcept;

    // Of frame `number`, from 0. camera_to_world is to the frame of the result's points, from which
    // Scene::offset_m was taken off. threads: 0 for one per core; the result does not depend on
    // them. Throws Error: input (what makes no sense, as parse() does), usage (there is no such
    // frame).
    FrameLabels label(const FramesView& frames, std::size_t number, unsigned threads = 0) const;
    // The same of points, in a sensor's axes. Those that are not finite belong to nothing.
    PointLabels label(const CloudView& points, const Mat4& sensor_to_world,
                      unsigned threads = 0) const;
    // The same of a folder of frames.
    FrameLabels label(const std::filesystem::path& folder, std::size_t number,
                      unsigned threads = 0) const;

  private:
    class Points;
    std::unique_ptr<const Points> points_;
};

}  // namespace topple
