// SPDX-License-Identifier: MIT
#include "points/pose_comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/ranked.h"

namespace topple::geometry {
namespace {

using Eigen::Isometry3d;
using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr std::size_t most_kept = 1000;

// Frames may look at the same place where so many readings of one, coarsely, fall on surfaces of
// the other; and do where so many meet these, or are seen through.
constexpr double least_overlap = 0.3, least_visible = 0.05;
constexpr unsigned overlap_stride = 16;
// Frames back in time that are looked through for each frame, and those that are taken; and how far
// back the last is.
constexpr std::size_t most_looked_through = 48, most_taken = 3, most_steps_back = 8;

// A pair may contradict where so many readings are seen through of those that are not hidden, and
// does where a motion makes this much more of all agree, and nearly all that meet; in so many cells
// of the images, and without spoiling what agreed: what moves in a room is a part of what is seen.
constexpr double least_seen_through = 0.08, least_gain = 0.06;
constexpr double least_mended_agreeing = 0.9, most_mended_seen_through = 0.03;
constexpr std::uint64_t least_in_cell = 8;
constexpr std::size_t least_mended_cells = 4;
constexpr double least_cell_gain = 0.1, least_mended_share = 0.3, most_spoilt_share = 0.2;
// Frames this near to one of the pair bear witness, which see so much of the other.
constexpr std::size_t witness_steps = 2, least_witnesses = 2;
constexpr double least_witnessed = 0.1, least_witness_gain = 0.03;
constexpr double most_witness_seen_through = 0.04, least_witness_agreeing = 0.85;
// Or none was found, and most are seen through, and in most cells.
constexpr double least_before = 0.07, most_of_moved = 0.5, least_seen_through_cells = 0.6;
// A motion by less does little harm, and poses of true cameras are off by some of it.
constexpr double least_way_m = 0.08, least_turn_rad = 0.056;
// Contradictions without such a motion are told where they are this share of all pairs: someone who
// walks near before the camera all along hides most of what it sees in fewer.
constexpr double least_unexplained = 0.45;
// With so few seen through, a frame fits.
constexpr double most_of_fitting = 0.05;

// Frames to which others are looked for, spread over the sequence.
constexpr std::size_t anchors = 8;
// Frames of a pair turn by this share of the smaller field of view at least, and twice that at
// most: conventions then differ by more than noise, and two thirds of what is seen is common.
constexpr double turn_share = 0.3;
// Another convention is better if so many of the readings that it compares agree, and so many of
// all, and in the given one less than these shares of that.
constexpr double least_agreeing = 0.5, least_common = 0.1;
constexpr double most_given_agreeing = 0.5, most_given_common = 1.0 / 3;
// Those that are nearly as good as the best are not told apart from it.
constexpr double as_good = 0.75;

Isometry3d isometry(const Mat4& pose) {
    return Isometry3d(Eigen::Map<const Matrix>(pose.data()).eval());
}

// The pose of a camera with topple's axes, x right, y down and z ahead: the columns of what turns
// the camera's own into these.
Isometry3d meant(const Isometry3d& given, PoseConvention convention) {
    using enum PoseConvention;
    const bool inverse = convention == world_to_camera || convention == world_to_camera_opengl ||
                         convention == world_to_camera_body;
    Isometry3d out = inverse ? given.inverse() : given;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (convention == opengl || convention == world_to_camera_opengl)
        axes << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    if (convention == body || convention == world_to_camera_body)
        axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    out.linear() *= axes;
    if (convention == transposed) out.linear() = given.linear().transpose();
    if (convention == w_first) {
        const Eigen::Quaterniond q(given.linear());
        out.linear() = Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
    }
    return out;
}

double turn_between(const Isometry3d& a, const Isometry3d& b) {
    const double trace = (a.linear().transpose() * b.linear()).trace();
    return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0));
}

