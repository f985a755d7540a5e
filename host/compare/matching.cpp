// SPDX-License-Identifier: MIT
#include "compare/matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "core/alike.h"
#include "core/rotation.h"
#include "safety/unsafety_category.h"

namespace topple::comparing {
namespace {

// Of the voxels of either of two, those that lie in the other.
constexpr double least_shared = 0.25;
// Of the seen surface of what came or went, that which the other shows to be free; of what moved
// aside.
constexpr double mostly = 0.6, some = 0.1;
// Of its surface, that whose place the other must have seen.
constexpr double least_seen = 0.3;
// Of that, what must be away from other things to be judged by alone.
constexpr double least_clear = 0.2;
constexpr double aside_m = 0.05;
// Solid volumes of one thing differ by less than this factor, as undersides are completed or not;
// its mean colours by less than this distance in sRGB, of 255, as lamps differ.
constexpr double alike_volume = 2.5, alike_colour = 60;

// What the other result shows at the places of an object's seen surface.
struct Places {
    double all = 0, free = 0, solid = 0;
    double clear_free = 0, clear_solid = 0;  // of those away from other things
    std::map<std::int32_t, double> of;       // by object there
    double seen() const { return free + solid; }
    bool known() const { return all > 0 && seen() >= least_seen * all; }
    // Near other things, which stay, a place is solid whatever became of this one: those count only
    // where there are hardly any others.
    double free_share() const {
        const double clear = clear_free + clear_solid;
        if (clear >= least_clear * seen() && clear > 0) return clear_free / clear;
        return seen() > 0 ? free / seen() : 0;
    }
};

Mat4 inverse(const Mat4& m) {
    const Rotation r = rotation_of(m);
    const Vec3 to = turned_back(r, {m[3], m[7], m[11]});
    return {r[0][0], r[1][0], r[2][0], -to[0], r[0][1], r[1][1], r[2][1], -to[1],
            r[0][2], r[1][2], r[2][2], -to[2], 0,       0,       0,       1};
}

// By object. to: from its frame to the other's.
std::vector<Places> places_of(const Side& side, const Side& other, const Mat4& to) {
    std::vector<Places> out(side.scene.objects.size());
    const SolidVoxels& solid = side.scene.solid;
    for (std::size_t n = 0; n < solid.x.size(); ++n) {
        if (solid.object[n] < 0 || solid.state[n] != 0) continue;
        Places& places = out[static_cast<std::size_t>(solid.object[n])];
        const Vec3 here{solid.x[n], solid.y[n], solid.z[n]};
        const std::int32_t is =
            other.space.at(transformed(other.scene.manhattan_from_input, transformed(to, here)));
        const bool is_free = is == SeenSpace::free, is_solid = is >= SeenSpace::of_none;
        ++places.all;
        places.free += is_free;
        places.solid += is_solid;
        if ((is_free || is_solid) &&
            !side.space.near_others(transformed(side.scene.manhattan_from_input, here),
                                    solid.object[n])) {
            places.clear_free += is_free;
            places.clear_solid += is_solid;
        }
        if (is >= 0) ++places.of[is];
    }
    return out;
}

// What tells an object wherever it stands.
struct Looks {
    Vec3 size_m{}, middle_m{};  // the middle in A's frame
    double volume_m3 = 0;
    Vec3 colour{};
    bool coloured = false;
};

std::vector<Looks> looks_of(const Scene& scene, const Mat4& to_a) {
    std::vector<Looks> out(scene.objects.size());
    for (std::size_t n = 0; n < out.size(); ++n) {
        out[n].size_m = scene.objects[n].size_m;
        out[n].middle_m = transformed(to_a, scene.objects[n].box_middle_m);
    }
    for (const Primitive& part : scene.primitives)
        if (part.object >= 0)
            out[static_cast<std::size_t>(part.object)].volume_m3 += part.volume_m3;
    const ScenePoints& points = scene.points;
    std::vector<double> count(out.size());
    for (std::size_t n = 0; n < points.red.size(); ++n) {
        if (points.object[n] < 0 || (points.red[n] | points.green[n] | points.blue[n]) == 0)
            continue;
        const auto object = static_cast<std::size_t>(points.object[n]);
        ++count[object];
        out[object].colour =
            plus(out[object].colour,
                 {double(points.red[n]), double(points.green[n]), double(points.blue[n])});
    }
    for (std::size_t n = 0; n < out.size(); ++n) {
        out[n].coloured = count[n] > 0;
        if (out[n].coloured) out[n].colour = along({}, 1 / count[n], out[n].colour);
    }
    return out;
}

bool are_alike(const Looks& a, const Looks& b) {
    const double less = std::min(a.volume_m3, b.volume_m3),
                 more = std::max(a.volume_m3, b.volume_m3);
    return alike_sizes(a.size_m, b.size_m) && more <= alike_volume * less &&
           (!a.coloured || !b.coloured || length(minus(a.colour, b.colour)) <= alike_colour);
}

struct Scored {
    double score;  // the more the better
    std::size_t a, b;
};

class Matching {
  public:
    Matching(const Side& a, const Side& b, const Mat4& a_from_b)
        : a_(a.scene),
          b_(b.scene),
          in_b_(places_of(a, b, inverse(a_from_b))),
          in_a_(places_of(b, a, a_from_b)),
          looks_a_(looks_of(a_, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})),
          looks_b_(looks_of(b_, a_from_b)),
          b_of_(a_.objects.size(), none),
          a_of_(b_.objects.size(), none) {}

