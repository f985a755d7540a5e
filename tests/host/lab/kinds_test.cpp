// SPDX-License-Identifier: MIT
#include "lab/rooms/kinds.h"

#include <nlohmann/json.hpp>

#include "clouds.h"
#include "host/io/files.h"
#include "lab/evaluation/kind_score.h"
#include "lab/rooms/composer.h"
#include "lab/scan/scan.h"
#include "lab/temporary_folder.h"
#include "physics/tipping.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using Point = std::array<double, 2>;

std::vector<std::string> composed() {
    std::vector<std::string> names;
    for (const std::string& kind : kinds()) {
        if (kind != "plain" && kind != "varied") names.push_back(kind);
    }
    return names;
}

double area_of(const std::vector<Point>& polygon) {
    double twice = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Point &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

// Places where a part's lowest rim meets another solid, within 3 mm.
void add_contacts(const Part& foot, const Part& below, std::vector<Point>& contacts) {
    const auto box = foot.bounds();
    constexpr int steps = 24;
    for (int i = 0; i <= steps; ++i) {
        for (int k = 0; k <= steps; ++k) {
            const Vec3 p{box[0][0] + (box[1][0] - box[0][0]) * i / steps,
                         box[0][1] + (box[1][1] - box[0][1]) * k / steps, box[0][2]};
            if (foot.distance(p) < 0.003 && below.distance(p) < 0.003)
                contacts.push_back({p[0], p[1]});
        }
    }
}

struct Mass {
    double of = 0;
    Vec3 at{};
};
Mass mass_of(const World& world, std::int32_t object) {
    Mass m;
    for (const Part& part : world.parts) {
        if (part.object != object) continue;
        const double volume = part.volume();
        const Vec3 c = part.center_of_mass();
        for (std::size_t a = 0; a < 3; ++a) m.at[a] += volume * c[a];
        m.of += volume;
    }
    for (double& a : m.at) a /= m.of;
    return m;
}

// Each object with all that it carries alone; what several carry rests on each where it stands.
std::vector<Mass> loads(const World& world) {
    const auto below = supporters(world);
    std::vector<Mass> out(world.objects.size());
    for (std::size_t n = 1; n < out.size(); ++n)
        out[n] = mass_of(world, static_cast<std::int32_t>(n));
    for (std::size_t n = out.size(); n-- > 1;) {  // carriers come before what they carry
        for (const std::int32_t s : below[n]) {
            Mass& m = out[s];
            const double share = out[n].of / static_cast<double>(below[n].size());
            for (std::size_t a = 0; a < 3 && below[n].size() == 1; ++a)
                m.at[a] = (m.of * m.at[a] + share * out[n].at[a]) / (m.of + share);
            m.of += share;
        }
    }
    return out;
}

class EachKind : public ::testing::TestWithParam<std::string> {
  protected:
    static constexpr std::uint64_t seeds = 6;
};
INSTANTIATE_TEST_SUITE_P(Kinds, EachKind, ::testing::ValuesIn(composed()),
                         [](const auto& info) { return info.param; });

TEST_P(EachKind, solids_of_different_things_do_not_overlap) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const World world = make_world(GetParam(), seed);
        std::vector<Bounds> boxes;
        for (const Part& part : world.parts) boxes.push_back(part.bounds());
        for (std::size_t a = 0; a < boxes.size(); ++a) {
            for (std::size_t b = a + 1; b < boxes.size(); ++b) {
                const Part &p = world.parts[a], &q = world.parts[b];
                if (p.object == q.object || !overlap(boxes[a], boxes[b], -0.001)) continue;
                EXPECT_GT(gap(p, q, 2e-4), -0.001)
                    << seed << ": " << p.name << " of " << world.objects[p.object].name << " in "
                    << q.name << " of " << world.objects[q.object].name;
            }
        }
    }
}

// What leans is held from the side, too, and left out.
TEST_P(EachKind, what_stands_has_its_middle_over_what_carries_it) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const World world = make_world(GetParam(), seed);
        const auto fixed = fixed_objects(world);
        const auto load = loads(world);
        for (std::size_t n = 1; n < world.objects.size(); ++n) {
            if (fixed[n]) continue;
            const auto object = static_cast<std::int32_t>(n);
            std::vector<Point> contacts;
            bool leans = world.objects[n].where == "wall";
            std::size_t supports = 0;
            for (const auto& [below, foot] : world.support) {
                const Part& part = world.parts[foot];
                if (part.object != object) continue;
                ++supports;
                leans = leans || (part.shape == Shape::box && part.lean != 0);
                add_contacts(part, world.parts[below], contacts);
            }
            EXPECT_GT(supports, 0u) << seed << ": " << world.objects[n].name;
            if (leans) continue;
            ASSERT_FALSE(contacts.empty()) << seed << ": " << world.objects[n].name << " floats";
            auto corners = contacts;
            for (const Mass& m : {mass_of(world, object), load[n]})
                corners.push_back({m.at[0], m.at[1]});
            EXPECT_LE(area_of(physics::convex_polygon(corners)),
                      1.1 * area_of(physics::convex_polygon(contacts)) + 2e-4)
                << seed << ": " << world.objects[n].name << " on " << world.objects[n].where;
        }
    }
}

TEST_P(EachKind, has_the_same_room_for_a_seed_and_another_for_the_next) {
    const World a = make_world(GetParam(), 4), b = make_world(GetParam(), 4),
                c = make_world(GetParam(), 5);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t n = 0; n < a.parts.size(); ++n) {
        EXPECT_EQ(a.parts[n].center, b.parts[n].center);
        EXPECT_EQ(a.parts[n].colour, b.parts[n].colour);
    }
    EXPECT_TRUE(a.room != c.room || a.parts.size() != c.parts.size());
}

