// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "points/formats/colour_values.h"
#include "topple/input.h"

namespace topple::io {

// Takes the points of a file while it is read, in its order and about a million at a time: clouds
// without `pixel`, size, viewpoint or source. `dropped` is of this portion.
using CloudSink = std::function<void(PointCloud)>;

// What a file's points have beside coordinates.
struct CloudFields {
    bool normals = false;
    bool viewpoints = false;
    ColourValues colours = ColourValues::none;
};

// Collects the points of a file into a PointCloud: drops and counts the ones that are not finite,
// refuses coordinates that can't be metres, makes normals unit length, and colours bytes.
class CloudBuilder {
  public:
    // `promised` points are reserved: check it against the file's size first. With a sink, which
    // must outlive the builder, only a portion of them is held at a time.
    CloudBuilder(const std::filesystem::path& file, std::uint64_t promised, CloudFields fields,
                 const CloudSink* sink = nullptr);

    // Adds point number seen(). `normal` is read with normals only; one that is not finite or has
    // no length is stored as 0, 0, 0. `colour` is read with colours only, red, green and blue as
    // the file has them; `viewpoint` with viewpoints only. Throws Error(input) for a coordinate
    // beyond 1e6 m.
    void add(const std::array<double, 3>& point, const std::array<double, 3>& normal = {},
             const std::array<double, 3>& colour = {}, const std::array<double, 3>& viewpoint = {});
    std::uint64_t seen() const { return seen_; }

    // All points are in. `width`, `height` > 0: the points are the pixels of one image, row by row.
    // Throws Error(input) where no point is finite. With a sink all points have gone there, and the
    // cloud has none.
    PointCloud finish(std::uint32_t width = 0, std::uint32_t height = 0);

  private:
    void pass_on();

    std::filesystem::path file_;
    const CloudSink* sink_;
    std::uint64_t passed_on_ = 0;  // points that the sink has
    PointCloud cloud_;
    CloudFields fields_;
    ColourScale colours_;
    bool any_normal_ = false;
    std::uint64_t seen_ = 0;
};

// What is wrong with point number `index`, beyond farthest_m, and what mends it.
std::string too_far(std::uint64_t index, double coordinate);

// Notes in the cloud what looks odd about its extent or its place.
void note_extent(PointCloud& cloud);

}  // namespace topple::io
