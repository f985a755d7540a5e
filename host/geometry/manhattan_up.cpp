// SPDX-License-Identifier: MIT
#include "geometry/manhattan_up.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/number_text.h"
#include "geometry/manhattan_profile.h"

namespace topple::geometry {
namespace {

// Planes must hold this share of the surface to decide on up; less where a camera's up is near.
constexpr double least_plane_share = 0.05, least_share_near_camera = 0.02, near_camera_degrees = 45;
// Cameras are held level but for their pitch, which is seldom twice this.
constexpr double usual_pitch_degrees = 30, most_pitch_degrees = 95;
// A camera that is pitched by more than this looks straight down on a floor or table, which fills
// its view; else the plane is a wall.
constexpr double steep_degrees = 60, least_share_from_above = 0.6;
// A plane that faces down (a ceiling, or a wall in a camera's view that is taken for one) tells
// less of up than one that faces up.
constexpr double facing_down = 0.25;
// Surface faces its sensor: where it faces -z by this much on the whole, and no other way, the
// input's axes are those of a camera, z ahead and y down, and not those of a room with z up.
constexpr double camera_facing = 0.6, camera_axis_cos = 0.9;
// Upright surfaces decide on up where they hold this share of all surface.
constexpr double least_upright_share = 0.3;
// Log-odds of a direction against the others by how the scene lies along it: weights of a
// conditional logit (McFadden 1974) over the candidates of generated rooms, whatever way they are
// turned. Below turned_floor, what is turned is noise.
constexpr double extent_weight = -1.75, level_weight = 1.9, clutter_weight = 1.4,
                 lone_end_weight = 1.1, turned_weight = 2.3, turned_floor = 0.02;
// Odds of the input's z, give or take a tilt, and of its y, either way, against any direction; of
// what the file's format says that up is.
constexpr double tilt_degrees = 10, odds_of_z = 50, odds_of_y = 5, odds_of_format = 20;
// Farther from z than this, up is told to the user.
constexpr double customary_degrees = 25;
// Sides that were guessed are never surer than this; less sure, they don't tell up from down.
constexpr double surest_guess = 0.98, unsure_guess = 0.5;
// Directions so far apart are two; both are told where the odds are less than these.
constexpr double apart_degrees = 25, near_odds = 3;
// An up that was given is told to be wrong where the scan's own is farther from it than any floor
// is from level, and likelier by these log-odds, of 20 to 1. Of cameras one in 20 is not held
// level, but on its side or upside down.
constexpr double contradicted_degrees = 30, contradicted_log_odds = 3, rolled_share = 0.05;

constexpr auto seen_from_above =
    "Up was taken to be across a plane that the camera looks straight at, as from above; if it is "
    "a wall, say where up is by up (--up).";
constexpr auto by_looks =
    "Nothing in the input says where up is, and it is not z: it was chosen by how the surfaces "
    "lie; if it is wrong, say where up is by up (--up).";
constexpr auto either_side =
    "Nothing in the scan shows which side of its level surfaces is up: z's was taken; if it is "
    "wrong, say where up is by up (--up).";
constexpr auto by_walls =
    "No level surface was found: up is the direction along the upright ones that is nearest to the "
    "camera's; if it is wrong, say where up is by up (--up).";
constexpr auto not_found =
    "Up could not be found, as no large level or upright surface was seen: it is the camera's or "
    "the input's own; if it is wrong, say where up is by up (--up).";

double degrees_between(const Vec3& a, const Vec3& b) {
    return std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * 180 / std::numbers::pi;
}

Vec3 times(const Vec3& v, double factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
}

// What there is to judge a direction by.
struct Seen {
    const Surfels& surfels;
    const WeightedNormals& normals;
    LargePlanes planes;
    double sides_right;  // probability that surfaces were seen from where they face
    Profile along(const Vec3& axis) const { return profile_along(surfels, normals, planes, axis); }
};

// Sides that were guessed are as sure as the scene is a room around its sensor, or a thing that the
// sensor went around. Stairs, or a bare floor, look the same from below.
Seen look(const Surfels& surfels, const WeightedNormals& normals,
          const std::vector<Vec3>& directions, bool sides_guessed) {
    Seen out{surfels, normals, find_large_planes(surfels, normals, directions), 1};
    if (sides_guessed) out.sides_right = std::min(surest_guess, std::abs(out.planes.enclosing));
    return out;
}

// A direction that may be up.
struct Candidate {
    Vec3 up{};
    bool manhattan = false;
    double score = 0;
    const char* doubt = "";       // as UpChoice::note
    std::optional<Vec3> other{};  // a direction about as likely
};

// The best of them, which knows of another that is about as likely.
Candidate best_of(const std::vector<Candidate>& all) {
    Candidate best, second;
    for (const Candidate& c : all)
        if (c.score > best.score) best = c;
    for (const Candidate& c : all)
        if (degrees_between(c.up, best.up) > apart_degrees && c.score > second.score) second = c;
    if (near_odds * second.score > best.score) best.other = second.up;
    return best;
}

double nearness(const Vec3& a, const Vec3& b, double degrees) {
    const double off = degrees_between(a, b) / degrees;
    return std::exp(-off * off / 2);
}

// Whether cameras are held along the input's z, which is up in most such inputs.
bool along_z(const Vec3& camera_up) {
    return degrees_between(camera_up, {0, 0, 1}) < usual_pitch_degrees;
}

// The evidence of planes across a direction, weighed by how near it is to the camera's up.
Candidate with_camera(const Seen& seen, const std::vector<Candidate>& candidates,
                      const Vec3& camera_up) {
    std::vector<Candidate> all;
    for (Candidate c : candidates) {
        if (dot(c.up, camera_up) < 0) c.up = times(c.up, -1);
        const Profile p = seen.along(c.up);
        for (const bool flipped : {false, true}) {
            const double share =
                (flipped ? p.against : p.along) + facing_down * (flipped ? p.along : p.against);
            Candidate option = c;
            if (flipped) option.up = times(c.up, -1);
            const double pitch = degrees_between(option.up, camera_up);
            if (pitch > most_pitch_degrees) continue;
            const bool steep = pitch > steep_degrees;
            if (steep ? share < least_share_from_above
                      : share < (pitch < near_camera_degrees ? least_share_near_camera
                                                             : least_plane_share)) {
                continue;
            }
            if (steep) option.doubt = seen_from_above;
            option.score = share * c.score * nearness(option.up, camera_up, usual_pitch_degrees);
            if (along_z(camera_up))
                option.score *= 1 + odds_of_z * nearness(option.up, {0, 0, 1}, tilt_degrees);
            all.push_back(option);
        }
    }
    return best_of(all);
}

// What is known of a direction before looking: of a format with an up of its own, most have that;
// else most inputs have z up, some have y or -y up.
double prior_odds(const Vec3& up, const std::optional<Vec3>& format_up) {
    const auto near = [&](const Vec3& axis) { return nearness(up, axis, tilt_degrees); };
    if (format_up) return 1 + odds_of_format * near(*format_up);
    return 1 + odds_of_z * near({0, 0, 1}) + odds_of_y * (near({0, 1, 0}) + near({0, -1, 0}));
}

// How the scene lies along an axis, as log-odds of its positive and its negative end being up.
// Where the sides of surfaces are wrong, only their places tell the ends apart.
std::array<double, 2> end_odds(const Profile& p, const Seen& seen) {
    const double axis = extent_weight * std::log(std::max(p.extent_m, 10 * seen.surfels.cell_m)) +
                        turned_weight * std::log(p.turned + turned_floor);
    const double facing = level_weight * p.level_facing + clutter_weight * p.clutter_low +
                          lone_end_weight * p.lone_end,
                 place = lone_end_weight * p.lone_place;
    const auto chance = [](double log_odds) { return 1 / (1 + std::exp(-2 * log_odds)); };
    const auto odds = [&](double sign) {
        return axis + std::log(2 * std::cosh(facing)) +
               std::log(seen.sides_right * chance(sign * facing) +
                        (1 - seen.sides_right) * chance(sign * place));
    };
    return {odds(1), odds(-1)};
}

// Without a camera: rooms are wider than high, what stands is turned about up alone, level surface
// within faces up, and things lie low.
Candidate without_camera(const Seen& seen, const std::vector<Candidate>& candidates,
                         const std::optional<Vec3>& format_up) {
    std::vector<Candidate> all;
    for (const Candidate& c : candidates) {
        const Profile p = seen.along(c.up);
        if (p.along + p.against < least_plane_share && c.up != format_up) continue;
        const auto [up, down] = end_odds(p, seen);
        const bool open = seen.sides_right < unsure_guess && p.lone_place == 0;
        for (const double sign : {1.0, -1.0}) {
            Candidate option = c;
            option.up = times(c.up, sign);
            option.score *= std::exp(sign > 0 ? up : down) * prior_odds(option.up, format_up);
            if (!format_up && degrees_between(option.up, {0, 0, 1}) >= customary_degrees)
                option.doubt = by_looks;
            else if (!format_up && open)
                option.doubt = either_side;
            all.push_back(option);
        }
    }
    return best_of(all);
}

// Near the camera's up, the direction that upright surfaces leave (Gupta et al. 2013): the least
// eigenvector of the sum of w n n^T over normals across it, in windows that narrow. What those
// leave open, as one wall does, stays as the camera has it. Returns whether they are enough.
bool up_from_uprights(const WeightedNormals& normals, Vec3& up) {
    constexpr double camera_weight = 0.01;
    const Vec3 camera = up;
    double share = 0;
    for (const double window : {40.0, 20.0, 10.0, 10.0}) {
        const double widest = std::sin(window * std::numbers::pi / 180);
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        double weight = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            if (std::abs(dot(normals[i], up)) > widest) continue;
            const Eigen::Vector3d n(normals[i].data());
            sum += normals.weight[i] * n * n.transpose();
            weight += normals.weight[i];
        }
        share = weight / normals.total;
        if (!(weight > 0)) return false;
        const Eigen::Vector3d c(camera[0], camera[1], camera[2]);
        sum = sum / weight - camera_weight * c * c.transpose();
        const Eigen::Vector3d least =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(0);
        const double side = least.dot(c) < 0 ? -1 : 1;
        up = unit_or_zero({side * least[0], side * least[1], side * least[2]});
    }
    return share >= least_upright_share;
}

// The up of a camera whose frame the input's axes seem to be.
std::optional<Vec3> implied_camera(const WeightedNormals& normals) {
    Vec3 sum{};
    double size = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const double w = normals.weight[i];
        sum = along(sum, w, normals[i]);
        size += w * std::abs(normals.z[i]);
    }
    const bool ahead = sum[2] < -camera_facing * size && unit_or_zero(sum)[2] < -camera_axis_cos;
    return ahead ? std::optional(Vec3{0, -1, 0}) : std::nullopt;
}