std::vector<PoseConvention> better_than_given(
    const std::array<Agreement, pose_conventions>& found) {
    const auto common = [&](std::size_t n) { return found[n].common_share(); };
    std::array<std::size_t, pose_conventions> order{};
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, common);
    const Agreement &best = found[order[0]], &given = found[0];
    if (best.agreeing_share() < least_agreeing || best.common_share() < least_common ||
        given.agreeing_share() > most_given_agreeing * best.agreeing_share() ||
        given.common_share() > most_given_common * best.common_share())
        return {};
    std::vector<PoseConvention> out;
    for (const std::size_t n : order)
        if (common(n) >= as_good * best.common_share())
            out.push_back(static_cast<PoseConvention>(n));
    return out;
}

}  // namespace

PoseComparison::PoseComparison(const Intrinsics& k, std::span<const Mat4> poses,
                               double typical_depth_m)
    : field_of_view_(2 * std::atan(std::min(k.width / k.fx, k.height / k.fy) / 2)),
      typical_depth_m_(typical_depth_m),
      every_((poses.size() + most_kept - 1) / most_kept),
      frames_(k, every_ == 0 ? 0 : (poses.size() + every_ - 1) / every_) {
    for (std::size_t n = 0; n < poses.size(); n += every_) poses_.push_back(isometry(poses[n]));
}

void PoseComparison::add(const DepthFrame& frame, std::size_t number) {
    if (!poses_.empty() && number % every_ == 0) frames_.add(frame, number / every_);
}

bool PoseComparison::look_at_one_place(std::size_t a, std::size_t b) const {
    return frames_.carry(a, b, poses_[b].inverse() * poses_[a], overlap_stride).compared_share() >=
           least_overlap;
}

// Each with the last and the earliest ones before it that look at the same place.
std::vector<PoseComparison::Pair> PoseComparison::pairs_in_time() const {
    std::vector<Pair> pairs;
    const std::size_t count = frames_.size();
    const std::size_t step = std::max<std::size_t>(1, count / most_looked_through);
    const std::size_t apart = std::max<std::size_t>(2, count / (4 * most_taken));
    for (std::size_t b = 1; b < count; ++b) {
        if (!frames_.has(b)) continue;
        std::size_t last = b;
        for (std::size_t a = b; last == b && a-- > b - std::min(b, most_steps_back);)
            if (frames_.has(a) && look_at_one_place(a, b)) last = a;
        std::size_t taken = 0;
        for (std::size_t a = 0; a < last && taken < most_taken; a += step) {
            if (!frames_.has(a) || (taken > 0 && a < pairs.back().a + apart)) continue;
            if (!look_at_one_place(a, b)) continue;
            pairs.push_back({a, b});
            ++taken;
        }
        if (last < b) pairs.push_back({last, b});
        if (last + 1 != b && frames_.has(b - 1)) pairs.push_back({b - 1, b});
    }
    return pairs;
}

struct PoseComparison::Compared {
    bool common = false, contradicts = false, fits = false;
    bool aligned = false;  // by this:
    double way_m = 0, turn_rad = 0, doubled_m = 0;
};

// Whether a motion of the whole frame mends what contradicts, and does so all over the image.
bool PoseComparison::mends(const SmallFrames::Cells& given, const SmallFrames::Cells& moved) {
    const Agreement is = sum(given), would = sum(moved);
    if (would.agreeing_share() < least_mended_agreeing ||
        would.seen_through_share() > most_mended_seen_through ||
        would.common_share() - is.common_share() < least_gain)
        return false;
    std::size_t shown = 0, mended = 0, spoilt = 0;
    for (std::size_t n = 0; n < given.size(); ++n) {
        if (given[n].carried < least_in_cell ||
            given[n].compared + moved[n].compared < least_in_cell)
            continue;
        const double gain = moved[n].common_share() - given[n].common_share();
        ++shown;
        mended += gain > least_cell_gain;
        spoilt += gain < -least_cell_gain;
    }
    return mended >= least_mended_cells &&
           static_cast<double>(mended) >= least_mended_share * static_cast<double>(shown) &&
           static_cast<double>(spoilt) <= most_spoilt_share * static_cast<double>(mended);
}

