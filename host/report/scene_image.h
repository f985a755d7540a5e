// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "report/camera.h"
#include "report/canvas.h"
#include "report/depth_image.h"
#include "report/drawing.h"
#include "report/view_data.h"

namespace topple::report {

// The solids of a scene from above, through its nearest walls and ceiling, and what is laid over
// them.
class SceneImage {
  public:
    // Of so many pixels. Keeps references to its arguments.
    SceneImage(const Scene& scene, const PackedView& view, int width, int height,
               const std::array<double, 4>& margin);

    const Camera& camera() const { return camera_; }  // in the picture's pixels
    double reach_m() const { return reach_m_; }       // across the scene
    bool sees(std::int32_t object) const { return seen_.contains(object); }  // a movable one

    // What is laid over the solids, in the view's frame; hidden by what of them is in front of it,
    // or shining `through`.
    class Overlay {
      public:
        explicit Overlay(const SceneImage& image, bool through = false)
            : image_(image),
              front_(through ? DepthImage(image.solids_.width(), image.solids_.height())
                             : image.solids_) {}
        void triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Rgb8& colour);

      private:
        friend class SceneImage;
        const SceneImage& image_;
        DepthImage front_;
        std::vector<Rgb8> colours_;
    };

    // The picture, its solids coloured by group: one colour for each of the view's groups; but
    // voxels have their `own` where that gives one.
    using OwnColour = std::function<std::optional<Rgb8>(const Record& voxel)>;
    Raster shaded(const std::vector<Rgb8>& colour_of_group, const Overlay& overlay,
                  const OwnColour& own = nullptr) const;

  private:
    struct Face {
        std::uint32_t voxel;
        std::uint16_t group;
        float light;
    };
    void draw_solids();
    void add_face(const Vec3& centre, const Vec3& normal, const Vec3& side, const Vec3& other,
                  const Face& face);
    void find_crevices();
    void find_seen();
    std::int32_t object_at(std::size_t at) const;
    bool is_rim(std::size_t at) const;

    const PackedView& view_;
    int width_, height_;
    Camera camera_, fine_camera_;  // of the picture, and of its finer pixels
    double reach_m_ = 1;
    std::set<std::int32_t> grounded_;
    DepthImage solids_;
    std::vector<Face> faces_;
    std::set<std::int32_t> seen_;  // objects that cover more than a few of the finer pixels
    std::vector<float> open_;  // 0 to 1 for each pixel: how little of its surroundings is before it
};

}  // namespace topple::report