// What surfaces, and the camera where there is one, tell of a direction.
double log_odds_of(const Seen& seen, const Vec3& up, const std::optional<Vec3>& camera) {
    const double looks = end_odds(seen.along(up), seen)[0];
    if (!camera) return looks;
    return looks +
           std::log((1 - rolled_share) * nearness(up, *camera, usual_pitch_degrees) + rolled_share);
}

std::string text_of(const Vec3& v) {
    std::string text;
    for (const double value : v) {
        text.append(text.empty() ? "(" : ", ");
        text.append(to_digits(std::round(value * 100) / 100 + 0.0, 3));
    }
    return text.append(")");
}

std::string two_ups(const Vec3& taken, const Vec3& other) {
    return "Two directions may be up: " + text_of(taken) + ", which was taken, and " +
           text_of(other) + "; say which it is by up (--up).";
}

// Where up is by the scan itself.
struct FoundUp : UpChoice {
    bool level = false;  // by level surface, of which no camera looked straight at a wall
};

// An up that was found where the file's format says what is up.
UpChoice with_format(const Vec3& up, const Vec3& format_up, bool manhattan) {
    if (degrees_between(up, format_up) <= contradicted_degrees) return {up, "format", ""};
    return {up, manhattan ? "manhattan" : "dominant-plane",
            "By its format the file has " + text_of(format_up) + " up, but its surfaces show " +
                text_of(up) + ", which was taken; if it is wrong, say where up is by up (--up)."};
}

