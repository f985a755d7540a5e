// SPDX-License-Identifier: MIT
#include "report/scene_image.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/ranked.h"
#include "core/vectors.h"

namespace topple::report {
namespace {

constexpr int fine = 2;  // pixels are means of fine x fine

// The 2nd and 98th hundredths of the voxels' places.
Extents<double> box_of(const PackedView& view) {
    Extents<double> box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
    if (view.voxels.cell.empty()) return box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<std::uint16_t> steps;
        for (const auto& cell : view.voxels.cell) steps.push_back(cell[axis]);
        const auto at = [&](std::size_t hundredths) {
            return view.origin_m[axis] +
                   view.step_m[axis] * ranked(steps, (steps.size() - 1) * hundredths / 100);
        };
        box.low[axis] = at(2);
        box.high[axis] = at(98);
    }
    return box;
}

// Means over 3 x 3 pixels.
std::vector<float> blurred(const std::vector<float>& from, int width, int height) {
    std::vector<float> to(from.size());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double sum = 0;
            for (int n = 0; n < 9; ++n) {
                const int px = std::clamp(x + n % 3 - 1, 0, width - 1);
                const int py = std::clamp(y + n / 3 - 1, 0, height - 1);
                sum += double{from[py * width + px]};
            }
            to[y * width + x] = static_cast<float>(sum / 9);
        }
    }
    return to;
}

}  // namespace

SceneImage::SceneImage(const Scene& scene, const PackedView& view, int width, int height,
                       const std::array<double, 4>& margin)
    : view_(view), width_(width), height_(height), solids_(fine * width, fine * height) {
    for (const auto& object : scene.objects) {
        if (object.grounded) grounded_.insert(object.id);
    }
    const Extents<double> box = box_of(view);
    const Vec3 size = minus(box.high, box.low);
    reach_m_ = std::max(std::hypot(size[0], size[1], size[2]), 0.05);
    camera_ = camera_on(box, width, height, margin);
    fine_camera_ = camera_;
    fine_camera_.focal *= fine;
    fine_camera_.x0 *= fine;
    fine_camera_.y0 *= fine;
    draw_solids();
    find_seen();
    find_crevices();
    open_ = blurred(blurred(open_, width_, height_), width_, height_);
}

void SceneImage::draw_solids() {
    constexpr std::array<Vec3, 6> normals{
        {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
    constexpr Vec3 sun{-0.13, -0.43, 0.89};
    for (std::size_t n = 0; n < view_.voxels.cell.size(); ++n) {
        const auto& cell = view_.voxels.cell[n];
        const auto& aux = view_.voxels.aux[n];
        Vec3 centre{};
        const Vec3 seen{double(aux[0]), double(aux[1]), double(aux[2])};
        for (std::size_t axis = 0; axis < 3; ++axis)
            centre[axis] = view_.origin_m[axis] + view_.step_m[axis] * cell[axis];
        const Vec3 to_eye = along(camera_.eye, -1, centre);
        const std::int32_t object = view_.groups[cell[3]].second;
        const bool background = object < 0 || grounded_.contains(object);
        // A wall or ceiling that is seen from behind would hide the room.
        if (background && dot(seen, to_eye) < 0) continue;
        const Vec3 smooth = topple::unit(seen);  // zero where it is not known
        for (std::size_t face = 0; face < 6; ++face) {
            const Vec3& normal = normals[face];
            if (!(aux[3] >> face & 1) || dot(normal, to_eye) <= 0) continue;
            // The mean normal of what was seen there smooths the voxels' steps.
            const Vec3 facing =
                topple::unit(along(normal, dot(smooth, normal) < 0 ? -2 : 2, smooth));
            const Vec3& side = normals[(face + 2) % 6 / 2 * 2 + 1];
            const Vec3& other = normals[(face + 4) % 6 / 2 * 2 + 1];
            add_face(centre, normal, side, other,
                     {static_cast<std::uint32_t>(n), cell[3],
                      static_cast<float>(0.77 + 0.25 * dot(facing, sun))});
        }
    }
}

void SceneImage::add_face(const Vec3& centre, const Vec3& normal, const Vec3& side,
                          const Vec3& other, const Face& face) {
    // A little over its edge, so that rounding opens no cracks between neighbours.
    const double half = 0.505 * view_.cube_m;
    std::array<Vec3, 4> corner;
    for (std::size_t n = 0; n < 4; ++n) {
        corner[n] = along(along(along(centre, half, normal), n == 0 || n == 3 ? -half : half, side),
                          n < 2 ? -half : half, other);
    }
    const auto what = static_cast<std::uint32_t>(faces_.size());
    faces_.push_back(face);
    solids_.triangle(fine_camera_, corner[0], corner[1], corner[2], what);
    solids_.triangle(fine_camera_, corner[0], corner[2], corner[3], what);
}

void SceneImage::find_seen() {
    constexpr std::size_t few = 8;
    std::map<std::int32_t, std::size_t> pixels;
    for (std::size_t at = 0; at < solids_.index(0, solids_.height()); ++at) {
        const std::int32_t object = object_at(at);
        if (object >= 0 && ++pixels[object] == few) seen_.insert(object);
    }
}

// Corners and what lies under things are darker: a share of the places around each pixel that are
// nearer to the camera, but not by much.
void SceneImage::find_crevices() {
    std::array<std::array<double, 2>, 16> around;  // directions, to hundredths
    for (std::size_t n = 0; n < around.size(); ++n) {
        const double angle = std::numbers::pi * static_cast<double>(n) / 8;
        around[n] = {std::round(100 * std::cos(angle)) / 100,
                     std::round(100 * std::sin(angle)) / 100};
    }
    const double radius_m = 0.025 * reach_m_;
    open_.assign(static_cast<std::size_t>(width_ * height_), 1);
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const std::size_t at = solids_.index(fine * x, fine * y);
            if (solids_.what(at) == DepthImage::nothing) continue;
            const double depth = solids_.depth(at), radius = fine_camera_.focal * radius_m / depth;
            double nearer = 0;
            for (std::size_t n = 0; n < around.size(); ++n) {
                const double length = radius * (n % 2 == 0 ? 1.0 : 0.5);
                const int px = fine * x + static_cast<int>(length * around[n][0]);
                const int py = fine * y + static_cast<int>(length * around[n][1]);
                if (px < 0 || py < 0 || px >= solids_.width() || py >= solids_.height()) continue;
                // Against the place opposite to it, so that a slope is no crevice.
                const int qx = 2 * fine * x - px, qy = 2 * fine * y - py;
                if (qx < 0 || qy < 0 || qx >= solids_.width() || qy >= solids_.height()) continue;
                const double before = depth - solids_.depth(solids_.index(px, py));
                const double behind = solids_.depth(solids_.index(qx, qy)) - depth;
                const double step = before - std::clamp(behind, -radius_m, radius_m);
                if (before < 1.2 * radius_m) nearer += std::clamp(step / radius_m, 0.0, 1.0);
            }
            open_[y * width_ + x] = static_cast<float>(1 - nearer / double(around.size()));
        }
    }
}