    std::vector<ComparedThing> match() {
        take(in_place());
        const std::vector<bool> stays = found_so_far();
        take(elsewhere());
        std::vector<ComparedThing> out;
        for (std::size_t a = 0; a < a_.objects.size(); ++a)
            if (!a_.objects[a].grounded) out.push_back(of_a(a, stays[a]));
        for (std::size_t b = 0; b < b_.objects.size(); ++b)
            if (!b_.objects[b].grounded && a_of_[b] == none)
                out.push_back(alone(in_a_[b], Became::came, none, b));
        return out;
    }

  private:
    static constexpr std::size_t none = ~std::size_t{0};

    // Where most of the same voxels are solid in both.
    std::vector<Scored> in_place() const {
        std::vector<Scored> out;
        for (std::size_t a = 0; a < a_.objects.size(); ++a) {
            if (a_.objects[a].grounded) continue;
            for (const auto& [object, count] : in_b_[a].of) {
                const auto b = static_cast<std::size_t>(object);
                if (b_.objects[b].grounded) continue;
                const auto back = in_a_[b].of.find(static_cast<std::int32_t>(a));
                const double both = count + (back == in_a_[b].of.end() ? 0 : back->second);
                // What the other did not see says nothing against it.
                const double shared = both / std::max(1.0, in_b_[a].seen() + in_a_[b].seen());
                if (shared >= least_shared) out.push_back({shared, a, b});
            }
        }
        return out;
    }
    // What left its place and what came to another one, if alike; the nearest first.
    std::vector<Scored> elsewhere() const {
        std::vector<Scored> out;
        for (std::size_t a = 0; a < a_.objects.size(); ++a) {
            if (!left(in_b_[a]) || b_of_[a] != none || a_.objects[a].grounded) continue;
            for (std::size_t b = 0; b < b_.objects.size(); ++b)
                if (left(in_a_[b]) && a_of_[b] == none && !b_.objects[b].grounded &&
                    are_alike(looks_a_[a], looks_b_[b]))
                    out.push_back({-way_m(a, b), a, b});
        }
        return out;
    }
    static bool left(const Places& places) {
        return places.known() && places.free_share() >= mostly;
    }
    double way_m(std::size_t a, std::size_t b) const {
        return length(minus(looks_b_[b].middle_m, looks_a_[a].middle_m));
    }
    void take(std::vector<Scored> scored) {
        std::ranges::sort(scored, [](const Scored& one, const Scored& other) {
            return std::tuple(-one.score, one.a, one.b) <
                   std::tuple(-other.score, other.a, other.b);
        });
        for (const Scored& one : scored) {
            if (b_of_[one.a] != none || a_of_[one.b] != none) continue;
            b_of_[one.a] = one.b;
            a_of_[one.b] = one.a;
        }
    }
    std::vector<bool> found_so_far() const {
        std::vector<bool> out;
        for (const std::size_t b : b_of_) out.push_back(b != none);
        return out;
    }

