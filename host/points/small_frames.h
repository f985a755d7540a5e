// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "topple/input.h"

namespace topple::geometry {

// Of the readings that were carried from one frame into another.
struct Agreement {
    std::uint64_t carried = 0;   // all, but for those at edges
    std::uint64_t compared = 0;  // that fall on a surface there, which both see or one hides
    std::uint64_t agreeing =
        0;                     // that lie on it, to three standard deviations of readings and 1 cm
    std::uint64_t before = 0;  // that lie before it, where the other frame looks through

    double compared_share() const { return share(compared, carried); }
    double common_share() const { return share(agreeing, carried); }
    double before_share() const { return share(before, carried); }
    // Of those that are compared.
    double agreeing_share() const { return share(agreeing, compared); }
    // Of those that the other frame does not hide.
    double seen_through_share() const { return share(before, before + agreeing); }
    Agreement& operator+=(const Agreement& other);

  private:
    static double share(std::uint64_t part, std::uint64_t of) {
        return of == 0 ? 0 : static_cast<double>(part) / static_cast<double>(of);
    }
};

Agreement sum(std::span<const Agreement> cells);

// Small copies of depth frames, about 80 x 60 readings each, by which it is told whether poses fit:
// readings of one are carried into another. Motions take points of the one camera to the other.
class SmallFrames {
  public:
    SmallFrames(const Intrinsics& intrinsics, std::size_t count);

    void add(const DepthFrame& frame, std::size_t number);
    bool has(std::size_t number) const { return !depth_[number].empty(); }
    std::size_t size() const { return depth_.size(); }

    // Of every `stride`-th reading in a row and column.
    Agreement carry(std::size_t from, std::size_t to, const Eigen::Isometry3d& motion,
                    unsigned stride) const;
    // Both ways, of each of the cells into which the images of both are parted.
    static constexpr std::size_t cells_across = 4, cells_up = 4;
    using Cells = std::array<Agreement, 2 * cells_across * cells_up>;
    Cells compare(std::size_t a, std::size_t b, const Eigen::Isometry3d& motion) const;

    // The motion near `guess` by which the frames' surfaces meet: Gauss-Newton steps on the
    // distances of carried readings to the patches there, those within a reach that shrinks.
    Eigen::Isometry3d align(std::size_t from, std::size_t to, Eigen::Isometry3d guess) const;

  private:
    struct Patch {               // of four neighbouring readings of one surface
        Eigen::Vector3d normal;  // towards the camera
        Eigen::Vector3d middle;
    };
    std::optional<Patch> patch(std::size_t frame, std::uint32_t column, std::uint32_t row) const;
    std::optional<Patch> patch_at(std::size_t frame, const Eigen::Vector3d& point) const;
    Eigen::Vector3d point(std::uint32_t column, std::uint32_t row, std::uint16_t stored) const;
    template <class Use>
    void each_met(std::size_t from, std::size_t to, const Eigen::Isometry3d& motion,
                  unsigned stride, Use use, Agreement* cells = nullptr) const;
    void carry_cells(std::size_t from, std::size_t to, const Eigen::Isometry3d& motion,
                     unsigned stride, Agreement* cells) const;

    Intrinsics intrinsics_;
    std::uint32_t step_, width_, height_;
    std::vector<std::vector<std::uint16_t>> depth_;  // every step_-th pixel; empty: not added yet
};

}  // namespace topple::geometry