FoundUp find_up(const Seen& seen, const std::vector<Vec3>& directions,
                const std::vector<Vec3>& manhattan, const std::optional<Vec3>& camera,
                const std::optional<Vec3>& format_up) {
    const Vec3 own = camera && !along_z(*camera) ? *camera : format_up.value_or(Vec3{0, 0, 1});
    const FoundUp assumed{{own, "assumed", not_found}};
    if (seen.normals.size() == 0) return assumed;

    std::vector<Candidate> candidates;
    // An axis of the best triple goes before a single direction that is no better.
    for (const Vec3& axis : manhattan) candidates.push_back({axis, true, 1.1});
    for (const Vec3& axis : directions) candidates.push_back({axis, false, 1.0});
    if (format_up) candidates.push_back({*format_up, false, 1.0});
    const Candidate best = camera ? with_camera(seen, candidates, *camera)
                                  : without_camera(seen, candidates, format_up);
    if (best.score > 0 && format_up && !camera)
        return {with_format(refine_axis(seen.normals, best.up), *format_up, best.manhattan), true};
    if (best.score > 0) {
        const Vec3 up = refine_axis(seen.normals, best.up);
        return {{up, best.manhattan ? "manhattan" : "dominant-plane",
                 best.other ? two_ups(up, refine_axis(seen.normals, *best.other)) : best.doubt},
                best.doubt != seen_from_above};
    }
    Vec3 up = assumed.up;
    if (camera && up_from_uprights(seen.normals, up)) return {{up, "upright-surfaces", by_walls}};
    return assumed;
}

