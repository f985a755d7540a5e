// SPDX-License-Identifier: MIT
#include "points/virtual_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "geometry/free_places.h"
#include "geometry/side_votes.h"
#include "geometry/surfel_discs.h"
#include "geometry/surfel_views.h"

namespace topple::geometry {
namespace {

// A view of a surfel counts where it is seen no more obliquely than this (cosine).
constexpr double seen_cos = 0.25;
// Places tried as the first, and the share of surfels that must face it.
constexpr unsigned first_tries = 8;
constexpr double least_facing = 0.5;
// Closed rooms that are looked into, and the share of what is seen there that may show its back.
constexpr unsigned most_closed = 60;
constexpr double most_behind = 0.3;
// The share of all surfels that is worth another place.
constexpr double least_unseen = 0.005;
// Places outside of the scene's box that see into it, at most.
constexpr unsigned outside = 2;
// The first place sees this share of all surfels, or has as much room around it as only rooms have
// within them; else it may lie within a box, and is compared with others.
constexpr double least_seen = 0.5, roomy_m = 0.75;
// A large room, and how many of them are looked at.
constexpr double room_m3 = 200, most_rooms = 30;

constexpr std::uint64_t place_chunk = 256;  // handed to a thread at once

class Looking {
  public:
    Looking(const Surfels& surfels, const VirtualViewOptions& options, ThreadPool& pool)
        : s_(surfels),
          pool_(pool),
          views_(surfels, covering_radii(surfels, options.gap_m, pool), pool),
          places_(surfels),
          sides_(surfels, views_.radii_m(), pool),
          in_view_(places_.size(), 0),
          tell_(options.tell) {
        if (options.sides_known) sides_.believe_normals();
        sides_known_ = options.sides_known;
        out_.viewpoint_of_surfel.assign(surfels.size(), no_eye);
        out_.intrinsics = {CubeView::side,
                           CubeView::side,
                           CubeView::focal,
                           CubeView::focal,
                           CubeView::centre,
                           CubeView::centre,
                           1000};
        // No depth within the grid is longer than its diagonal.
        out_.intrinsics.depth_scale = std::min(10000.0, 65535 / (2 * places_.longest_m()));
    }

    void look_around(const VirtualViewOptions& options) {
        std::size_t said = 0, hidden = 0;
        const std::size_t known = options.known_eyes.size();
        expected_ = static_cast<double>(known > 0 ? std::max<std::size_t>(options.eyes, known)
                                                  : options.eyes * rooms());
        for (std::size_t e = 0; e < options.known_eyes.size(); ++e) {
            CubeView view = views_.from(options.known_eyes[e]);
            for (std::size_t i = 0; i < options.seen_from.size(); ++i) {
                if (options.seen_from[i] != e) continue;
                ++said;
                hidden += hides(view, {s_.x[i], s_.y[i], s_.z[i]}, places_.cell_m());
            }
            look(std::move(view));
        }
        if (said > 0) out_.hidden_share = static_cast<double>(hidden) / static_cast<double>(said);
        if (!options.known_eyes.empty()) return explore(options.eyes);
        look_first(options.sides_known);
        if (out_.eyes.empty()) return;
        explore(options.eyes * rooms());
        look_into_closed_rooms(options.eyes / 2);
        look_from_outside();
        if (sides_known_) look_at_unseen(options.eyes);
    }

    VirtualViews finish() {
        if (out_.eyes.empty()) {
            out_.viewpoint_of_surfel.clear();
            return std::move(out_);
        }
        if (!sides_known_) agree_on_sides();
        sides_.spread();
        leave_out_behind();
        out_.sides_believed = sides_known_;
        out_.viewpoints = out_.eyes;
        for (std::size_t i = 0; i < s_.size(); ++i) {
            std::uint32_t& from = out_.viewpoint_of_surfel[i];
            if (from == no_eye) from = nearest_eye(i);
            if (from != no_eye) continue;
            from = static_cast<std::uint32_t>(out_.viewpoints.size());
            out_.viewpoints.push_back(in_front_of(i));
        }
        return std::move(out_);
    }

  private:
    // As many rooms as the scene has room for.
    std::size_t rooms() const {
        const double count = std::round(places_.volume_m3() / room_m3);
        return static_cast<std::size_t>(std::clamp(count, 1.0, most_rooms));
    }
    // Share of the seen surfels with a side that face the eye.
    double share_facing(const CubeView& view) const {
        std::size_t front = 0, all = 0;
        for (const auto& image : view.surfel) {
            for (const std::uint32_t i : image) {
                if (i == CubeView::nothing || !sides_.one_sided(i) || sides_.side(i) == 0) continue;
                ++all;
                front += sides_.side(i) * sides_.facing(i, view.eye) > 0;
            }
        }
        return all > 0 ? static_cast<double>(front) / static_cast<double>(all) : 0;
    }

