// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "lab/evaluation/pictures.h"
#include "lab/evaluation/rigid.h"
#include "lab/parallel.h"
#include "lab/solids/measure.h"
#include "report/canvas.h"
#include "vdb/voxel_scene.h"

namespace topple::evaluation {
namespace {

using report::Align;
using report::Canvas;
using report::Colour;
using report::Raster;

constexpr double pixels_per_m = 130, beyond_m = 0.1;

constexpr Colour seen_empty{1, 1, 1}, unseen{0.83, 0.83, 0.83}, surface{0.2, 0.22, 0.28},
    filled_right{0.0, 0.62, 0.45}, filled_wrong{0.84, 0.15, 0.1}, missed{0.95, 0.7, 0.2};

// What is true and what was found at a place of the room.
class Probe {
  public:
    explicit Probe(const Room& room)
        : room_(room), voxels_(*room.parse.voxels), parts_(scenes::measures(room.world)) {}

    Colour at(const Vec3& p) const {
        const double h = voxels_.frame().voxel_m;
        const bool solid = distance(p, h, false) < -0.25 * h;
        switch (state(p)) {
            case vdb::State::surface:
                return surface;
            case vdb::State::completed:
                return distance(p, h, true) <= 0.87 * h ? filled_right : filled_wrong;
            case vdb::State::invisible:
                return solid ? missed : unseen;
            case vdb::State::empty:
                break;
        }
        return solid ? missed : seen_empty;
    }

  private:
    // To the nearest part, of the room or not, where that is nearer than `far`; else `far`.
    double distance(const Vec3& p, double far, bool with_room) const {
        double best = far;
        for (const scenes::Measure& m : parts_) {
            if ((with_room || m.part().object != 0) && m.near(p, far))
                best = std::min(best, m.at(p));
        }
        return best;
    }
    vdb::State state(const Vec3& p) const {
        const Vec3 q = moved_back(room_.input_from_grid, room_.world.to_input(p));
        const vdb::VoxelFrame& frame = voxels_.frame();
        std::array<std::int32_t, 3> at{};
        for (std::size_t a = 0; a < 3; ++a) {
            const Vec3& axis = frame.grid_from_input[a];
            const double g = axis[0] * q[0] + axis[1] * q[1] + axis[2] * q[2];
            at[a] = static_cast<std::int32_t>(std::floor(g / frame.voxel_m));
        }
        return voxels_.state_at(at[0], at[1], at[2]);
    }

    const Room& room_;
    const vdb::VoxelScene& voxels_;
    std::vector<scenes::Measure> parts_;
};

// Where a plane across `axis` cuts most of the parts' bounding boxes, in steps of 1 cm.
double fullest_plane(const scenes::World& world, std::size_t axis) {
    double best = 0, most = -1;
    for (double at = 0.05; at < world.room[axis] - 0.05; at += 0.01) {
        double area = 0;
        for (const scenes::Part& part : world.parts) {
            const auto box = part.bounds();
            if (part.object == 0 || at <= box[0][axis] || at >= box[1][axis]) continue;
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            area += (box[1][u] - box[0][u]) * (box[1][v] - box[0][v]);
        }
        if (area > most) {
            most = area;
            best = at;
        }
    }
    return best;
}

// The plane where coordinate `axis` is `level`; `across` runs to the right, `up` upwards.
Raster slice(const Room& room, const Probe& probe, std::size_t axis, double level,
             std::size_t across, std::size_t up) {
    const auto pixels = [&](std::size_t a) {
        return static_cast<int>(pixels_per_m * (room.world.room[a] + 2 * beyond_m));
    };
    Raster raster(pixels(across), pixels(up), seen_empty);
    scenes::in_parallel(
        static_cast<std::size_t>(raster.height), [&](std::size_t first, std::size_t last) {
            for (auto y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
                for (int x = 0; x < raster.width; ++x) {
                    Vec3 p{};
                    p[axis] = level;
                    p[across] = (x + 0.5) / pixels_per_m - beyond_m;
                    p[up] = (raster.height - y - 0.5) / pixels_per_m - beyond_m;
                    raster.at(x, y) = probe.at(p);
                }
            }
        });
    return raster;
}

void draw_legend(Canvas& canvas, double x, double y) {
    struct Entry {
        const char* text;
        Colour colour;
    };
    for (const Entry& e :
         {Entry{"surface seen", surface}, Entry{"filled, solid in truth", filled_right},
          Entry{"filled, empty in truth", filled_wrong}, Entry{"solid in truth, missed", missed},
          Entry{"not seen", unseen}, Entry{"seen to be empty", seen_empty}}) {
        canvas.rectangle(x - 1, y - 13, 16, 16, surface);
        canvas.rectangle(x, y - 12, 14, 14, e.colour);
        canvas.text(x + 24, y, e.text, Align::left);
        y += 24;
    }
}

}  // namespace

void draw_slices(const Room& room, const std::filesystem::path& path) {
    const Probe probe(room);
    const auto cut = [&](std::size_t axis, std::size_t across, std::size_t up) {
        const double level = fullest_plane(room.world, axis);
        char title[64];
        std::snprintf(title, sizeof(title), "%c = %.2f m", "xyz"[axis], level);
        return std::pair(std::string(title), slice(room, probe, axis, level, across, up));
    };
    const auto level = cut(2, 0, 1), along = cut(1, 0, 2), across = cut(0, 1, 2);
    constexpr int gap = 20, title = 30;
    const int right = gap + level.second.width + gap;
    const int below = title + along.second.height + gap;
    const int width = right + std::max(along.second.width, across.second.width) + gap;
    const int height =
        std::max(title + level.second.height, below + title + across.second.height) + gap;
    Canvas canvas(path, width, height + 160);
    const auto put = [&](int x, int y, const auto& one) {
        canvas.text(x, y + 22, one.first, Align::left, {.size = 16, .bold = true});
        canvas.image(x, y + title, one.second);
    };
    put(gap, 0, level);
    put(right, 0, along);
    put(right, below, across);
    draw_legend(canvas, gap, height + 12);
    canvas.save();
}

}  // namespace topple::evaluation