void SceneImage::Overlay::triangle(const Vec3& a, const Vec3& b, const Vec3& c,
                                   const Rgb8& colour) {
    const auto what = static_cast<std::uint32_t>(image_.faces_.size() + colours_.size());
    colours_.push_back(colour);
    front_.triangle(image_.fine_camera_, a, b, c, what);
}

// The movable object that is seen there, or -1.
std::int32_t SceneImage::object_at(std::size_t at) const {
    const std::uint32_t what = solids_.what(at);
    if (what == DepthImage::nothing) return -1;
    const std::int32_t object = view_.groups[faces_[what].group].second;
    return grounded_.contains(object) ? -1 : object;
}

// Whether a movable object ends there against what is behind it.
bool SceneImage::is_rim(std::size_t at) const {
    const auto width = static_cast<std::size_t>(solids_.width()),
               height = static_cast<std::size_t>(solids_.height());
    const std::size_t x = at % width, y = at / width;
    const std::int32_t object = object_at(at);
    if (object < 0 || x == 0 || y == 0 || x + 1 == width || y + 1 == height) return false;
    for (const std::size_t beside : {at - 1, at + 1, at - width, at + width}) {
        if (object_at(beside) != object && !(solids_.depth(beside) < solids_.depth(at)))
            return true;
    }
    return false;
}

Raster SceneImage::shaded(const std::vector<Rgb8>& colour_of_group, const Overlay& overlay,
                          const OwnColour& own) const {
    constexpr Colour top{0.914, 0.929, 0.945}, bottom{0.973, 0.976, 0.98};
    const DepthImage& front = overlay.front_;
    Raster out(width_, height_, bottom);
    for (int y = 0; y < height_; ++y) {
        const double down = double(y) / height_;
        const Colour behind{top.red + (bottom.red - top.red) * down,
                            top.green + (bottom.green - top.green) * down,
                            top.blue + (bottom.blue - top.blue) * down};
        for (int x = 0; x < width_; ++x) {
            const double open{open_[y * width_ + x]};
            Colour sum;
            for (int part = 0; part < fine * fine; ++part) {
                const std::size_t at = front.index(fine * x + part % fine, fine * y + part / fine);
                std::uint32_t what = front.what(at);
                if (what == DepthImage::nothing) what = solids_.what(at);
                Colour c = behind;
                if (what < faces_.size()) {
                    const Face& face = faces_[what];
                    const double light =
                        double{face.light} * (0.45 + 0.55 * open) * (is_rim(at) ? 0.5 : 1.0);
                    const auto mine = own ? own(view_.voxels.at(face.voxel)) : std::nullopt;
                    c = colour(mine.value_or(colour_of_group[face.group]));
                    c = {c.red * light, c.green * light, c.blue * light};
                } else if (what != DepthImage::nothing) {
                    c = colour(overlay.colours_[what - faces_.size()]);
                }
                sum = {sum.red + c.red, sum.green + c.green, sum.blue + c.blue};
            }
            constexpr double share = 1.0 / (fine * fine);
            out.at(x, y) = {sum.red * share, sum.green * share, sum.blue * share};
        }
    }
    return out;
}

}  // namespace topple::report
