// SPDX-License-Identifier: MIT
#include "geometry/virtual_views.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/free_places.h"
#include "geometry/surfel_views.h"

namespace topple::geometry {
namespace {

constexpr std::uint32_t no_eye = 0xffffffff;
// A surfel's side shows where it is seen no more obliquely than this (cosine), and is known to be
// seen from behind from here on.
constexpr double side_cos = 0.25, behind_cos = 0.1;
// Neighbours whose normals' cosine is more lie in one surface.
constexpr float one_surface_cos = 0.8f;
// Of the surface around a surfel, what must be seen with it.
constexpr float least_pixel_share = 0.3f;
constexpr std::uint64_t witness_chunk = 1 << 14;  // surfels handed to a thread at once
// Rougher than this share of its cell, a surfel may be both faces of a thin board, or an edge.
constexpr double two_sided_cells = 0.25;
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

class Looking {
  public:
    Looking(const Surfels& surfels, const VirtualViewOptions& options, ThreadPool& pool)
        : s_(surfels),
          pool_(pool),
          places_(surfels),
          side_(surfels.size(), 0),
          witness_(surfels.size(), 0),
          in_view_(places_.size(), 0) {
        if (options.sides_known) know_sides();
        out_.eye_of_surfel.assign(surfels.size(), no_eye);
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
        for (const Vec3& eye : options.known_eyes) look(view_surfels(s_, eye, pool_));
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
            out_.eye_of_surfel.clear();
            return std::move(out_);
        }
        if (!sides_known_) agree_on_sides();
        spread_sides();
        for (std::size_t i = 0; i < s_.size(); ++i) {
            if (out_.eye_of_surfel[i] == no_eye) out_.eye_of_surfel[i] = nearest_eye(i);
        }
        return std::move(out_);
    }

  private:
    // As many rooms as the scene has room for.
    std::size_t rooms() const {
        const double count = std::round(places_.volume_m3() / room_m3);
        return static_cast<std::size_t>(std::clamp(count, 1.0, most_rooms));
    }
    bool has_normal(std::size_t i) const { return s_.nx[i] != 0 || s_.ny[i] != 0 || s_.nz[i] != 0; }
    void know_sides() {
        for (std::size_t i = 0; i < s_.size(); ++i) side_[i] = has_normal(i) ? 1 : 0;
        sides_known_ = true;
    }
    float cosine(std::size_t i, std::size_t j) const {
        return s_.nx[i] * s_.nx[j] + s_.ny[i] * s_.ny[j] + s_.nz[i] * s_.nz[j];
    }
    // Cosine between the surfel's normal and the direction to the eye.
    double facing(std::size_t i, const Vec3& eye) const {
        const Vec3 d{eye[0] - s_.x[i], eye[1] - s_.y[i], eye[2] - s_.z[i]};
        const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        return length > 0 ? (s_.nx[i] * d[0] + s_.ny[i] * d[1] + s_.nz[i] * d[2]) / length : 0;
    }
    bool one_sided(std::size_t i) const {
        return has_normal(i) && s_.roughness_m[i] <= two_sided_cells * s_.cell_m;
    }
    bool from_behind(std::size_t i, const Vec3& eye) const {
        return one_sided(i) && side_[i] * facing(i, eye) < -behind_cos;
    }

    // Share of the seen surfels with a side that face the eye.
    double share_facing(const CubeView& view) const {
        std::size_t front = 0, all = 0;
        for (const auto& image : view.surfel) {
            for (const std::uint32_t i : image) {
                if (i == CubeView::nothing || !one_sided(i) || side_[i] == 0) continue;
                ++all;
                front += side_[i] * facing(i, view.eye) > 0;
            }
        }
        return all > 0 ? static_cast<double>(front) / static_cast<double>(all) : 0;
    }

    // Share of all surfels that are seen: little from within a box.
    double share_seen(const CubeView& view) const {
        std::vector<bool> seen(s_.size());
        for (const auto& image : view.surfel) {
            for (const std::uint32_t i : image)
                if (i != CubeView::nothing) seen[i] = true;
        }
        return static_cast<double>(std::ranges::count(seen, true)) / static_cast<double>(s_.size());
    }

    // Looks from places that are known to be free until there are so many.
    void explore(std::size_t eyes) {
        while (out_.eyes.size() < eyes) {
            const std::size_t place = places_.choose_free();
            if (place == places_.size()) break;
            look(view_surfels(s_, places_.middle(place), pool_));
        }
    }