TEST_P(EachKind, scans_are_the_same_bytes_for_one_thread_and_three) {
    const World world = make_world(GetParam(), 2);
    const TemporaryFolder folder("topple_kinds");
    for (const unsigned threads : {1u, 3u}) {
        ScanOptions options{.kind = ScanKind::sparse, .seed = 2, .frames = 12};
        options.threads = threads;
        write_scan(folder.path() / std::to_string(threads), world, scan(world, options), options,
                   GetParam());
    }
    for (const char* file : {"cloud.ply", "truth.ply", "truth.json"})
        EXPECT_EQ(test::bytes_of_file(folder.path() / "1" / file),
                  test::bytes_of_file(folder.path() / "3" / file))
            << file;
}

TEST_P(EachKind, truth_names_every_object_that_it_labels) {
    const World world = make_world(GetParam(), 3);
    // Rays as coarse as 0.1 m apart take a far floor for an edge, whose pixels are mixed.
    const ScanOptions options{.kind = ScanKind::laser, .seed = 3, .frames = 0, .spacing_m = 0.05};
    const Scan made = scan(world, options);
    const TemporaryFolder folder("topple_kinds");
    write_scan(folder.path(), world, made, options, GetParam());
    const auto truth = nlohmann::json::parse(test::bytes_of_file(folder.path() / "truth.json"));
    std::set<int> ids;
    for (const auto& object : truth["objects"]) ids.insert(object["id"].get<int>());
    for (const auto& object : truth["objects"]) {
        for (const auto& s : object["supporters"]) EXPECT_TRUE(ids.contains(s.get<int>()));
        EXPECT_TRUE(object["fixed"].get<bool>() || !object["supporters"].empty()) << object;
    }
    for (const LabelledPoint& p : made.truth) ASSERT_TRUE(ids.contains(p.object));
    // The scan lies on its truth but for noise and mixed pixels.
    std::vector<Vec3> places;
    for (const ColouredPoint& p : made.cloud) places.push_back(p.at);
    const auto labels = nearest_objects(places, made.truth, 0.06);
    const auto near = std::count_if(labels.begin(), labels.end(), [](auto l) { return l >= 0; });
    EXPECT_GT(static_cast<double>(near), 0.9 * static_cast<double>(labels.size()));
}

TEST(Kinds, an_unknown_one_is_refused_by_name) {
    EXPECT_THAT(test::message_of([] { make_world("castle", 1); }, std::nullopt),
                testing::AllOf(testing::HasSubstr("castle"), testing::HasSubstr("kitchen")));
}

}  // namespace
}  // namespace topple::scenes

namespace topple::evaluation {
namespace {

// A parse that found exactly what is there, each object as one primitive.
Scene perfect(const scenes::World& world, const scenes::Scan& scan) {
    Scene scene;
    const auto fixed = scenes::fixed_objects(world);
    const auto body = [&](std::int32_t object) { return fixed[object] ? 0 : object; };
    for (const auto& p : scan.truth) {
        test::add(scene.points, p.at[0], p.at[1], p.at[2]);
        scene.points.object.push_back(body(p.object));
        scene.points.primitive.push_back(p.object);
    }
    for (std::int32_t n = 0; n < static_cast<std::int32_t>(fixed.size()); ++n) {
        Primitive primitive;
        primitive.id = n;
        primitive.object = body(n);
        scene.primitives.push_back(primitive);
        if (body(n) != n) continue;
        Object object;
        object.id = n;
        object.grounded = n == 0;
        scene.objects.push_back(object);
    }
    const auto below = scenes::supporters(world);
    for (std::size_t n = 1; n < below.size(); ++n) {
        const auto id = static_cast<std::int32_t>(n);
        for (const std::int32_t s : below[n]) {
            scene.supports.push_back({body(s), body(id), 0.01});
            Contact contact;
            contact.a = s;
            contact.b = id;
            scene.contacts.push_back(contact);
        }
    }
    return scene;
}

class KindScoring : public ::testing::Test {
  protected:
    const scenes::World world = scenes::make_world("office", 3);
    const scenes::Scan scan = scenes::scan(
        world, {.kind = scenes::ScanKind::laser, .seed = 3, .frames = 0, .spacing_m = 0.03});
    Scene scene = perfect(world, scan);
};

TEST_F(KindScoring, a_perfect_parse_has_all) {
    const KindScore s = judge_kind(world, scan, scene);
    EXPECT_GT(s.objects, 3u);
    EXPECT_EQ(s.miou, 1);
    EXPECT_EQ(s.found, 1);
    EXPECT_EQ(s.found_alone, 1);
    EXPECT_EQ(s.found_best, 1);
    EXPECT_EQ(s.support_recall, 1);
    EXPECT_EQ(s.support_precision, 1);
    EXPECT_EQ(s.swallowed, 0);
}

TEST_F(KindScoring, all_in_the_ground_has_nothing) {
    for (Object& o : scene.objects) o.grounded = true;
    const KindScore s = judge_kind(world, scan, scene);
    EXPECT_EQ(s.found, 0);
    EXPECT_EQ(s.found_alone, 1);
    EXPECT_EQ(s.support_recall, 0);
    EXPECT_EQ(s.swallowed, 1);
    EXPECT_LT(s.joint_precision, 1);
}

TEST(KindsTable, a_row_for_each_kind_and_one_for_all) {
    KindScore a, b;
    a.kind = "kitchen";
    a.found = 0.25;
    b.kind = "office";
    b.found = 0.75;
    const std::string table = kinds_table({a, b});
    for (const char* text : {"kitchen", "office", "all", "25.0", "75.0", "50.0"})
        EXPECT_NE(table.find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace topple::evaluation