// Whether frames near in time to one of the pair, or to either, with the same motion fit the other,
// too: what moves in the room has moved on in them.
bool PoseComparison::has_witnesses(const Pair& pair, const Isometry3d& moved) const {
    struct Witnesses {
        std::size_t fit = 0, seen = 0;
        bool agree() const { return fit >= least_witnesses && 2 * fit > seen; }
    };
    const auto hear = [&](Witnesses& heard, std::size_t a, std::size_t b,
                          const Isometry3d& motion) {
        const Agreement would = sum(frames_.compare(a, b, motion));
        if (would.common_share() + would.before_share() < least_witnessed) return;
        const Agreement is = sum(frames_.compare(a, b, poses_[b].inverse() * poses_[a]));
        ++heard.seen;
        heard.fit += would.seen_through_share() <= most_witness_seen_through &&
                     would.agreeing_share() >= least_witness_agreeing &&
                     would.common_share() > is.common_share() + least_witness_gain;
    };
    Witnesses before, after;
    const auto near = [&](std::size_t n, std::size_t frame) {
        return n != frame && frames_.has(n) && n + witness_steps >= frame &&
               n <= frame + witness_steps;
    };
    for (std::size_t n = 0; n < frames_.size(); ++n) {
        if (n < pair.b && near(n, pair.a))
            hear(before, n, pair.b, moved * poses_[pair.a].inverse() * poses_[n]);
        if (n > pair.a && near(n, pair.b))
            hear(after, pair.a, n, poses_[n].inverse() * poses_[pair.b] * moved);
    }
    return before.agree() || after.agree() ||
           Witnesses{before.fit + after.fit, before.seen + after.seen}.agree();
}

PoseComparison::Compared PoseComparison::compare(const Pair& pair) const {
    const Isometry3d given = poses_[pair.b].inverse() * poses_[pair.a];
    const SmallFrames::Cells cells = frames_.compare(pair.a, pair.b, given);
    const Agreement found = sum(cells);
    Compared out;
    out.common = found.common_share() + found.before_share() >= least_visible;
    out.fits = out.common && found.seen_through_share() < most_of_fitting;
    if (!out.common || found.seen_through_share() < least_seen_through) return out;
    std::vector<Isometry3d> guesses{given};
    // As the camera moved before.
    if (pair.a > 0 && pair.b == pair.a + 1)
        guesses.push_back(poses_[pair.a].inverse() * poses_[pair.a - 1]);
    for (const Isometry3d& guess : guesses) {
        const Isometry3d moved = frames_.align(pair.a, pair.b, guess);
        out.way_m = (moved.inverse().translation() - given.inverse().translation()).norm();
        out.turn_rad = turn_between(given, moved);
        if (out.way_m < least_way_m && out.turn_rad < least_turn_rad) continue;
        if (!mends(cells, frames_.compare(pair.a, pair.b, moved))) continue;
        if (!has_witnesses(pair, moved)) continue;
        const Eigen::Vector3d seen(0, 0, typical_depth_m_);
        out.doubled_m = (moved * seen - given * seen).norm();
        out.aligned = out.contradicts = true;
        return out;
    }
    // More than what moves there, which hides a part of one frame from the other.
    std::size_t shown = 0, seen_through = 0;
    for (const Agreement& cell : cells) {
        if (cell.before + cell.agreeing < least_in_cell) continue;
        ++shown;
        seen_through += cell.seen_through_share() >= most_of_moved;
    }
    out.contradicts =
        found.before_share() >= least_before && found.seen_through_share() >= most_of_moved &&
        static_cast<double>(seen_through) >= least_seen_through_cells * static_cast<double>(shown);
    return out;
}

std::optional<PoseContradiction> PoseComparison::find_contradiction() const {
    ComparedPairs compared;
    PoseContradiction out;
    std::size_t aligned = 0;
    for (const Pair& pair : pairs_in_time()) {
        compared.emplace_back(pair, compare(pair));
        const Compared& found = compared.back().second;
        out.pairs += found.common;
        out.contradict += found.contradicts;
        aligned += found.aligned;
    }
    const auto least = static_cast<std::size_t>(
        aligned > 0 ? 1 : std::ceil(least_unexplained * static_cast<double>(out.pairs)));
    if (out.contradict == 0 || out.contradict < least) return std::nullopt;
    out.from = out.until = frames_.size();
    std::vector<double> ways, turns, doubled;
    for (const auto& [pair, found] : compared) {
        if (!found.contradicts) continue;
        if (pair.b < out.from) {
            out.from = pair.b;
            out.against = pair.a;
        }
        if (!found.aligned) continue;
        ways.push_back(found.way_m);
        turns.push_back(found.turn_rad);
        doubled.push_back(found.doubled_m);
    }
    find_first(out);
    out.until = fits_again(out.from, compared);
    out.same_pose = poses_[out.from].matrix() == poses_[out.from - 1].matrix();
    out.way_m = upper_median(ways);
    out.doubled_m = upper_median(doubled);
    out.turn_deg = upper_median(turns) * 180 / std::numbers::pi;
    for (std::size_t* number : {&out.from, &out.until, &out.against}) *number *= every_;
    return out;
}

