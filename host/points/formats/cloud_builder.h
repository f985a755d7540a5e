// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "topple/input.h"

namespace topple::io {

// Takes the points of a file while it is read, in its order and about a million at a time: clouds
// without `pixel`, size, viewpoint or source. `dropped` is of this portion.
using CloudSink = std::function<void(PointCloud)>;

// How a file stores its points' colours. Of all but bytes it says nowhere what full brightness is:
// that is 255 or 65535 of whole numbers, 1 too of real ones.
enum class ColourValues : std::uint8_t { none, bytes, whole, real };

// Takes a file's colours to a cloud's bytes. Full brightness is the least of the above that 99 of a
// hundred values reach, of those that are not 0, among the file's first.
class ColourScale {
  public:
    explicit ColourScale(ColourValues values) : values_(values) {}
    // Of the cloud's next point. A value that is negative or not finite makes it unknown.
    void add(const std::array<double, 3>& colour, PointCloud& cloud);
    // Before the cloud's arrays are used: what waits for more values waits no longer.
    void settle(PointCloud& cloud);

  private:
    void put(const std::array<double, 3>& colour, PointCloud& cloud) const;

    ColourValues values_;
    double full_ = 0;                            // 0: not known yet
    std::vector<std::array<float, 3>> waiting_;  // until it is
    std::uint64_t bright_ = 0;                   // of those, with a value above 0
};

// What a file has of a point: the colour as it stands there, red, green and blue.
struct FilePoint {
    std::array<double, 3> at{}, normal{}, colour{}, viewpoint{};
};

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

    // Adds point number seen(). Its normal, colour and viewpoint are looked at where `fields` has
    // them; a normal that is not finite or has no length is stored as 0, 0, 0. Throws Error(input)
    // for a coordinate beyond 1e6 m.
    void add(const FilePoint& point);
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