    // Share of all surfels that are seen: little from within a box.
    double share_seen(const CubeView& view) const {
        std::vector<bool> seen(s_.size());
        for (std::size_t image = 0; image < 6; ++image)
            view.for_each_seen(image, [&](std::uint32_t i, std::uint32_t) { seen[i] = true; });
        return static_cast<double>(std::ranges::count(seen, true)) / static_cast<double>(s_.size());
    }

    // Looks from places that are known to be free until there are so many.
    void explore(std::size_t eyes) {
        while (out_.eyes.size() < eyes) {
            const std::size_t place = places_.choose_free();
            if (place == places_.size()) break;
            look(views_.from(places_.middle(place)));
        }
    }

    // No way that sight takes leads from one storey to the next, nor through a closed door. What
    // has a room's size and is closed all around was a room, too, unless its walls were seen from
    // behind: then it is what lies between rooms.
    void look_into_closed_rooms(unsigned eyes) {
        for (unsigned n = 0; n < most_closed; ++n) {
            const std::size_t place = places_.choose_closed(roomy_m);
            if (place == places_.size()) return;
            const CubeView view = views_.from(places_.middle(place));
            pass_over_seen(view, place);
            if (share_behind(view) > most_behind) continue;
            look(view);
            explore(out_.eyes.size() + eyes - 1);
        }
    }

    // The others lie between what they see, where tops may be out of sight. A scene without a
    // ceiling is looked at from above, too: from places outside of it that most of them have in
    // view.
    void look_from_outside() {
        const std::size_t most = out_.eyes.size() / 2;
        for (unsigned n = 0; n < outside; ++n) {
            const std::size_t place =
                places_.choose_outside([&](std::size_t p) { return in_view_[p] > most; });
            if (place == places_.size()) return;
            look(views_.from(places_.middle(place)));
        }
    }

    // What no place has in view yet, from the place that most of it faces, as long as that shows
    // more. Since sides are known, what is in front of them was free.
    void look_at_unseen(unsigned eyes) {
        constexpr std::size_t most_surfels = 4000, most_places = 4000;  // looked at
        for (unsigned n = 0; n < eyes; ++n) {
            std::vector<std::size_t> unseen;
            for (std::size_t i = 0; i < s_.size(); ++i)
                if (out_.viewpoint_of_surfel[i] == no_eye && sides_.one_sided(i))
                    unseen.push_back(i);
            if (static_cast<double>(unseen.size()) < least_unseen * static_cast<double>(s_.size()))
                return;
            const std::size_t step = unseen.size() / most_surfels + 1,
                              stride = places_.size() / most_places + 1;
            std::vector<std::size_t> facing_it(places_.size() / stride + 1, 0);
            pool_.each(places_.size() / stride, 16, [&](std::size_t q) {
                const Vec3& eye = places_.middle(q * stride);
                for (std::size_t m = 0; m < unseen.size(); m += step)
                    facing_it[q] += looks_at(unseen[m], eye);
            });
            const auto best = std::ranges::max_element(facing_it);
            if (*best == 0) return;
            const std::size_t place = static_cast<std::size_t>(best - facing_it.begin()) * stride;
            look(views_.from(places_.middle(place)));
            std::size_t left = 0;
            for (const std::size_t i : unseen) left += out_.viewpoint_of_surfel[i] == no_eye;
            const double gain = static_cast<double>(unseen.size() - left);
            if (gain < least_unseen * static_cast<double>(s_.size())) return;
        }
    }

    // Whether a surfel's front is towards an eye, near enough that little comes between.
    bool looks_at(std::size_t i, const Vec3& eye) const {
        constexpr double near_m = 2, well = 0.4;  // cosine
        const double away = std::hypot(eye[0] - s_.x[i], eye[1] - s_.y[i], eye[2] - s_.z[i]);
        if (away > near_m) return false;
        const double f = sides_.facing(i, eye);
        return sides_.side(i) == 0 ? std::abs(f) > well : sides_.side(i) * f > well;
    }

