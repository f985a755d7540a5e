// SPDX-License-Identifier: MIT
#include "report/pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "core/number_text.h"
#include "core/ranked.h"
#include "core/rotation.h"
#include "io/palette.h"
#include "report/scene_image.h"
#include "safety/disturbances.h"
#include "safety/largest_risk.h"

namespace topple::report {
namespace {

using Overlay = SceneImage::Overlay;

constexpr int width = 1280, height = 800;
constexpr std::array<double, 4> margin{24, 24, 76, 24};
constexpr std::size_t labelled = 10;

Rgb8 faded(const Rgb8& colour, double share) {
    return colour_along(std::array{colour, Rgb8{222, 223, 222}}, share);
}

// What can fall, is not among the safest and is seen, the largest risk first, as far as it is
// labelled: a label of what a wall hides would stand on the wall.
std::vector<const Object*> riskiest(const Scene& scene, const SceneImage& image) {
    using safety::largest_risk;
    constexpr double least_unsafety = 2;
    std::vector<const Object*> out;
    for (const Object& object : scene.objects) {
        if (!object.grounded && object.unsafety >= least_unsafety &&
            largest_risk(object).risk_J > 0 && image.sees(object.id))
            out.push_back(&object);
    }
    std::ranges::stable_sort(out, std::ranges::greater{},
                             [](const Object* o) { return largest_risk(*o).risk_J; });
    out.resize(std::min(out.size(), labelled));
    return out;
}

class Pictures {
  public:
    Pictures(const std::filesystem::path& folder, const Scene& scene)
        : folder_(folder),
          scene_(scene),
          view_(pack_view(
              scene,
              {.voxels = std::numeric_limits<std::size_t>::max(), .points = 0, .arrows = 700})),
          image_(scene, view_, width, height, margin) {}

    void write() {
        if (view_.coloured) write_photo();
        write_parts();
        write_completed();
        write_objects();
        write_risk();
        write_walks();
        for (const auto& [name, arrows] : view_.fields) {
            if (!arrows.arrow.empty()) write_field(name, arrows.arrow);
        }
    }

  private:
    // The colour of each group; `fade` is how far movable things step back.
    std::vector<Rgb8> colours(bool by_risk, double fade) const {
        std::vector<Rgb8> out;
        for (const auto& [primitive, id] : view_.groups) {
            const auto found = std::ranges::find(scene_.objects, id, &Object::id);
            const bool movable = found != scene_.objects.end() && !found->grounded;
            if (!movable) {
                out.push_back(faded(io::colour_of(-1), 0.8));
            } else if (by_risk) {
                out.push_back(std::isfinite(found->unsafety)
                                  ? colour_along(unsafety_ramp, (found->unsafety - 1) / 9)
                                  : unranked_colour);
            } else {
                out.push_back(faded(io::colour_of(id), fade));
            }
        }
        return out;
    }

    void write_photo() {
        save(page("photo", colours(false, 1), Overlay(image_), "Photo",
                  "The scan's own colours; what it does not show has those around it. "
                  "Labels: the riskiest objects and their unsafety.",
                  [](const Record& voxel) -> std::optional<Rgb8> {
                      const auto& [red, green, blue, known] = voxel.photo;
                      if (known == 0) return std::nullopt;
                      return Rgb8{red, green, blue};
                  }),
             true);
    }

    void write_parts() {
        std::vector<Rgb8> of_group;
        for (const auto& [primitive, id] : view_.groups)
            of_group.push_back(io::colour_of(primitive));
        page("parts", of_group, Overlay(image_), "Parts",
             "Each colour is one primitive: what geometry alone tells apart. Objects are joined "
             "from these.")
            .save();
    }

    void write_completed() {
        constexpr Rgb8 completed{232, 120, 40};
        Canvas canvas = page(
            "completed", std::vector<Rgb8>(view_.groups.size(), Rgb8{150, 160, 172}),
            Overlay(image_), "What was seen, and what was completed",
            "The scan shows the surface alone; what is solid behind it, or hidden, is inferred.",
            [&](const Record& voxel) -> std::optional<Rgb8> {
                constexpr int inferred = 1 << 6;
                if ((voxel.aux[3] & inferred) == 0) return std::nullopt;
                return completed;
            });
        swatch(canvas, completed, "completed");
        canvas.save();
    }

    void write_objects() {
        save(page("objects", colours(false, 0), Overlay(image_), "Objects",
                  "Each colour is one body that moves as a whole. Grey: the ground and "
                  "what is fixed to it. Numbers: the riskiest objects."),
             false);
    }

    void write_risk() {
        Canvas canvas =
            page("risk", colours(true, 0), Overlay(image_), "Risk",
                 "Unsafety, by what a walk, a gale or an earthquake is expected to set "
                 "free. Labels: object, unsafety; ?: the scan hardly shows its support.");
        legend(canvas, unsafety_ramp, "1 safest", "10");
        const auto unranked = [](const Object& o) {
            return !o.grounded && !std::isfinite(o.unsafety);
        };
        if (std::ranges::any_of(scene_.objects, unranked))
            swatch(canvas, unranked_colour, "not ranked: nothing was seen to hold it");
        save(std::move(canvas), true);
    }