// Of an up that the scan contradicts: in which way; else "".
std::string doubt_of_given(const Seen& seen, const Vec3& up, const FoundUp& found,
                           const std::optional<Vec3>& camera) {
    const double degrees = degrees_between(up, found.up);
    if (!found.level || degrees <= contradicted_degrees) return {};
    const double ahead = log_odds_of(seen, found.up, camera) -
                         log_odds_of(seen, refine_axis(seen.normals, up), camera);
    if (ahead <= contradicted_log_odds) return {};
    return "The up that was given, " + text_of(up) + ", is " +
           std::to_string(std::lround(degrees)) + " degrees from what the surfaces " +
           (camera ? "and cameras " : "") + "show, " + text_of(found.up) +
           ": an accelerometer at rest reads along up, not down: check its sign and frame.";
}

}  // namespace

UpChoice choose_up(const Surfels& surfels, const WeightedNormals& normals,
                   const std::vector<Vec3>& directions, const std::vector<Vec3>& manhattan,
                   const FrameHints& hints) {
    std::optional<Vec3> camera;
    if (hints.camera_up && dot(*hints.camera_up, *hints.camera_up) > 0)
        camera = unit_or_zero(*hints.camera_up);
    if (!camera && !hints.format_up && !hints.sides_guessed && normals.size() > 0)
        camera = implied_camera(normals);
    const Seen seen = look(surfels, normals, directions, hints.sides_guessed);
    const FoundUp found = find_up(seen, directions, manhattan, camera, hints.format_up);
    if (!hints.up || !(dot(*hints.up, *hints.up) > 0)) return found;
    const Vec3 given = unit_or_zero(*hints.up);
    return {given, "given", doubt_of_given(seen, given, found, camera)};
}

}  // namespace topple::geometry