    // Share of what is seen that shows its back.
    double share_behind(const CubeView& view) const {
        std::size_t behind = 0, all = 0;
        for (const auto& image : view.surfel) {
            for (const std::uint32_t i : image) {
                if (i == CubeView::nothing) continue;
                ++all;
                behind += sides_.side(i) != 0 && sides_.from_behind(i, view.eye);
            }
        }
        return all > 0 ? static_cast<double>(behind) / static_cast<double>(all) : 1;
    }

    // What is seen from a place that was tried need not be tried, too.
    void pass_over_seen(const CubeView& view, std::size_t place) {
        places_.pass_over(place);
        for (std::size_t p = 0; p < places_.size(); ++p)
            if (sees_through(view, places_.middle(p))) places_.pass_over(p);
    }

    void look_first(bool sides_known) {
        std::optional<CubeView> best;
        double best_share = -1;
        for (unsigned n = 0; n < first_tries; ++n) {
            const std::size_t place = places_.choose_first();
            if (place == places_.size()) break;
            CubeView view = views_.from(places_.middle(place));
            const double share = share_seen(view);
            const bool fits = sides_known
                                  ? share_facing(view) >= least_facing
                                  : share >= least_seen || places_.clearance_m(place) >= roomy_m;
            if (!fits) pass_over_seen(view, place);
            if (fits || share > best_share) {
                best = std::move(view);
                best_share = share;
            }
            if (fits) return look(*std::move(best));
        }
        if (!best) return;
        if (sides_known) sides_.forget();
        sides_known_ = false;
        look(*std::move(best));
    }

    void look(CubeView view) {
        if (!sides_known_) sides_.count(view);
        const auto eye = static_cast<std::uint32_t>(out_.eyes.size());
        out_.eyes.push_back(view.eye);
        for (std::size_t image = 0; image < 6; ++image) {
            view.for_each_seen(image, [&](std::uint32_t i, std::uint32_t) {
                if (out_.viewpoint_of_surfel[i] != no_eye) return;
                const double f = sides_.facing(i, view.eye);
                if (s_.has_normal(i) && std::abs(f) < seen_cos) return;
                if (sides_.side(i) == 0) sides_.face(i, f);
                if (sides_.side(i) * f >= 0) out_.viewpoint_of_surfel[i] = eye;
            });
        }
        pool_.each(places_.size(), place_chunk, [&](std::size_t p) { look_at_place(view, p); });
        places_.leave_out(view.eye);
        add_frames(view);
        if (tell_) tell_(std::min(0.99, static_cast<double>(out_.eyes.size()) / expected_));
    }

    void look_at_place(const CubeView& view, std::size_t p) {
        const bool free = places_.is_free(p), within = places_.is_within(p);
        if (free && within) return;
        const std::size_t image = view.image_of(places_.middle(p));
        const CubeView::Pixel pixel = view.pixel_of(image, places_.middle(p));
        if (hides(view, image, pixel)) return;
        if (!within) ++in_view_[p];
        if (!free && sees_through(view, image, pixel)) places_.set_free(p);
    }

    void add_frames(CubeView& view) {
        std::array<DepthFrame, 6> frames;
        std::array<bool, 6> any{};
        pool_.each(6, 1, [&](std::size_t image) {
            DepthFrame& frame = frames[image];
            frame.camera_to_world = view.pose(image);
            frame.depth.assign(view.depth[image].size(), 0);
            for (std::size_t at = 0; at < frame.depth.size(); ++at) {
                if (view.surfel[image][at] == CubeView::nothing) continue;
                // To the nearest; depths are positive.
                const double stored = view.depth[image][at] * out_.intrinsics.depth_scale + 0.5;
                if (!(stored < 65536)) continue;
                frame.depth[at] = static_cast<std::uint16_t>(std::max(stored, 1.0));
                any[image] = true;
            }
        });
        for (std::size_t image = 0; image < 6; ++image) {
            if (!any[image]) continue;
            out_.frames.push_back(std::move(frames[image]));
            shown_.push_back(std::move(view.surfel[image]));
        }
    }

    void agree_on_sides() {
        sides_.agree();
        for (std::size_t i = 0; i < s_.size(); ++i) {
            std::uint32_t& eye = out_.viewpoint_of_surfel[i];
            if (s_.has_normal(i) && eye != no_eye &&
                sides_.side(i) * sides_.facing(i, out_.eyes[eye]) <= 0)
                eye = no_eye;
        }
    }