    void write_walks() {
        const PackedWalks& walks = view_.walks;
        Overlay overlay(image_);
        // Above the voxels of the floor.
        const double lift = 0.8 * view_.cube_m;
        for (std::size_t at = 0; at < walks.shade.size(); ++at) {
            if (walks.shade[at] == 0) continue;
            const auto x = static_cast<std::int64_t>(at) % walks.nx,
                       y = static_cast<std::int64_t>(at) / walks.nx;
            Vec3 corner = along(along(walks.corner_m, double(x), walks.along_x_m), double(y),
                                walks.along_y_m);
            corner[2] += walks.floor_mm[at] / 1000.0 + lift;
            quad(overlay, corner, walks.along_x_m, walks.along_y_m,
                 ramp_colour((walks.shade[at] - 1) / 254.0));
        }
        if (std::ranges::none_of(walks.shade, [](std::uint8_t s) { return s > 0; })) return;
        for (const auto& path : walks.paths) add_path(overlay, path, 1.6 * lift);
        Canvas canvas = page("walks", colours(false, 0.6), overlay, "Where people walk",
                             "The floor by how many of 100 walks pass there; white: the ways of "
                             "some walks.");
        legend(canvas, ramp, "0", to_digits(100 * walks.most, 3) + " of 100 walks");
        canvas.save();
    }

    void add_path(Overlay& overlay, const std::vector<std::array<float, 3>>& path, double lift) {
        const double half = 0.0006 * image_.reach_m();
        for (std::size_t n = 0; n + 1 < path.size(); ++n) {
            const Vec3 a{path[n][0], path[n][1], path[n][2] + lift};
            const Vec3 b{path[n + 1][0], path[n + 1][1], path[n + 1][2] + lift};
            const Vec3 step = minus(b, a);
            const double level = std::hypot(step[0], step[1]);
            if (!(level > 0)) continue;
            const Vec3 side{-step[1] / level * 2 * half, step[0] / level * 2 * half, 0};
            quad(overlay, along(a, -0.5, side), step, side, {255, 255, 255});
        }
    }

    static void quad(Overlay& overlay, const Vec3& corner, const Vec3& a, const Vec3& b,
                     const Rgb8& colour) {
        const Vec3 far = along(along(corner, 1, a), 1, b);
        overlay.triangle(corner, along(corner, 1, a), far, colour);
        overlay.triangle(corner, far, along(corner, 1, b), colour);
    }

    void write_field(const std::string& name, const std::vector<std::array<float, 7>>& arrows) {
        const auto* kind = safety::find_disturbance_kind(name);
        if (!kind) return;  // of another version of topple
        using Arrows = safety::DisturbanceWords::Arrows;
        const Arrows& style = kind->words.arrows;
        std::vector<double> strength;
        for (const auto& a : arrows) {
            const double length = topple::length({a[3], a[4], a[5]});
            strength.push_back(style.strength == Arrows::Strength::visits ? a[6]
                               : style.strength == Arrows::Strength::mean ? length * a[6]
                                                                          : length);
        }
        std::vector<double> all = strength;
        const double strongest = ranked(all, (all.size() - 1) * 95 / 100);
        Overlay overlay(image_, style.below_things);
        for (std::size_t n = 0; n < arrows.size(); ++n) {
            const double share = strongest > 0 ? std::min(strength[n] / strongest, 1.0) : 1.0;
            add_arrow(overlay, arrows[n], share, style.at_tip ? 1 : 0);
        }
        Canvas canvas = page(name, colours(false, 0.6), overlay, style.title, style.says);
        legend(canvas, ramp, "0", to_digits(style.scale * strongest, 3) + " " + style.unit);
        canvas.save();
    }