// Few pairs may have told: all frames shortly before are compared with all that came earlier.
void PoseComparison::find_first(PoseContradiction& out) const {
    constexpr std::size_t looked_back = 16;
    for (std::size_t b = out.from - std::min(out.from - 1, looked_back); b < out.from; ++b) {
        for (std::size_t a = b; a-- > 0;) {
            if (!frames_.has(a) || !frames_.has(b) || !look_at_one_place(a, b)) continue;
            const Compared found = compare({a, b});
            if (!found.contradicts) continue;
            out.from = b;
            out.against = a;
            return;
        }
    }
}

// The first frame from which on those that are compared with frames before `from` fit these.
std::size_t PoseComparison::fits_again(std::size_t from, const ComparedPairs& compared) const {
    std::size_t until = frames_.size();
    std::size_t last = from;  // that contradicts
    for (const auto& [pair, found] : compared)
        if (found.contradicts && pair.a < from) last = std::max(last, pair.b);
    for (const auto& [pair, found] : compared)
        if (found.fits && pair.a < from && pair.b > last) until = std::min(until, pair.b);
    return until;
}

// By how much two frames turn is the same in all conventions but `w_first`; how far apart they are
// depends on what their poses mean, but for the camera's axes. Nearest are those among which
// conventions show best; among frames that do not turn, those that move as far.
std::vector<PoseComparison::Pair> PoseComparison::turned_pairs() const {
    const double least = turn_share * field_of_view_;
    std::vector<Pair> pairs;
    for (const PoseConvention convention :
         {PoseConvention::camera_to_world, PoseConvention::world_to_camera,
          PoseConvention::w_first}) {
        std::vector<Isometry3d> cameras;
        for (const Isometry3d& pose : poses_) cameras.push_back(meant(pose, convention));
        const std::size_t count = std::min(anchors, cameras.size());
        for (std::size_t n = 0; n < count; ++n) {
            const std::size_t a = count == 1 ? 0 : n * (cameras.size() - 1) / (count - 1);
            double nearest_turned = std::numeric_limits<double>::infinity();
            double nearest_moved = nearest_turned;
            std::optional<std::size_t> best_turned, best_moved;
            for (std::size_t b = 0; b < cameras.size(); ++b) {
                const double angle = turn_between(cameras[a], cameras[b]);
                const double way = (cameras[a].translation() - cameras[b].translation()).norm();
                if (angle >= least && angle <= 2 * least && way < nearest_turned) {
                    nearest_turned = way;
                    best_turned = b;
                } else if (angle < least && way >= least * typical_depth_m_ &&
                           way <= 2 * least * typical_depth_m_ && way < nearest_moved) {
                    nearest_moved = way;
                    best_moved = b;
                }
            }
            if (const auto b = best_turned ? best_turned : best_moved)
                pairs.push_back({std::min(a, *b), std::max(a, *b)});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

PoseComparison::Verdict PoseComparison::verdict() const {
    Verdict out;
    out.contradiction = find_contradiction();
    if (!out.contradiction) return out;
    for (const Pair& pair : turned_pairs()) {
        if (!frames_.has(pair.a) || !frames_.has(pair.b)) continue;
        ++out.pairs;
        for (std::size_t n = 0; n < pose_conventions; ++n) {
            const auto convention = static_cast<PoseConvention>(n);
            out.agreement[n] += sum(frames_.compare(
                pair.a, pair.b,
                meant(poses_[pair.b], convention).inverse() * meant(poses_[pair.a], convention)));
        }
    }
    out.better = better_than_given(out.agreement);
    return out;
}

}  // namespace topple::geometry