    // A surface that is seen from behind ends no ray: the way to it leads through what nobody
    // scanned. Which are, only all eyes together tell.
    void leave_out_behind() {
        pool_.each(out_.frames.size(), 1, [&](std::size_t f) {
            DepthFrame& frame = out_.frames[f];
            const Mat4& m = frame.camera_to_world;
            std::uint32_t last = CubeView::nothing;
            bool behind = false;
            for (std::size_t at = 0; at < frame.depth.size(); ++at) {
                if (frame.depth[at] == 0) continue;
                if (shown_[f][at] != last) {
                    last = shown_[f][at];
                    behind = sides_.from_behind(last, {m[3], m[7], m[11]});
                }
                if (behind) frame.depth[at] = 0;
            }
        });
        shown_.clear();
        std::erase_if(out_.frames, [](const DepthFrame& frame) {
            return std::ranges::all_of(frame.depth, [](std::uint16_t d) { return d == 0; });
        });
    }

    // Whether something lies before the point, by so much.
    bool hides(const CubeView& view, const Vec3& point, double by_m = 0) const {
        const std::size_t image = view.image_of(point);
        return hides(view, image, view.pixel_of(image, point), by_m);
    }
    static bool hides(const CubeView& view, std::size_t image, const CubeView::Pixel& pixel,
                      double by_m = 0) {
        return !pixel.inside || (view.surfel[image][pixel.index] != CubeView::nothing &&
                                 view.depth[image][pixel.index] + by_m < pixel.depth);
    }

    // Whether all of a place is seen through: not a line of sight alone, which may lead through a
    // gap between surfels, but those to the rim of its cell, too.
    bool sees_through(const CubeView& view, const Vec3& place) const {
        const std::size_t image = view.image_of(place);
        return sees_through(view, image, view.pixel_of(image, place));
    }
    bool sees_through(const CubeView& view, std::size_t image, const CubeView::Pixel& pixel) const {
        // At its middle first, where most is not seen through.
        if (!pixel.inside || view.surfel[image][pixel.index] == CubeView::nothing ||
            pixel.depth + places_.cell_m() >= view.depth[image][pixel.index])
            return false;
        const auto at = [](std::size_t n, double away) {
            const double to = std::clamp(static_cast<double>(n) + away, 0.0, CubeView::side - 1.0);
            return static_cast<std::size_t>(to);
        };
        const double rim = std::ceil(CubeView::focal * places_.cell_m() / 2 / pixel.depth);
        const std::size_t row = pixel.index / CubeView::side, column = pixel.index % CubeView::side;
        for (const double down : {-rim, 0.0, rim}) {
            for (const double right : {-rim, 0.0, rim}) {
                const std::size_t n = at(row, down) * CubeView::side + at(column, right);
                const std::uint32_t i = view.surfel[image][n];
                if (i != CubeView::nothing &&
                    (sides_.from_behind(i, view.eye) ||
                     pixel.depth + places_.cell_m() >= view.depth[image][n]))
                    return false;
            }
        }
        return true;
    }

    // The nearest eye on the surfel's side; no_eye where none is.
    std::uint32_t nearest_eye(std::size_t i) const {
        std::uint32_t best = no_eye;
        double best_distance = std::numeric_limits<double>::infinity();
        for (std::size_t e = 0; e < out_.eyes.size(); ++e) {
            const Vec3& eye = out_.eyes[e];
            if (sides_.side(i) * sides_.facing(i, eye) < 0) continue;
            const double distance =
                std::hypot(eye[0] - s_.x[i], eye[1] - s_.y[i], eye[2] - s_.z[i]);
            if (distance >= best_distance) continue;
            best = static_cast<std::uint32_t>(e);
            best_distance = distance;
        }
        return best;
    }

    // Right in front of a surfel that no eye has in front.
    Vec3 in_front_of(std::size_t i) const {
        const double away = sides_.side(i) * s_.cell_m;
        return {s_.x[i] + away * s_.nx[i], s_.y[i] + away * s_.ny[i], s_.z[i] + away * s_.nz[i]};
    }

    const Surfels& s_;
    ThreadPool& pool_;
    SurfelViews views_;
    FreePlaces places_;
    SideVotes sides_;
    bool sides_known_ = false;
    std::vector<std::uint32_t> in_view_;  // of each place outside: how many eyes have it in view
    std::vector<std::vector<std::uint32_t>> shown_;  // surfels of the frames' pixels
    VirtualViews out_;
    const std::function<void(double)>& tell_;
    double expected_ = 1;  // places, about
};

}  // namespace

VirtualViews virtual_views(const Surfels& surfels, const VirtualViewOptions& options,
                           ThreadPool& pool) {
    if (surfels.size() == 0) return {};
    Looking looking(surfels, options, pool);
    looking.look_around(options);
    return looking.finish();
}

}  // namespace topple::geometry