    ComparedThing of_a(std::size_t a, bool stays) const {
        const std::size_t b = b_of_[a];
        if (b == none) return alone(in_b_[a], Became::went, a, none);
        ComparedThing out;
        out.a = static_cast<std::int32_t>(a);
        out.b = static_cast<std::int32_t>(b);
        tell_places(in_b_[a], out);
        const bool aside = in_b_[a].free_share() >= some && in_a_[b].free_share() >= some &&
                           way_m(a, b) >= aside_m && are_alike(looks_a_[a], looks_b_[b]);
        if (!stays || aside) {
            out.became = Became::moved;
            out.moved_m = way_m(a, b);
        }
        judge(a, b, out);
        return out;
    }
    static void tell_places(const Places& places, ComparedThing& out) {
        out.free = places.all > 0 ? places.free / places.all : 0;
        out.solid = places.all > 0 ? places.solid / places.all : 0;
    }
    static ComparedThing alone(const Places& places, Became if_free, std::size_t a, std::size_t b) {
        ComparedThing out;
        if (a != none) out.a = static_cast<std::int32_t>(a);
        if (b != none) out.b = static_cast<std::int32_t>(b);
        tell_places(places, out);
        out.became = left(places) ? if_free : places.known() ? Became::merged : Became::unseen;
        return out;
    }

    void judge(std::size_t of_a, std::size_t of_b, ComparedThing& out) const {
        const Object &a = a_.objects[of_a], &b = b_.objects[of_b];
        out.stands_otherwise = stands_otherwise(a, b, out.became == Became::moved);
        // What was told apart otherwise is another thing.
        if (!a.seen_enough || !b.seen_enough || !are_alike(looks_a_[of_a], looks_b_[of_b])) return;
        // The largest risk of the disturbances that both were parsed for.
        double before = 0, after = 0, before_error = 0, after_error = 0;
        for (const auto& [name, risk] : a.risk_J) {
            const auto other = b.risk_J.find(name);
            if (other == b.risk_J.end()) continue;
            const auto error = [&](const Object& o) {
                const auto at = o.risk_error_J.find(name);
                return at == o.risk_error_J.end() ? 0 : at->second;
            };
            if (risk >= before) before = risk, before_error = error(a);
            if (other->second >= after) after = other->second, after_error = error(b);
        }
        constexpr double errors = 2;
        if (std::abs(after - before) <= errors * std::hypot(before_error, after_error)) return;
        out.less_safe = rank(b) > rank(a) && after > before;
        out.safer = rank(b) < rank(a) && after < before;
    }
    static int rank(const Object& object) {
        using safety::Category;
        int rank = 0;
        for (const Category c : {Category::none, Category::low, Category::medium, Category::high}) {
            if (object.unsafety_category == safety::to_string(c)) break;
            ++rank;
        }
        return rank;
    }
    // Things of A that hold an object; `none`: the building.
    template <class ThingOf>
    static std::set<std::size_t> holders(const Scene& scene, const Object& object,
                                         const ThingOf& thing_of) {
        std::set<std::size_t> out;
        for (const Support& support : scene.supports) {
            if (support.supported != object.id) continue;
            const auto on = static_cast<std::size_t>(support.supporter);
            out.insert(scene.objects[on].grounded ? none : thing_of(on));
        }
        return out;
    }
    bool stands_otherwise(const Object& a, const Object& b, bool moved) const {
        // What came, and what was told apart otherwise, which may be what held it.
        constexpr std::size_t new_one = none - 1, unknown = none - 2;
        const auto before = holders(a_, a, [](std::size_t on) { return on; });
        const auto after = holders(b_, b, [&](std::size_t on) {
            return a_of_[on] != none ? a_of_[on] : left(in_a_[on]) ? new_one : unknown;
        });
        if (before.empty() || after.empty() || after.contains(unknown)) return false;
        // What stays where it is has other holders only where those have left.
        const auto has_left = [&](std::size_t on) { return on != none && left(in_b_[on]); };
        if (!moved && std::ranges::none_of(before, has_left)) return false;
        return std::ranges::none_of(after, [&](std::size_t on) { return before.contains(on); });
    }

    const Scene &a_, &b_;
    std::vector<Places> in_b_, in_a_;  // of the objects of A and of B
    std::vector<Looks> looks_a_, looks_b_;
    std::vector<std::size_t> b_of_, a_of_;
};

}  // namespace

std::vector<ComparedThing> match_things(const Side& a, const Side& b, const Mat4& a_from_b) {
    return Matching(a, b, a_from_b).match();
}

}  // namespace topple::comparing
