// SPDX-License-Identifier: MIT
#include "parses/invariants.h"

#include "result/landscapes_json.h"
#include "result/scene_json.h"

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

void check_labels(const std::vector<std::int32_t>& primitive,
                  const std::vector<std::int32_t>& object, const Scene& scene,
                  const std::string& of) {
    const auto primitives = static_cast<std::int32_t>(scene.primitives.size());
    expect(primitive.size() == object.size(), of + ": labels are not one each");
    for (std::size_t n = 0; n < primitive.size(); ++n) {
        expect(primitive[n] >= -1 && primitive[n] < primitives, of + ": no such primitive");
        const std::int32_t its = primitive[n] < 0 ? -1 : scene.primitives[primitive[n]].object;
        expect(object[n] == its, of + ": its object is not its primitive's");
    }
}

void check_parts(const Scene& scene) {
    std::vector<int> owners(scene.primitives.size());
    for (std::size_t n = 0; n < scene.objects.size(); ++n) {
        const Object& o = scene.objects[n];
        expect(o.id == static_cast<std::int32_t>(n), "an object's id is not its place");
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
    std::vector<std::uint64_t> voxels(scene.primitives.size());
    for (const std::int32_t p : scene.solid.primitive)
        if (p >= 0) ++voxels.at(static_cast<std::size_t>(p));
    for (std::size_t n = 0; n < owners.size(); ++n) {
        const Primitive& p = scene.primitives[n];
        expect(p.id == static_cast<std::int32_t>(n), "a primitive's id is not its place");
        expect(owners[n] == 1, "a primitive is not of one object");
        expect(p.solid_voxels <= voxels[n], "a primitive has more voxels than the grid");
        expect_amount(p.volume_m3, "a volume");
        expect_amount(p.mass_kg, "a mass");
        for (const double v : p.center_of_mass_m)
            expect(std::isfinite(v), "a centre is not finite");
    }
}

void check_object(const Object& o, std::size_t objects) {
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
        for (const double v :
             {tips.tilt_error_deg, tips.push_N, tips.push_error_N, tips.slide_N, tips.shake_g})
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
        expect(std::abs(std::hypot(way[0], way[1], way[2]) - 1) < 1e-9,
               "a push has no unit direction");
    }
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
    for (const auto* risks : {&o.risk_J, &o.risk_spread_J, &o.risk_error_J})
        for (const auto& [name, joules] : *risks) expect_amount(joules, "the risk by " + name);
    expect_amount(o.fall.hits_J, "the energy of a landing");
    if (!std::isnan(o.fall.people_share)) expect_share(o.fall.people_share, "who passes a fall");
    // Without any disturbance nothing is ranked.
    const bool ranked = o.grounded || (o.seen_enough && !o.risk_J.empty());
    expect(o.unsafety_category.empty() != ranked, "a category of what was not seen");
    for (const auto& [name, share] : o.fall_chance) expect_share(share, "the chance by " + name);
    const auto count = static_cast<std::int32_t>(objects);
    for (const std::int32_t id : {o.why.lands_on, o.fall.lands_on})
        expect(id >= -1 && id < count, "it lands on no object");
    for (const auto* ids : {&o.why.stands_on, &o.fall.takes_along})
        for (const std::int32_t id : *ids)
            expect(id >= 0 && id < count && id != o.id,
                   "it stands on, or takes along, no other object");
    expect(!o.why.sentence.empty() || o.grounded, "nothing says why");
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

void check_relations(const Scene& scene) {
    const auto primitives = static_cast<std::int32_t>(scene.primitives.size());
    const auto objects = static_cast<std::int32_t>(scene.objects.size());
    for (const Contact& c : scene.contacts) {
        expect(c.a >= 0 && c.b >= 0 && c.a < primitives && c.b < primitives && c.a != c.b,
               "a contact joins no two primitives");
        expect_amount(c.area_m2, "a contact's area");
        expect_share(c.probability, "a contact's probability");
        expect(std::abs(std::hypot(c.normal[0], c.normal[1], c.normal[2]) - 1) < 1e-6,
               "a contact's normal is not unit");
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

void check(const Scene& scene) {
    check_labels(scene.points.primitive, scene.points.object, scene, "points");
    check_labels(scene.solid.primitive, scene.solid.object, scene, "voxels");
    for (const std::uint8_t state : scene.solid.state) expect(state <= 1, "no state of a voxel");
    check_parts(scene);
    for (const Object& o : scene.objects) {
        check_object(o, scene.objects.size());
        if (!o.grounded) check_landscape(o, scene.up);
    }
    check_relations(scene);
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
        expect(back.primitives.size() == scene.primitives.size() &&
                   back.objects.size() == scene.objects.size() &&
                   back.contacts.size() == scene.contacts.size() &&
                   back.supports.size() == scene.supports.size(),
               "scene.json has other counts");
        for (std::size_t n = 0; n < scene.primitives.size(); ++n)
            expect(back.primitives[n].object == scene.primitives[n].object,
                   "scene.json has a primitive in another object");
        check_ply(folder / "points.ply", scene.points.primitive, scene.points.object);
        check_ply(folder / "solid.ply", scene.solid.primitive, scene.solid.object);
    });
}

}  // namespace topple::parses
