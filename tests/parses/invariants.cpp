// SPDX-License-Identifier: MIT
#include "parses/invariants.h"

#include "core/vectors.h"
#include "physics/landscape.h"
#include "result/landscapes_json.h"
#include "result/scene_json.h"
#include "topple/ask.h"

namespace topple::parses {
namespace {

struct Wrong {
    std::string what;
};

void expect(bool holds, const std::string& what) {
    if (!holds) throw Wrong{what};
}

// Finite and not negative.
void expect_amount(double value, const std::string& what) {
    expect(std::isfinite(value) && value >= 0, what + " is " + std::to_string(value));
}

void expect_share(double value, const std::string& what) {
    expect(value >= 0 && value <= 1 + 1e-9, what + " is " + std::to_string(value));
}

void expect_unit(const Vec3& v, const std::string& what) {
    expect(std::abs(length(v) - 1) < 1e-6, what + " is no unit vector");
}

void expect_one_of(const std::string& value, const std::set<std::string>& all) {
    expect(all.contains(value), "\"" + value + "\" is no word for that");
}

void check_head(const Scene& scene) {
    for (const std::string* text :
         {&scene.source, &scene.topple_version, &scene.backend, &scene.device})
        expect(!text->empty(), "a name of what was parsed with what is missing");
    for (const double v : {scene.voxel_size_m, scene.density_kg_m3, scene.friction})
        expect(std::isfinite(v) && v > 0, "what was reckoned with is not above 0");
    expect_unit(scene.up, "up");
    const Mat4& m = scene.manhattan_from_input;
    for (std::size_t row = 0; row < 3; ++row)
        expect_unit({m[4 * row], m[4 * row + 1], m[4 * row + 2]}, "a row of the frame");
    expect(std::equal(m.begin() + 12, m.end(), std::begin({0.0, 0.0, 0.0, 1.0})),
           "the frame's last row is another");
    expect(!scene.timings_s.empty(), "no stage took any time");
    for (const auto& [stage, seconds] : scene.timings_s) expect_amount(seconds, stage);
}

// A label is a primitive's number, or -1, and its object; how many there are of each.
std::vector<std::uint64_t> check_labels(const std::vector<std::int32_t>& primitive,
                                        const std::vector<std::int32_t>& object, const Scene& scene,
                                        const std::string& of) {
    const auto primitives = static_cast<std::int32_t>(scene.primitives.size());
    expect(primitive.size() == object.size(), of + ": labels are not one each");
    std::vector<std::uint64_t> count(scene.primitives.size());
    for (std::size_t n = 0; n < primitive.size(); ++n) {
        expect(primitive[n] >= -1 && primitive[n] < primitives, of + ": no such primitive");
        const std::int32_t its = primitive[n] < 0 ? -1 : scene.primitives[primitive[n]].object;
        expect(object[n] == its, of + ": its object is not its primitive's");
        if (primitive[n] >= 0) ++count[primitive[n]];
    }
    return count;
}

// Closed furniture is boards around contents, of which errors say how much may be in between.
void check_mass(const Primitive& p, const Object& o, const Scene& scene) {
    const double voxel = scene.voxel_size_m, mass = p.volume_m3 * scene.density_kg_m3;
    // Its surface passes through some of its voxels, and through some beside them.
    expect(p.volume_m3 <= 3 * (static_cast<double>(p.solid_voxels) + 1) * voxel * voxel * voxel,
           "a primitive is larger than its voxels");
    if (o.mass_model == "kind") return;
    expect(o.mass_model == "solid" ? std::abs(p.mass_kg - mass) <= 1e-6 * mass + o.mass_error_kg
                                   : p.mass_kg <= mass,
           "a primitive's mass is not its volume's");
}

void check_parts(const Scene& scene) {
    const auto points = check_labels(scene.points.primitive, scene.points.object, scene, "points");
    const auto voxels = check_labels(scene.solid.primitive, scene.solid.object, scene, "voxels");
    std::vector<int> owners(scene.primitives.size());
    for (std::size_t n = 0; n < scene.objects.size(); ++n) {
        const Object& o = scene.objects[n];
        expect(o.id == static_cast<std::int32_t>(n), "an object's id is not its place");
        expect(!o.primitives.empty(), "an object has no primitives");
        double mass = 0;
        for (const std::int32_t p : o.primitives) {
            expect(p >= 0 && static_cast<std::size_t>(p) < owners.size(), "no such primitive");
            const Primitive& primitive = scene.primitives[p];
            expect(primitive.object == o.id, "a primitive is of another object");
            ++owners[p];
            mass += primitive.mass_kg;
        }
        expect(std::abs(mass - o.mass_kg) <= 1e-9 * (mass + o.mass_kg),
               "an object's mass is not its primitives'");
    }
    for (std::size_t n = 0; n < owners.size(); ++n) {
        const Primitive& p = scene.primitives[n];
        expect(p.id == static_cast<std::int32_t>(n), "a primitive's id is not its place");
        expect(owners[n] == 1, "a primitive is not of one object");
        expect(p.points == points[n], "a primitive has other points than are labelled");
        expect(p.solid_voxels <= voxels[n], "a primitive has more voxels than the grid");
        expect_one_of(p.model, {"plane", "quadric", "merged"});
        check_mass(p, scene.objects[p.object], scene);
        expect_amount(p.volume_m3, "a volume");
        expect_amount(p.mass_kg, "a mass");
        for (const double v : p.center_of_mass_m)
            expect(std::isfinite(v), "a centre is not finite");
    }
}

void check_object(const Object& o, std::size_t objects, double voxel_m) {
    for (const double v : {o.mass_kg, o.barrier_J, o.release_J, o.mass_error_kg,
                           o.footprint_error_m, o.barrier_error_J})
        expect_amount(v, "an object's mass, energy or error");
    for (const Vec3& v : {o.center_of_mass_m, o.direction, o.center_of_mass_error_m})
        for (const double c : v) expect(std::isfinite(c), "an object's vector is not finite");
    const Overturning& tips = o.overturning;
    expect(std::isnan(tips.tilt_deg) == std::isnan(tips.push_N) &&
               std::isnan(tips.tilt_deg) == std::isnan(tips.shake_g),
           "only a part of what overturns an object is known");
    if (!std::isnan(tips.tilt_deg)) {
        expect(tips.tilt_deg >= 0 && tips.tilt_deg <= 90, "a tilt is out of 0 to 90 degrees");
        for (const double v : {tips.tilt_error_deg, tips.push_N, tips.push_error_N, tips.slide_N,
                               tips.slide_error_N, tips.shake_g})
            expect_amount(v, "what overturns an object");
    }
    const Fragility& breaks = o.fragility;
    for (std::size_t n = 0; n < breaks.counted.size(); ++n) {
        expect_share(breaks.counted[n].chance, "a chance of falling");
        expect(n == 0 || breaks.counted[n].pga_g > breaks.counted[n - 1].pga_g,
               "peaks of earthquakes don't rise");
    }
    expect((!std::isnan(breaks.pga_g) || std::isnan(breaks.pga_dispersion)) &&
               std::isnan(breaks.pgv_m_s) == std::isnan(breaks.pgv_dispersion),
           "a dispersion without its median");
    for (const double v : {breaks.pga_g, breaks.pga_dispersion, breaks.firm_pga_g, breaks.pgv_m_s,
                           breaks.pgv_dispersion, breaks.falls_per_year, breaks.return_years})
        if (!std::isnan(v)) expect_amount(v, "how an earthquake upsets an object");
    const DirectedBarrier& directed = o.barrier_by_direction;
    expect(directed.blow_J.size() == directed.push_J.size() * directed.height_m.size() &&
               directed.blow_Ns.size() == directed.blow_J.size(),
           "a table of barriers has another size than its sides say");
    for (std::size_t n = 0; n < directed.blow_J.size(); ++n)
        // P^2 / (2 W) is the mass that the blow meets.
        expect(std::isinf(directed.blow_J[n]) ? std::isinf(directed.blow_Ns[n])
                                              : std::pow(directed.blow_Ns[n], 2) <=
                                                    2 * directed.blow_J[n] * o.mass_kg * (1 + 1e-9),
               "a blow brings more than its impulse can");
    expect(std::isnan(o.support_height_m) == std::isnan(o.center_height_m) &&
               std::isnan(o.support_height_m) == (o.grounded || !o.seen_enough),
           "what an object stands on is known in part");
    for (const auto* barriers : {&directed.push_J, &directed.blow_J})
        for (const double joules : *barriers)
            expect(joules >= 0 && joules > o.barrier_J * (1 - 1e-9) - 1e-9,
                   "a push or a blow takes less than the barrier");
    for (std::size_t n = 0; n < directed.push_N.size(); ++n) {
        expect(directed.push_N[n] >= 0 && directed.push_error_N[n] >= 0,
               "a push or its error is negative");
        const Vec3& way = directed.direction[n];
        expect_unit(way, "the way of a push");
    }
    // At most that of a body which rolls, its support known to two voxels: what a sparse scan
    // leaves open.
    expect((o.barrier_error_J > 0) != o.grounded, "a barrier without an error, or no barrier");
    expect(o.barrier_error_J <= (o.mass_kg + 1e-3) * physics::gravity * 2 * voxel_m +
                                    o.barrier_J * o.mass_error_kg / o.mass_kg,
           "a barrier's error is " + std::to_string(o.barrier_error_J));
    expect_share(o.agreement, "an agreement");
    expect_share(o.rest_probability, "the probability of a rest");
    expect(std::isnan(o.unsafety) || (o.unsafety >= 1 && o.unsafety <= 10),
           "unsafety is out of 1 to 10");
    for (std::size_t n = 0; n < o.instability.size(); ++n) {
        expect_amount(o.instability[n].W_J, "a W");
        expect_amount(o.instability[n].S_J, "an S");
        expect(n == 0 || (o.instability[n].W_J >= o.instability[n - 1].W_J &&
                          o.instability[n].S_J >= o.instability[n - 1].S_J),
               "an instability curve falls");
    }
    for (const Alternative& other : o.alternatives) {
        expect_share(other.probability, "the probability of an alternative");
        expect(other.whole >= -1 && other.whole < static_cast<std::int32_t>(objects) &&
                   other.whole != o.id,
               "it may be one with no other object");
        expect(other.mass_kg > 0, "an alternative without a mass");
        expect_amount(other.barrier_J, "the barrier of an alternative");
        expect_amount(other.barrier_error_J, "the error of that");
    }
    for (const auto* risks : {&o.risk_J, &o.risk_spread_J, &o.risk_error_J})
        for (const auto& [name, joules] : *risks) expect_amount(joules, "the risk by " + name);
    expect_amount(o.fall.hits_J, "the energy of a landing");
    if (!std::isnan(o.fall.people_share)) expect_share(o.fall.people_share, "who passes a fall");
    // Without any disturbance nothing is ranked.
    const bool ranked = o.grounded || (o.seen_enough && !o.risk_J.empty());
    expect(o.unsafety_category.empty() != ranked, "a category of what was not seen");
    const auto count = static_cast<std::int32_t>(objects);
    for (const std::int32_t id : {o.why.lands_on, o.fall.lands_on})
        expect(id >= -1 && id < count, "it lands on no object");
    for (const auto* ids : {&o.why.stands_on, &o.fall.takes_along})
        for (const std::int32_t id : *ids)
            expect(id >= 0 && id < count && id != o.id,
                   "it stands on, or takes along, no other object");
}

// Of what its numbers say in words.
void check_why(const Object& o, const Scene& scene) {
    const Why& why = o.why;
    expect(why.W_J == o.barrier_J && why.S_J == o.release_J, "why tells of another barrier");
    std::vector<std::int32_t> carriers;
    for (const Support& s : scene.supports)
        if (s.supported == o.id) carriers.push_back(s.supporter);
    expect(why.stands_on == carriers, "it stands on what does not support it");
    expect(why.edge_m.empty() || why.edge_m.size() == 2, "an edge has no two ends");
    expect_amount(why.drop_m, "a drop");
    expect(why.drop_m == 0 ? why.lands_on == -1
                           : why.S_J >= o.mass_kg * physics::gravity * why.drop_m * (1 - 1e-9),
           "a drop sets free less than it must");
    expect((why.way_m > 0) == (o.mode == "slide" && why.W_J > 0), "a way without a slide");
    expect(why.sentence.ends_with("."), "nothing says why");
    expect_one_of(o.mode, {"tip", "slide", "none"});
    expect(std::abs(length(o.direction) - (o.mode == "none" ? 0 : 1)) < 1e-6,
           "a way out has no direction");
    if (o.mode == "none") return;
    // Clockwise from the second axis of the scene's frame.
    const Mat4& m = scene.manhattan_from_input;
    const double azimuth = why.azimuth_deg * std::numbers::pi / 180;
    expect(std::abs(std::sin(azimuth) - dot({m[0], m[1], m[2]}, o.direction)) < 1e-6 &&
               std::abs(std::cos(azimuth) - dot({m[4], m[5], m[6]}, o.direction)) < 1e-6,
           "an azimuth is not that of its direction");
}

// How sure its risks are, where it would fall, and what to do about it.
void check_prospects(const Object& o, const Scene& scene) {
    double worst = 0;
    bool falls = false;
    for (const auto& [name, risk] : o.risk_J) {
        const double chance = o.fall_chance.at(name);
        expect_share(chance, "the chance by " + name);
        expect((chance > 0) == (risk > 0), "a risk without a chance by " + name);
        expect(o.risk_error_J.at(name) >= o.risk_spread_J.at(name), "an error below its part");
        expect(scene.fields.contains(name), "a risk by what was not asked for");
        falls = falls || chance > 0;
        worst = std::max(worst, risk);
    }
    expect(o.risk_J.size() == scene.fields.size(), "a risk by what was asked for is missing");
    expect(o.fall.falls == falls, "whether it falls is another thing");
    expect(std::isfinite(length(o.fall.lands_m)), "it lands nowhere");
    if (o.unsafety_category.empty())
        expect(!o.unsafety_certain, "what is not known is certain");
    else
        expect_one_of(o.unsafety_category, {"none", "low", "medium", "high"});
    expect(std::isnan(o.unsafety) == o.unsafety_category.empty(), "a rank without a category");
    const Advice& advice = o.advice;
    expect_one_of(advice.kind, {"", "see", "check", "move", "fix"});
    expect(advice.sentence.empty() == advice.kind.empty(), "advice without words");
    const double tolerable_J = scene.events.at("tolerable_J");
    const bool to_act = advice.kind == "check" || advice.kind == "move" || advice.kind == "fix";
    expect(to_act == (worst > tolerable_J), "advice that is not as the risk");
    if (advice.kind == "move")
        expect(length(advice.move_m) > 0 && advice.risk_J <= tolerable_J, "moved to no avail");
    else
        expect(length(advice.move_m) == 0, "what is not to be moved is moved");
}

// But for pairs that carry one another. What nothing carries any more goes, until nothing is left
// (Kahn).
void check_acyclic(const std::set<std::pair<std::int32_t, std::int32_t>>& stated,
                   std::size_t objects) {
    std::vector<std::vector<std::size_t>> carries(objects);
    std::vector<int> carriers(objects);
    for (const auto& [supporter, supported] : stated) {
        if (stated.contains({supported, supporter})) continue;
        carries[supporter].push_back(static_cast<std::size_t>(supported));
        ++carriers[supported];
    }
    std::vector<std::size_t> free;
    for (std::size_t n = 0; n < objects; ++n)
        if (carriers[n] == 0) free.push_back(n);
    for (std::size_t gone = 0; gone < free.size(); ++gone) {
        for (const std::size_t o : carries[free[gone]])
            if (--carriers[o] == 0) free.push_back(o);
    }
    expect(free.size() == objects, "objects carry one another in a cycle");
}

void check_possible_things(const Scene& scene) {
    std::set<std::int32_t> seen;
    for (const PossibleThing& thing : scene.possible_things) {
        expect_share(thing.probability, "the probability of a possible thing");
        expect(!thing.primitives.empty(), "a possible thing of nothing");
        expect(thing.spots_m.size() == thing.primitives.size(), "a part without a spot");
        for (const std::int32_t p : thing.primitives) {
            expect(seen.insert(p).second, "two possible things share a part");
            const std::int32_t o = scene.primitives.at(static_cast<std::size_t>(p)).object;
            expect(scene.objects.at(static_cast<std::size_t>(o)).grounded,
                   "a possible thing is an object, too");
        }
        expect(thing.mass_kg > 0, "a possible thing without a mass");
        expect_amount(thing.barrier_J, "the barrier of a possible thing");
        expect_amount(thing.barrier_error_J, "the error of that");
        for (const auto& [name, joules] : thing.risk_J)
            expect_amount(joules, "its risk by " + name);
    }
}

void check_relations(const Scene& scene) {
    const auto primitives = static_cast<std::int32_t>(scene.primitives.size());
    const auto objects = static_cast<std::int32_t>(scene.objects.size());
    for (const Contact& c : scene.contacts) {
        expect(c.a >= 0 && c.b >= 0 && c.a < primitives && c.b < primitives && c.a != c.b,
               "a contact joins no two primitives");
        expect_amount(c.area_m2, "a contact's area");
        expect_share(c.probability, "a contact's probability");
        expect_unit(c.normal, "a contact's normal");
        expect_one_of(c.relation, {"fixed", "support", "adjacent"});
        expect((c.relation == "fixed") ==
                   (scene.primitives[c.a].object == scene.primitives[c.b].object),
               "what is fixed is not what is one object");
    }
    std::set<std::pair<std::int32_t, std::int32_t>> stated;
    for (const Support& s : scene.supports) {
        expect(s.supporter >= 0 && s.supported >= 0 && s.supporter < objects &&
                   s.supported < objects && s.supporter != s.supported,
               "a support joins no two objects");
        expect_amount(s.area_m2, "a support's area");
        expect_share(s.probability, "a support's probability");
        expect(stated.insert({s.supporter, s.supported}).second, "a support is there twice");
    }
    check_acyclic(stated, scene.objects.size());
}

// The landscape's pose "now" is the one that was scanned, and the lowest way out of it is the
// barrier of what tips.
void check_landscape(const Object& o, const Vec3& up) {
    const Landscape& l = o.landscape;
    expect(l.now >= 0 && static_cast<std::size_t>(l.now) < l.poses.size(),
           "a landscape has no pose now");
    const Landscape::Pose& now = l.poses[l.now];
    for (std::size_t a = 0; a < 3; ++a)
        expect(std::abs(now.up[a] - up[a]) < 1e-6, "a landscape's pose now is another");
    double barrier = now.joins_at_J;
    for (const Landscape::Pose& pose : l.poses)
        if (pose.joins == l.now) barrier = std::min(barrier, pose.joins_at_J);
    if (o.mode == "tip")
        expect(std::abs(barrier - now.energy_J - o.barrier_J) <=
                   o.barrier_error_J + 1e-6 * (1 + o.barrier_J),
               "a landscape's barrier is " + std::to_string(barrier - now.energy_J) + ", not " +
                   std::to_string(o.barrier_J));
}

// What is loose can be taken away, once each, and what falls without one is loose.
void check_answers(const Scene& scene) {
    std::vector<int> times(scene.objects.size(), 0);
    for (const auto& step : removal_steps(scene))
        for (const std::int32_t id : step) ++times.at(id);
    for (const Object& o : scene.objects)
        expect(times[o.id] == (o.grounded ? 0 : 1), "an object is not taken away once");
    const auto loose = std::ranges::find(scene.objects, false, &Object::grounded);
    if (loose == scene.objects.end()) return;
    for (const Unheld& one : falls_without(scene, {loose->id}).falls) {
        expect(one.object != loose->id && times.at(one.object) == 1, "what falls is not loose");
        expect(!one.reason.empty(), "what falls has no reason");
    }
}

void check(const Scene& scene) {
    check_head(scene);
    for (const std::uint8_t state : scene.solid.state) expect(state <= 1, "no state of a voxel");
    check_parts(scene);
    check_possible_things(scene);
    for (const Object& o : scene.objects) {
        check_object(o, scene.objects.size(), scene.voxel_size_m);
        check_why(o, scene);
        check_prospects(o, scene);
        if (!o.grounded) check_landscape(o, scene.up);
    }
    check_relations(scene);
    check_answers(scene);
    for (const auto& [name, field] : scene.fields) {
        for (const auto* values : {&field.vx, &field.vy, &field.vz, &field.density})
            for (const float v : *values) expect(std::isfinite(v), "the field of " + name);
    }
}

// The integers in column `from` and the next of a binary PLY of ours, by its header.
std::vector<std::pair<std::int32_t, std::int32_t>> labels_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::size_t count = 0, size = 0, primitive = 0, object = 0;
    for (std::string line; std::getline(in, line) && line != "end_header";) {
        std::istringstream words(line);
        std::string keyword, type, name;
        words >> keyword >> type >> name;
        if (keyword == "element" && type == "vertex") count = std::stoul(name);
        if (keyword != "property") continue;
        if (name == "primitive") primitive = size;
        if (name == "object") object = size;
        size += type == "uchar" ? 1 : 4;
    }
    std::vector<std::pair<std::int32_t, std::int32_t>> out;
    std::string record(size, '\0');
    for (std::size_t n = 0; n < count && in.read(record.data(), static_cast<std::streamsize>(size));
         ++n) {
        std::pair<std::int32_t, std::int32_t> labels;
        std::memcpy(&labels.first, record.data() + primitive, 4);
        std::memcpy(&labels.second, record.data() + object, 4);
        out.push_back(labels);
    }
    return out;
}

void check_ply(const std::filesystem::path& file, const std::vector<std::int32_t>& primitive,
               const std::vector<std::int32_t>& object) {
    const auto labels = labels_of(file);
    expect(labels.size() == primitive.size(), file.filename().string() + " has another count");
    for (std::size_t n = 0; n < labels.size(); ++n)
        expect(labels[n] == std::pair(primitive[n], object[n]),
               file.filename().string() + " has another label");
}

template <class Check>
std::string words_of(const Check& check_it) {
    try {
        check_it();
    } catch (const Wrong& wrong) {
        return wrong.what;
    }
    return {};
}

}  // namespace

std::string what_is_wrong(const Scene& scene) {
    return words_of([&] { check(scene); });
}

std::string what_is_wrong(const Scene& scene, const std::filesystem::path& folder) {
    return words_of([&] {
        Scene back = io::read_scene_json(folder / "scene.json");
        io::read_landscapes_json(folder / "landscapes.json", back);
        expect(io::scene_json(back) == io::scene_json(scene), "scene.json tells of another");
        check_ply(folder / "points.ply", scene.points.primitive, scene.points.object);
        check_ply(folder / "solid.ply", scene.solid.primitive, scene.solid.object);
    });
}

}  // namespace topple::parses