    // A shaft and a head with five sides; its place is at `tip`, from 0 at its foot to 1.
    void add_arrow(Overlay& overlay, const std::array<float, 7>& arrow, double share, double tip) {
        const Vec3 velocity{arrow[3], arrow[4], arrow[5]};
        const double speed = length(velocity);
        if (!(speed > 0)) return;
        const Vec3 ahead = topple::unit(velocity);
        const Vec3 aside = std::abs(ahead[2]) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
        const Vec3 side = topple::unit(cross(ahead, aside));
        const Vec3 other = cross(ahead, side), from{arrow[0], arrow[1], arrow[2]};
        const double size =
            std::clamp(0.035 * image_.reach_m(), 0.05, 0.35) * (0.35 + 0.65 * share);
        const double thickness = 0.17 * size;
        constexpr int sides = 5;
        const auto place = [&](double radius, double z, int n) {
            const double angle = 2 * std::numbers::pi * n / sides;
            return along(along(along(from, (z - tip) * size, ahead),
                               radius * thickness * std::cos(angle), side),
                         radius * thickness * std::sin(angle), other);
        };
        const Rgb8 colour = ramp_colour(share);
        constexpr std::array<std::array<double, 2>, 4> rings{
            {{0.22, 0}, {0.22, 0.55}, {0.75, 0.55}, {0.01, 1}}};
        for (int n = 0; n < sides; ++n) {
            const double angle = 2 * std::numbers::pi * (n + 0.5) / sides;
            const double light =
                0.8 + 0.2 * (side[2] * std::cos(angle) + other[2] * std::sin(angle));
            Rgb8 lit{};
            for (std::size_t c = 0; c < 3; ++c)
                lit[c] = static_cast<std::uint8_t>(std::lround(colour[c] * light));
            for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
                const auto [r0, z0] = rings[ring];
                const auto [r1, z1] = rings[ring + 1];
                overlay.triangle(place(r0, z0, n), place(r0, z0, n + 1), place(r1, z1, n + 1), lit);
                overlay.triangle(place(r0, z0, n), place(r1, z1, n + 1), place(r1, z1, n), lit);
            }
        }
    }

    Canvas page(const std::string& name, const std::vector<Rgb8>& colour_of_group,
                const Overlay& overlay, const std::string& title, const std::string& says,
                const SceneImage::OwnColour& own = nullptr) {
        boxes_.clear();
        Canvas canvas(folder_ / ("view-" + name + ".png"), width, height);
        canvas.image(0, 0, image_.shaded(colour_of_group, overlay, own));
        headline(canvas, 34, title, {.size = 22, .bold = true});
        headline(canvas, 58, says, {.size = 14, .colour = {0.36, 0.4, 0.44}});
        return canvas;
    }

    // With the labels of the riskiest objects, and with their unsafety.
    void save(Canvas canvas, bool unsafety) {
        for (const Object* object : riskiest(scene_, image_)) label(canvas, *object, unsafety);
        canvas.save();
    }

    // Strays of the scan may lie behind it.
    static void headline(Canvas& canvas, double base, const std::string& says, const Font& font) {
        constexpr Colour behind{0.917, 0.931, 0.947};
        canvas.rectangle(14, base - font.size, canvas.text_width(says, font) + 12, 1.35 * font.size,
                         behind);
        canvas.text(20, base, says, Align::left, font);
    }

    void legend(Canvas& canvas, std::span<const Rgb8> stops, const std::string& low,
                const std::string& high) const {
        constexpr double x = 20, y = height - 50, wide = 220, tall = 12;
        for (int n = 0; n < static_cast<int>(wide); ++n)
            canvas.rectangle(x + n, y, 1, tall, colour(colour_along(stops, n / (wide - 1))));
        canvas.text(x, y + tall + 17, low, Align::left, {.size = 13});
        canvas.text(x + wide, y + tall + 17, high, Align::right, {.size = 13});
    }

    // Above the legend.
    static void swatch(Canvas& canvas, const Rgb8& of, const std::string& says) {
        constexpr double x = 20, y = height - 76, side = 14;
        canvas.rectangle(x, y, side, side, colour(of));
        canvas.text(x + side + 8, y + side - 2, says, Align::left, {.size = 13});
    }

    // The object's number, and its unsafety, where its middle is seen; moved up from others'.
    void label(Canvas& canvas, const Object& object, bool unsafety) {
        const auto [x, y, depth] =
            image_.camera().project(turned(view_.view_from_input, object.center_of_mass_m));
        if (!(depth > 0 && x > 0 && x < width && y > 0 && y < height)) return;
        const std::string number = std::to_string(object.id);
        std::string says = number;
        if (unsafety)
            says +=
                ": " + to_places(object.unsafety, 1) + (barrier_within_error(object) ? " ?" : "");
        const Font font{.size = 14, .bold = true};
        const double wide = canvas.text_width(says, font) + 12, tall = 21;
        std::array<double, 4> box{x - wide / 2, y - tall / 2, wide, tall};
        const auto overlaps = [&](const std::array<double, 4>& b) {
            return box[0] < b[0] + b[2] && b[0] < box[0] + box[2] && box[1] < b[1] + b[3] &&
                   b[1] < box[1] + box[3];
        };
        while (std::ranges::any_of(boxes_, overlaps)) box[1] -= 4;
        boxes_.push_back(box);
        canvas.rectangle(box[0] - 1, box[1] - 1, wide + 2, tall + 2, {0.11, 0.13, 0.15});
        canvas.rectangle(box[0], box[1], wide, tall, {1, 1, 1});
        canvas.text(x, box[1] + 15.5, says, Align::middle, font);
    }

    const std::filesystem::path& folder_;
    const Scene& scene_;
    PackedView view_;
    SceneImage image_;
    std::vector<std::array<double, 4>> boxes_;  // of the labels of the page at hand
};

}  // namespace

void write_pictures(const std::filesystem::path& folder, const Scene& scene) {
    Pictures(folder, scene).write();
}

}  // namespace topple::report