    // No way that sight takes leads from one storey to the next, nor through a closed door. What
    // has a room's size and is closed all around was a room, too, unless its walls were seen from
    // behind: then it is what lies between rooms.
    void look_into_closed_rooms(unsigned eyes) {
        for (unsigned n = 0; n < most_closed; ++n) {
            const std::size_t place = places_.choose_closed(roomy_m);
            if (place == places_.size()) return;
            const CubeView view = view_surfels(s_, places_.middle(place), pool_);
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
            look(view_surfels(s_, places_.middle(place), pool_));
        }
    }

    // What no place has in view yet, from the place that most of it faces, as long as that shows
    // more. Since sides are known, what is in front of them was free.
    void look_at_unseen(unsigned eyes) {
        constexpr std::size_t most_surfels = 4000, most_places = 4000;  // looked at
        for (unsigned n = 0; n < eyes; ++n) {
            std::vector<std::size_t> unseen;
            for (std::size_t i = 0; i < s_.size(); ++i)
                if (out_.eye_of_surfel[i] == no_eye && one_sided(i)) unseen.push_back(i);
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
            look(view_surfels(s_, places_.middle(place), pool_));
            std::size_t left = 0;
            for (const std::size_t i : unseen) left += out_.eye_of_surfel[i] == no_eye;
            const double gain = static_cast<double>(unseen.size() - left);
            if (gain < least_unseen * static_cast<double>(s_.size())) return;
        }
    }

    // Whether a surfel's front is towards an eye, near enough that little comes between.
    bool looks_at(std::size_t i, const Vec3& eye) const {
        constexpr double near_m = 2, well = 0.4;  // cosine
        const double away = std::hypot(eye[0] - s_.x[i], eye[1] - s_.y[i], eye[2] - s_.z[i]);
        if (away > near_m) return false;
        const double f = facing(i, eye);
        return side_[i] == 0 ? std::abs(f) > well : side_[i] * f > well;
    }

