// SPDX-License-Identifier: MIT
#include "report/field_slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/number_text.h"
#include "core/ranked.h"
#include "core/vectors.h"
#include "report/canvas.h"
#include "report/drawing.h"
#include "safety/disturbances.h"

namespace topple::report {
namespace {

constexpr std::array<double, 3> heights_m{0.3, 0.9, 1.5};
constexpr int page_width = 1280, left = 20, top = 96, between = 20, below = 70;
constexpr int panel_width = (page_width - 2 * left - 2 * between) / 3;
constexpr int tallest_panel = 640;

// Cells of a lattice seen from above.
struct Extent {
    std::array<std::int32_t, 2> low{std::numeric_limits<std::int32_t>::max(),
                                    std::numeric_limits<std::int32_t>::max()},
        high{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min()};
    void take(std::int32_t i, std::int32_t j) {
        low = {std::min(low[0], i), std::min(low[1], j)};
        high = {std::max(high[0], i), std::max(high[1], j)};
    }
    int wide() const { return high[0] - low[0] + 1; }
    int tall() const { return high[1] - low[1] + 1; }
};

class Slices {
  public:
    Slices(const SpaceField& field, double floor_m, const SolidVoxels& solid)
        : field_(field), floor_m_(floor_m) {
        for (std::size_t n = 0; n < solid.x.size(); ++n)
            solid_.push_back(cell_at({solid.x[n], solid.y[n], solid.z[n]}));
        for (const auto& [i, j, k] : field.cell) extent_.take(i, j);
        for (const auto& [i, j, k] : solid_)
            extent_.take(i, j);  // so that all fields show the same
        pixels_ =
            std::max(1, std::min(panel_width / extent_.wide(), tallest_panel / extent_.tall()));
    }

    int page_height() const { return top + panel_height() + below; }
    void draw(Canvas& canvas, double strongest) {
        for (std::size_t n = 0; n < heights_m.size(); ++n) {
            const int x = left + static_cast<int>(n) * (panel_width + between);
            draw_panel(canvas, x, heights_m[n], strongest);
        }
    }

    // How long a metre is, and a line of the mean velocity.
    void draw_metre(Canvas& canvas, double x, double y) const {
        const double metre = pixels_ / length(field_.along_m[0]);
        for (const double end : {x, x + metre})
            canvas.line(end, y - 5, end, y + 5, {0.1, 0.1, 0.1});
        canvas.line(x, y, x + metre, y, {0.1, 0.1, 0.1});
        canvas.text(x, y + 23,
                    "1 m; the longest line of a slice is the fastest, " +
                        to_digits(fastest_m_s_, 2) + " m/s at most",
                    Align::left);
    }

  private:
    int panel_height() const { return pixels_ * extent_.tall(); }
    std::array<std::int32_t, 3> cell_at(const Vec3& p) const {
        std::array<std::int32_t, 3> out{};
        const Vec3 from = minus(p, field_.corner_m);
        for (std::size_t a = 0; a < 3; ++a)
            out[a] = static_cast<std::int32_t>(std::floor(
                dot(from, field_.along_m[a]) / dot(field_.along_m[a], field_.along_m[a])));
        return out;
    }
    // The first axis goes to the right, the second upwards.
    std::array<int, 2> corner_of(std::int32_t i, std::int32_t j) const {
        return {(i - extent_.low[0]) * pixels_, (extent_.high[1] - j) * pixels_};
    }
    void fill(Raster& raster, std::int32_t i, std::int32_t j, const Colour& with) const {
        const auto [x0, y0] = corner_of(i, j);
        for (int y = 0; y < pixels_; ++y)
            for (int x = 0; x < pixels_; ++x) raster.at(x0 + x, y0 + y) = with;
    }

    void draw_panel(Canvas& canvas, int x0, double height_m, double strongest) {
        const double edge = length(field_.along_m[0]);
        const auto layer = static_cast<std::int32_t>(std::floor((floor_m_ + height_m) / edge));
        Raster raster(pixels_ * extent_.wide(), panel_height(), {0.975, 0.975, 0.97});
        std::vector<std::size_t> here;
        for (std::size_t n = 0; n < field_.size(); ++n) {
            const auto& [i, j, k] = field_.cell[n];
            if (k != layer) continue;
            here.push_back(n);
            fill(raster, i, j, colour(ramp_colour(field_.frequency[n] / strongest)));
        }
        for (const auto& [i, j, k] : solid_)
            if (k == layer) fill(raster, i, j, {0.62, 0.63, 0.64});
        canvas.image(x0, top, raster);
        canvas.text(x0, top - 8, to_places(height_m, 1) + " m above the floor", Align::left,
                    {.size = 13});
        draw_velocities(canvas, x0, here);
    }

