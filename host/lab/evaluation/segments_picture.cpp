// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "core/vectors.h"
#include "io/palette.h"
#include "lab/evaluation/pictures.h"
#include "lab/scores/score.h"
#include "report/canvas.h"

namespace topple::evaluation {
namespace {

using report::Align;
using report::Canvas;
using report::Colour;
using report::colour;
using report::Raster;

constexpr int panel_width = 860, panel_height = 600, title_height = 34;
constexpr double point_m = 0.014;  // edge of the square that a point is drawn as

// Parallel projection of the room's frame, from above a corner, that fits the room to a panel.
class View {
  public:
    explicit View(const Vec3& room) {
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 p{corner & 1 ? room[0] : 0, corner & 2 ? room[1] : 0,
                         corner & 4 ? room[2] : 0};
            const double at[2] = {dot(right_, p), dot(down_, p)};
            for (int a = 0; a < 2; ++a) {
                low[a] = std::min(low[a], at[a]);
                high[a] = std::max(high[a], at[a]);
            }
        }
        scale_ =
            0.97 * std::min(panel_width / (high[0] - low[0]), panel_height / (high[1] - low[1]));
        x_ = panel_width / 2.0 - scale_ * (low[0] + high[0]) / 2;
        y_ = panel_height / 2.0 - scale_ * (low[1] + high[1]) / 2;
    }
    double x(const Vec3& p) const { return x_ + scale_ * dot(right_, p); }
    double y(const Vec3& p) const { return y_ + scale_ * dot(down_, p); }
    double scale() const { return scale_; }  // pixels per metre
    static double nearness(const Vec3& p) { return dot(towards_, p); }

  private:
    // An orthonormal frame: to the viewer, to the right, down.
    static constexpr Vec3 towards_{-0.36, -0.48, 0.8}, right_{0.8, -0.6, 0},
        down_{-0.48, -0.64, -0.6};
    double scale_ = 1, x_ = 0, y_ = 0;
};

// A colour for each label: that of the true segment where both are each other's best match.
std::map<std::int32_t, Colour> matched_colours(std::span<const std::int32_t> truth,
                                               std::span<const std::int32_t> found) {
    std::map<std::int32_t, std::map<std::int32_t, std::size_t>> in_found, in_truth;
    std::int32_t last = 0;
    for (std::size_t n = 0; n < truth.size(); ++n) {
        last = std::max(last, truth[n]);
        in_found[found[n]];
        if (truth[n] < 0 || found[n] < 0) continue;
        ++in_found[found[n]][truth[n]];
        ++in_truth[truth[n]][found[n]];
    }
    const auto best = [](const std::map<std::int32_t, std::size_t>& counts) {
        std::int32_t label = -1;
        std::size_t most = 0;
        for (const auto& [l, count] : counts) {
            if (count > most) {
                most = count;
                label = l;
            }
        }
        return label;
    };
    std::map<std::int32_t, Colour> out;
    for (const auto& [label, counts] : in_found) {
        const std::int32_t t = best(counts);
        const bool mutual = t >= 0 && best(in_truth[t]) == label;
        const std::int32_t id = label < 0 ? -1 : mutual ? t : last + 1 + label;
        out[label] = colour(io::colour_of(id));
    }
    return out;
}

// The points as squares with depth, those that face away left out.
Raster drawn(const Room& room, std::span<const std::int32_t> label,
             const std::map<std::int32_t, Colour>& colours) {
    const ScenePoints& points = room.parse.scene.points;
    const View view(room.world.room);
    const int size = std::max(1, static_cast<int>(std::lround(point_m * view.scale())));
    Raster raster(panel_width, panel_height, {1, 1, 1});
    std::vector<double> depth(raster.pixels.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t n = 0; n < label.size(); ++n) {
        const Vec3 normal = room.world.to_room({points.nx[n], points.ny[n], points.nz[n]});
        const double facing = View::nearness(normal);
        if (facing <= 0) continue;
        const Vec3 p = room.world.to_room({points.x[n], points.y[n], points.z[n]});
        const double shade = 0.55 + 0.45 * facing, near = View::nearness(p);
        const Colour& c = colours.at(label[n]);
        const int x0 = static_cast<int>(view.x(p)) - size / 2,
                  y0 = static_cast<int>(view.y(p)) - size / 2;
        for (int y = std::max(0, y0); y < std::min(panel_height, y0 + size); ++y) {
            for (int x = std::max(0, x0); x < std::min(panel_width, x0 + size); ++x) {
                double& d = depth[static_cast<std::size_t>(y) * panel_width + x];
                if (near <= d) continue;
                d = near;
                raster.at(x, y) = {shade * c.red, shade * c.green, shade * c.blue};
            }
        }
    }
    return raster;
}

}  // namespace

void draw_segments(const Room& room, const std::filesystem::path& path) {
    const ScenePoints& points = room.parse.scene.points;
    const auto object = scenes::true_objects(room.world, room.part);
    Canvas canvas(path, 2 * panel_width, 2 * (panel_height + title_height));
    const auto panel = [&](int column, int row, const std::string& title, const auto& truth,
                           const auto& label) {
        const double x = column * panel_width, y = row * (panel_height + title_height);
        canvas.image(x, y + title_height, drawn(room, label, matched_colours(truth, label)));
        canvas.text(x + 12, y + 24, title, Align::left, {.size = 17, .bold = true});
    };
    panel(0, 0, "true parts", room.part, room.part);
    panel(1, 0, "primitives found", room.part, points.primitive);
    panel(0, 1, "true objects", object, object);
    panel(1, 1, "objects found", object, points.object);
    canvas.save();
}

}  // namespace topple::evaluation