    // Share of what is seen that shows its back.
    double share_behind(const CubeView& view) const {
        std::size_t behind = 0, all = 0;
        for (const auto& image : view.surfel) {
            for (const std::uint32_t i : image) {
                if (i == CubeView::nothing) continue;
                ++all;
                behind += side_[i] != 0 && from_behind(i, view.eye);
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
            CubeView view = view_surfels(s_, places_.middle(place), pool_);
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
        if (sides_known) std::fill(side_.begin(), side_.end(), std::int8_t{0});
        sides_known_ = false;
        look(*std::move(best));
    }

    void look(CubeView view) {
        if (!sides_known_) stop_leaks(view);
        const auto eye = static_cast<std::uint32_t>(out_.eyes.size());
        out_.eyes.push_back(view.eye);
        for (const auto& image : view.surfel) {
            for (const std::uint32_t i : image) {
                if (i == CubeView::nothing || out_.eye_of_surfel[i] != no_eye) continue;
                const double f = facing(i, view.eye);
                if (has_normal(i) && std::abs(f) < side_cos) continue;
                if (side_[i] == 0) side_[i] = f > 0 ? 1 : -1;
                if (side_[i] * f >= 0) out_.eye_of_surfel[i] = eye;
            }
        }
        for (std::size_t image = 0; image < 6; ++image) add_frame(view, image);
        for (std::size_t p = 0; p < places_.size(); ++p) {
            if (!places_.is_free(p) && sees_through(view, places_.middle(p))) places_.set_free(p);
            if (!places_.is_within(p) && !hides(view, places_.middle(p))) ++in_view_[p];
        }
        places_.leave_out(view.eye);
    }

    void add_frame(const CubeView& view, std::size_t image) {
        DepthFrame frame;
        frame.camera_to_world = view.pose(image);
        frame.depth.assign(view.depth[image].size(), 0);
        bool any = false;
        for (std::size_t at = 0; at < frame.depth.size(); ++at) {
            const std::uint32_t i = view.surfel[image][at];
            if (i == CubeView::nothing || from_behind(i, view.eye)) continue;
            const double stored = std::round(view.depth[image][at] * out_.intrinsics.depth_scale);
            if (!(stored <= 65535)) continue;
            frame.depth[at] = static_cast<std::uint16_t>(std::max(stored, 1.0));
            any = true;
        }
        if (any) out_.frames.push_back(std::move(frame));
    }

    // Whether something lies before the point.
    bool hides(const CubeView& view, const Vec3& point) const {
        const std::size_t image = view.image_of(point);
        const CubeView::Pixel pixel = view.pixel_of(image, point);
        return !pixel.inside || (view.surfel[image][pixel.index] != CubeView::nothing &&
                                 view.depth[image][pixel.index] < pixel.depth);
    }

    bool sees_through(const CubeView& view, const Vec3& point) const {
        const std::size_t image = view.image_of(point);
        const CubeView::Pixel pixel = view.pixel_of(image, point);
        if (!pixel.inside) return false;
        const std::uint32_t i = view.surfel[image][pixel.index];
        return i != CubeView::nothing && !from_behind(i, view.eye) &&
               pixel.depth + places_.cell_m() < view.depth[image][pixel.index];
    }

    // Sight leaks through gaps between surfels and meets the insides of faces, here and there one
    // surfel: of which little of the surface around is seen, that is not seen at all. The word of
    // an eye on a surfel's side counts by the square of the share that it sees of that surface.
    void stop_leaks(CubeView& view) {
        std::vector<std::int8_t> seen(s_.size(), 0);  // from its normal's side 1, from the other -1
        for (const auto& image : view.surfel) {
            for (const std::uint32_t i : image) {
                if (i == CubeView::nothing) continue;
                const double f = facing(i, view.eye);
                if (!has_normal(i) || std::abs(f) >= side_cos) seen[i] = f > 0 ? 1 : -1;
            }
        }
        std::vector<float> share(s_.size(), 1);
        pool_.each(s_.size(), witness_chunk, [&](std::size_t i) {
            if (seen[i] == 0) return;
            std::uint32_t around = 1, agree = 1;
            for (std::uint32_t k = s_.neighbour_first[i]; k < s_.neighbour_first[i + 1]; ++k) {
                const std::uint32_t j = s_.neighbours[k];
                const float along = cosine(i, j);
                if (std::abs(along) < one_surface_cos) continue;
                ++around;
                agree += seen[j] == (along > 0 ? seen[i] : -seen[i]);
            }
            share[i] = static_cast<float>(agree) / static_cast<float>(around);
            witness_[i] += static_cast<float>(seen[i]) * share[i] * share[i];
        });
        for (auto& image : view.surfel) {
            for (std::uint32_t& i : image)
                if (i != CubeView::nothing && share[i] < least_pixel_share) i = CubeView::nothing;
        }
    }

    // The side of a surfel is that for which it and its neighbours in one surface have more words.
    void agree_on_sides() {
        for (std::size_t i = 0; i < s_.size(); ++i) {
            if (!has_normal(i)) continue;
            float sum = witness_[i];
            for (std::uint32_t k = s_.neighbour_first[i]; k < s_.neighbour_first[i + 1]; ++k) {
                const std::uint32_t j = s_.neighbours[k];
                const float along = cosine(i, j);
                if (std::abs(along) > one_surface_cos)
                    sum += along > 0 ? witness_[j] : -witness_[j];
            }
            if (sum == 0) continue;
            side_[i] = sum > 0 ? 1 : -1;
            std::uint32_t& eye = out_.eye_of_surfel[i];
            if (eye != no_eye && side_[i] * facing(i, out_.eyes[eye]) < 0) eye = no_eye;
        }
    }

    // From the surfels whose side is known to their neighbours, nearest first.
    void spread_sides() {
        std::vector<std::uint32_t> queue;
        for (std::size_t i = 0; i < s_.size(); ++i) {
            if (side_[i] != 0) queue.push_back(static_cast<std::uint32_t>(i));
        }
        for (std::size_t at = 0; at < queue.size(); ++at) {
            const std::uint32_t i = queue[at];
            for (std::uint32_t k = s_.neighbour_first[i]; k < s_.neighbour_first[i + 1]; ++k) {
                const std::uint32_t j = s_.neighbours[k];
                if (side_[j] != 0 || !has_normal(j)) continue;
                side_[j] = static_cast<std::int8_t>(cosine(i, j) < 0 ? -side_[i] : side_[i]);
                queue.push_back(j);
            }
        }
    }

    // The nearest eye on the surfel's side; the nearest of all where none is.
    std::uint32_t nearest_eye(std::size_t i) const {
        std::uint32_t best = 0;
        double best_distance = std::numeric_limits<double>::infinity();
        bool best_fits = false;
        for (std::size_t e = 0; e < out_.eyes.size(); ++e) {
            const Vec3& eye = out_.eyes[e];
            const bool fits = side_[i] * facing(i, eye) >= 0;
            const double distance =
                std::hypot(eye[0] - s_.x[i], eye[1] - s_.y[i], eye[2] - s_.z[i]);
            if (fits == best_fits ? distance >= best_distance : !fits) continue;
            best = static_cast<std::uint32_t>(e);
            best_distance = distance;
            best_fits = fits;
        }
        return best;
    }

    const Surfels& s_;
    ThreadPool& pool_;
    FreePlaces places_;
    // 1: the normal points to the free side, -1: away from it, 0: not known.
    std::vector<std::int8_t> side_;
    std::vector<float> witness_;  // of the eyes for the normal's side, less those for the other
    bool sides_known_ = false;
    std::vector<std::uint32_t> in_view_;  // of each place outside: how many eyes have it in view
    VirtualViews out_;
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