    // One line in so many cells, from the cell's middle; the fastest is as long as their distance.
    void draw_velocities(Canvas& canvas, int x0, const std::vector<std::size_t>& here) {
        const int apart = std::max(1, 18 / pixels_);
        double fastest = 0;
        for (const std::size_t n : here) fastest = std::max(fastest, level_speed(n));
        if (!(fastest > 0)) return;
        fastest_m_s_ = std::max(fastest_m_s_, fastest);
        for (const std::size_t n : here) {
            const auto& [i, j, k] = field_.cell[n];
            if (i % apart != 0 || j % apart != 0) continue;
            const auto [cx, cy] = corner_of(i, j);
            const double x = x0 + cx + pixels_ / 2.0, y = top + cy + pixels_ / 2.0;
            const double reach = 1.1 * apart * pixels_ / fastest;
            const auto& v = field_.velocity_m_s[n];
            const Vec3 velocity{v[0], v[1], v[2]};
            canvas.disc(x, y, 1.3, {0.05, 0.05, 0.05});
            canvas.line(x, y, x + reach * dot(velocity, topple::unit(field_.along_m[0])),
                        y - reach * dot(velocity, topple::unit(field_.along_m[1])),
                        {0.05, 0.05, 0.05});
        }
    }
    double level_speed(std::size_t n) const {
        const auto& v = field_.velocity_m_s[n];
        return length({v[0], v[1], v[2]});
    }

    const SpaceField& field_;
    double floor_m_;                                  // above the lattice's corner
    std::vector<std::array<std::int32_t, 3>> solid_;  // cells of solid voxels
    Extent extent_;
    int pixels_ = 1;          // along a cell's edge
    double fastest_m_s_ = 0;  // of what was drawn
};

// Of the lowest cells that anything passes, above the lattice's corner.
double lowest_m(const SpaceField& field) {
    std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
    for (const auto& cell : field.cell) lowest = std::min(lowest, cell[2]);
    return lowest * length(field.along_m[2]);
}

// Rather than that it is as strong all ways.
bool flows(const SpaceField& field) {
    return std::ranges::any_of(field.velocity_m_s, [](const std::array<float, 3>& v) {
        return v != std::array<float, 3>{};
    });
}

// What nearly all of a field stays below.
double strongest_of(const SpaceField& field) {
    std::vector<float> all = field.frequency;
    return std::max<double>(ranked(all, (all.size() - 1) * 98 / 100), 1e-9);
}

}  // namespace

void write_field_slices(const std::filesystem::path& folder,
                        const std::map<std::string, SpaceField>& fields, const Scene& scene) {
    // Where people walk is the floor of all.
    const auto walked = fields.find("human");
    for (const auto& [name, field] : fields) {
        const safety::DisturbanceKind* kind = safety::find_disturbance_kind(name);
        if (!kind || field.size() == 0 || !flows(field)) continue;
        double floor_m = lowest_m(field);
        if (walked != fields.end() && walked->second.size() > 0)
            floor_m = lowest_m(walked->second) + dot(minus(walked->second.corner_m, field.corner_m),
                                                     topple::unit(field.along_m[2]));
        Slices slices(field, floor_m, scene.solid);
        const double strongest = strongest_of(field);
        Canvas canvas(folder / ("field-" + name + ".png"), page_width, slices.page_height());
        canvas.text(left, 34, std::string(kind->words.arrows.title) + ", over space", Align::left,
                    {.size = 22, .bold = true});
        canvas.text(left, 58,
                    "Level slices. Colour: how often something passes in one " +
                        std::string(kind->words.event) +
                        "; lines: the mean of its velocities, from the dot; grey: solid; white: "
                        "nothing comes there.",
                    Align::left, {.size = 13, .colour = {0.36, 0.4, 0.44}});
        slices.draw(canvas, strongest);
        const double y = slices.page_height() - 50;
        for (int n = 0; n < 220; ++n)
            canvas.rectangle(left + n, y, 1, 12, colour(ramp_colour(n / 219.0)));
        canvas.text(left, y + 29, "0", Align::left);
        canvas.text(left + 220, y + 29, to_digits(strongest, 2) + " or more", Align::right);
        slices.draw_metre(canvas, left + 300, y + 6);
        canvas.save();
    }
}

}  // namespace topple::report
