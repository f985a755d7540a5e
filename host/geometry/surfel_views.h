// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfel_discs.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// What is seen from one place in all directions: six square images of 90 degrees, along +x, -x, +y,
// -y, +z, -z of the input's frame. Image 2 f + s looks along axis f (negative for s = 1); its
// columns run along axis (f + 1) % 3, reversed for s = 1, its rows along axis (f + 2) % 3.
struct CubeView {
    static constexpr std::uint32_t side = 320;
    static constexpr double focal = side / 2.0, centre = (side - 1) / 2.0;
    static constexpr std::uint32_t nothing = 0xffffffff;

    Vec3 eye{};
    // Of each pixel, row by row: the nearest surfel, and its depth along the image's axis, metres.
    std::array<std::vector<std::uint32_t>, 6> surfel;
    std::array<std::vector<float>, 6> depth;

    // The pixel of a point in one image, and its depth there.
    struct Pixel {
        std::size_t index = 0;
        double depth = 0;
        bool inside = false;
    };
    Pixel pixel_of(std::size_t image, const Vec3& point) const;
    // The image that the point lies in.
    std::size_t image_of(const Vec3& point) const;
    // Camera to world of one image; x right, y down, z forward.
    Mat4 pose(std::size_t image) const;
    // Calls visit(i, pixels) for each run of a surfel's pixels in one image.
    template <class Visit>
    void for_each_seen(std::size_t image, const Visit& visit) const {
        const std::vector<std::uint32_t>& of = surfel[image];
        for (std::size_t first = 0, end = 0; first < of.size(); first = end) {
            while (end < of.size() && of[end] == of[first]) ++end;
            if (of[first] != nothing) visit(of[first], static_cast<std::uint32_t>(end - first));
        }
    }
};

// Draws surfels as discs in their planes, of the given radii (covering_radii()), up to the edges
// where they end (cuts_at_edges()); those without a normal as discs across the line of sight.
class SurfelViews {
  public:
    SurfelViews(const Surfels& surfels, std::vector<float> radii_m, ThreadPool& pool);
    CubeView from(const Vec3& eye) const;
    std::span<const float> radii_m() const { return radii_; }

    // Surfels that follow one another, and so lie together: many are out of an image at once.
    struct Patch {
        Vec3 low, high;  // of their middles
        double largest_radius;
    };

  private:
    static constexpr std::size_t patch_size = 64;

    const Surfels& s_;
    std::vector<float> radii_;
    std::vector<DiscCuts> cuts_;
    ThreadPool& pool_;
    std::vector<Patch> patches_;
};

}  // namespace topple::geometry
