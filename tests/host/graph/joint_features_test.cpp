// SPDX-License-Identifier: MIT
#include "graph/joint_features.h"

#include "core/random.h"
#include "errors.h"
#include "geometry/primitive_shapes.h"
#include "graph/greedy_contraction.h"
#include "graph/joints.h"
#include "graph/known_links.h"
#include "graph/stable_objects.h"
#include "host/geometry/sampled_faces.h"
#include "host/graph/chain_walk.h"
#include "host/graph/floor_scene.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::graph {
namespace {

using test::SampledFaces;

// The floor, a table's top on a block, and a box on it; or the box beside the table.
struct BoxAndTable {
    test::FloorScene solids;
    SampledFaces faces;
    geometry::SurfaceSeams seams;
    std::vector<float> shell{0.999f, 0.02f, 0.01f};

    explicit BoxAndTable(double spacing_m, const Vec3& low = {0, 0, 0.4}) : faces(spacing_m) {
        faces.face(0, {-0.8, -0.8, 0}, {1.6, 0, 0}, {0, 1.6, 0});
        add({-0.4, -0.4, 0}, {0.4, 0.4, 0.4});
        add(low, {low[0] + 0.2, low[1] + 0.2, low[2] + 0.2});
        // What it stands on is not seen.
        const geometry::SurfaceSamples& s = faces.samples;
        faces.samples = geometry::samples_where(s, [&](std::size_t n) {
            return s.primitive[n] == 2 || std::abs(s.z[n] - low[2]) > 1e-6 ||
                   std::abs(s.x[n] - low[0] - 0.1) > 0.1 || std::abs(s.y[n] - low[1] - 0.1) > 0.1;
        });
    }
    void add(const Vec3& low, const Vec3& high) {
        faces.box(solids.add(test::box(low, high)), {low[0], low[1], low[2]},
                  {high[0], high[1], high[2]});
    }
    JointTable table(device::Device& device) {
        const ContactGraph contacts = solids.contacts(device);
        return joint_features(
            faces.samples,
            geometry::primitive_shapes(faces.samples, static_cast<std::size_t>(solids.count)),
            contacts, solids.bodies(device), seams, shell, device.threads());
    }
};

double feature(const JointTable& table, std::int32_t a, std::int32_t b, std::string_view name) {
    const auto names = joint_feature_names();
    const auto column = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    const auto row = static_cast<std::size_t>(std::ranges::find(table.pairs, std::pair(a, b)) -
                                              table.pairs.begin());
    EXPECT_LT(column, names.size()) << name;
    EXPECT_LT(row, table.pairs.size()) << a << "-" << b;
    if (column >= names.size() || row >= table.pairs.size()) return NAN;
    return table.rows[row * names.size() + column];
}

class JointFeatures : public test::EachBackend {};
TOPPLE_ON_EACH_BACKEND(JointFeatures);

TEST(JointFeatureNames, AreUnique) {
    const auto names = joint_feature_names();
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST_P(JointFeatures, OfABoxOnATableAreInClosedForm) {
    BoxAndTable scene(0.02);
    scene.seams.between[{1, 2}] = {.variation = 0, .pairs = 40, .flush = 10, .ledge = 4};
    const JointTable table = scene.table(*device);
    const std::vector<std::pair<std::int32_t, std::int32_t>> pairs{{0, 1}, {1, 2}};
    EXPECT_EQ(table.pairs, pairs) << "the box is far above the floor";
    ASSERT_EQ(table.rows.size(), 2 * joint_feature_names().size());
    const auto is = [&](std::string_view name, double value, double error = 1e-3) {
        EXPECT_NEAR(feature(table, 1, 2, name), value, error) << name;
    };
    is("small_on_big", 1);
    is("big_on_small", 0);
    is("touch_area", 0.04);
    is("touch_share_small", 1);
    is("touch_share_big", 0.04 / 0.64);
    is("touch_z", -1);      // from the small one down to the big one
    is("stands_small", 1);  // 10 cm within its support, 10 cm high
    is("stands_big", 2);    // 40 cm within, 20 cm high
    is("stands_both", 2, 0.3);
    is("fill_small", 1, 0.3);  // its bounds by samples are a spacing less than the solid's
    is("volume_small", std::log(0.008));
    is("volume_big", std::log(0.256));
    is("shell_small", 0.01);
    is("shell_big", 0.02);
    is("seam_flush", 0.25);
    is("seam_ledge", 0.1);
    is("seam_pairs", std::log1p(40));
    is("area_small", std::log(5 * 0.04), 0.01);
    is("area_ratio", std::log((0.6 + 4 * 0.32) / 0.2), 0.01);
    is("edge", 0.02);
    is("above_big", 0, 0.025);
    is("plan_small", 1);
    is("plan_big", 1 / 16.0, 0.02);
    is("height_overlap_small", 0, 0.15);
    is("gap_least", std::hypot(0.01, 0.01), 1e-4);  // its lowest row to the top's next samples
    is("concave_share", 1);
    is("rise", -0.5, 0.35);  // down from the small one
    EXPECT_LT(feature(table, 1, 2, "convexity"), -0.5);
    EXPECT_LT(feature(table, 1, 2, "flush_share"), 0.01);
}

// The box beside the table, 2 cm from it: both stand on the floor, and neither on the other.
TEST_P(JointFeatures, OfBoxesSideBySide) {
    BoxAndTable scene(0.02, {0.42, 0, 0});
    const JointTable table = scene.table(*device);
    EXPECT_EQ(table.pairs.size(), 3u);
    EXPECT_EQ(feature(table, 1, 2, "small_on_big"), 0);
    EXPECT_EQ(feature(table, 1, 2, "big_on_small"), 0);
    EXPECT_NEAR(feature(table, 1, 2, "gap_least"), 0.02, 1e-4);
    EXPECT_NEAR(feature(table, 1, 2, "plan_small"), 0, 0.02);
    EXPECT_NEAR(feature(table, 1, 2, "height_overlap_small"), 1, 1e-3);
    EXPECT_NEAR(feature(table, 1, 2, "touch_z"), 0, 1e-3);
    EXPECT_NEAR(feature(table, 1, 2, "feet"), 0, 1e-3);
    EXPECT_EQ(feature(table, 1, 2, "seam_pairs"), 0) << "no neighbours on the surface";
}

// What no solid is left of is no object's part.
TEST_P(JointFeatures, LeaveOutWhatHasNoVoxels) {
    BoxAndTable scene(0.02);
    scene.solids.solids[2].inside = [](double, double, double) { return false; };
    const JointTable table = scene.table(*device);
    EXPECT_EQ(table.pairs, (std::vector<std::pair<std::int32_t, std::int32_t>>{{0, 1}}));
}

// What touches as solids, but was not seen to come near, has no border: NaN, which trees know.
TEST_P(JointFeatures, OfAnUnseenBorderAreNotKnown) {
    BoxAndTable scene(0.02);
    for (std::size_t n = 0; n < scene.faces.samples.size(); ++n)
        if (scene.faces.samples.primitive[n] == 2) scene.faces.samples.z[n] += 0.1f;
    const JointTable table = scene.table(*device);
    EXPECT_TRUE(std::isnan(feature(table, 1, 2, "gap_least")));
    EXPECT_TRUE(std::isnan(feature(table, 1, 2, "convexity")));
    EXPECT_NEAR(feature(table, 1, 2, "small_on_big"), 1, 1e-3);
}

// The same two boxes, scanned finely and coarsely.
TEST_P(JointFeatures, HardlyDependOnTheDensityOfTheScan) {
    for (const Vec3& low : {Vec3{0, 0, 0.4}, Vec3{0.42, 0, 0}}) {
        const JointTable fine = BoxAndTable(0.02, low).table(*device);
        const JointTable coarse = BoxAndTable(0.04, low).table(*device);
        ASSERT_EQ(fine.pairs, coarse.pairs);
        const auto same = [&](std::string_view name, double error) {
            EXPECT_NEAR(feature(fine, 1, 2, name), feature(coarse, 1, 2, name), error) << name;
        };
        for (const char* name : {"area_small", "area_big", "area_ratio"}) same(name, 0.02);
        for (const char* name : {"thickness_small", "thickness_big", "width_small", "width_big",
                                 "length_small", "length_big", "apart", "low_small", "high_small",
                                 "low_big", "high_big", "tops", "feet", "above_big", "length"})
            same(name, 0.025);
        same("convexity", 0.3);  // from -2 to 2; at 4 cm what is near reaches 3 cm farther
        for (const char* name :
             {"concave_share", "convex_share", "border_parallel", "rise", "plan_small", "plan_big",
              "height_overlap_small", "slender_small", "place_in_small", "place_in_big"})
            same(name, 0.2);
        for (const char* name : {"stands_small", "stands_big", "stands_both", "touch_share_small",
                                 "touch_z", "small_on_big", "volume_small"})
            same(name, 1e-6);
    }
}

TEST(Joints, EachHasTheBias) {
    const std::vector<Joint> joints{{0, 1, 2.5}, {0, 2, -1}, {3, 4, 0}};
    const std::vector<Joint> out = biased_joints(joints, -1.5);
    ASSERT_EQ(out.size(), joints.size());
    for (std::size_t n = 0; n < out.size(); ++n) {
        EXPECT_EQ(out[n].a, joints[n].a);
        EXPECT_EQ(out[n].b, joints[n].b);
        EXPECT_EQ(out[n].log_odds, joints[n].log_odds - 1.5);
    }
}

TEST(Joints, AreDoubtedWhereNoiseBreaksSurfacesIntoFragments) {
    const auto doubt = [](std::size_t count, std::size_t samples) {
        return doubt_of_fragments(std::vector(count, samples));
    };
    EXPECT_EQ(doubt(0, 0), 0);
    EXPECT_EQ(doubt(500, 30), 0);
    EXPECT_EQ(doubt(500, 2000), 0);
    EXPECT_NEAR(doubt(990, 6), 0.99 * (3.4 - std::log(6)), 1e-9);
    EXPECT_NEAR(doubt(990, 0), 0.99 * 3.4, 1e-9);
    EXPECT_NEAR(doubt(10, 6), 0.5 * (3.4 - std::log(6)), 1e-9);  // a few small things
    EXPECT_GT(doubt(500, 5), doubt(500, 6));
}

using test::box;
using testing::ElementsAre;

TEST(KnownLinks, MakeOneNodeOfWhatIsOne) {
    const LinkedNodes nodes(5, {{{1, 3}, {3, 4}}, {{0, 4}, {2, 0}}});
    EXPECT_EQ(nodes.size(), 3);
    EXPECT_THAT(nodes.members(1), ElementsAre(1, 3, 4));
    EXPECT_THAT(nodes.apart(), ElementsAre(ElementsAre(1, 2), ElementsAre(0), ElementsAre(0)));
    EXPECT_THAT(nodes.sums(std::vector<double>{1, 2, 4, 8, 16}), ElementsAre(1, 26, 4));
    EXPECT_THAT(nodes.pinned({false, false, false, true, false}), ElementsAre(false, true, false));
    EXPECT_THAT(nodes.of_primitives(std::vector<std::int32_t>{7, -1, 9}),
                ElementsAre(7, -1, 9, -1, -1));
    const auto joints = nodes.joints(std::vector<Joint>{{0, 1, 1}, {1, 3, 2}, {2, 4, 3}});
    ASSERT_EQ(joints.size(), 2u);
    EXPECT_EQ(joints[1].a, 1);
    EXPECT_EQ(joints[1].b, 2);
    EXPECT_EQ(nodes.one_object(1, 4), true);
    EXPECT_EQ(nodes.one_object(0, 3), false);
    EXPECT_EQ(nodes.one_object(1, 2), std::nullopt);
}

// Groups {1, 2}, {3, 4}, {5}, and of the ground 0, pinned, 6, which likely is one with 7, and 8.
TEST(KnownLinks, KeepWhatTheyDoNotSpeakOf) {
    const std::vector<std::int32_t> group{-1, 0, 0, 1, 1, 2, -1, -1, -1};
    const std::vector<Joint> joints{{0, 6, 3}, {0, 7, 3}, {2, 4, -1},
                                    {4, 5, 1}, {6, 7, 1}, {6, 8, -1}};
    std::vector<bool> pinned(9);
    pinned[0] = true;
    const KnownLinks cut{{}, {{3, 4}}};
    const auto open = KeptGrouping(cut, group, joints, pinned).of_open(joints);
    EXPECT_TRUE(open.empty());  // neither joins 2 or 5
    const auto nodes = [&](const KnownLinks& links) {
        return LinkedNodes(9, KeptGrouping(links, group, joints, pinned).links());
    };
    const LinkedNodes parted = nodes(cut);
    EXPECT_THAT(parted.members(parted.node_of(0)), ElementsAre(0, 6, 7, 8));
    EXPECT_EQ(parted.one_object(1, 2), true);
    EXPECT_EQ(parted.one_object(3, 4), false);
    EXPECT_EQ(parted.one_object(5, 8), false);
    const LinkedNodes taken = nodes({{}, {{6, 0}}});
    EXPECT_THAT(taken.members(taken.node_of(0)), ElementsAre(0, 8));
    EXPECT_EQ(taken.one_object(6, 7), std::nullopt);
    EXPECT_EQ(taken.one_object(3, 4), true);
    const LinkedNodes joined = nodes({{{2, 5}}, {}});
    EXPECT_THAT(joined.members(joined.node_of(2)), ElementsAre(2, 5));
    EXPECT_EQ(joined.one_object(1, 2), std::nullopt);
}

TEST(KnownLinks, LeaveNoGapsInNumbers) {
    const auto closed = [](std::vector<std::int32_t> group) {
        Table<PrimitiveId, std::int32_t> out(group.begin(), group.end());
        close_gaps(out);
        return std::vector<std::int32_t>(out.begin(), out.end());
    };
    EXPECT_THAT(closed({-1, 0, 3, 1, 3, 5}), ElementsAre(-1, 0, 3, 1, 3, 2));
    EXPECT_THAT(closed({4, 2, -1, 4}), ElementsAre(0, 1, -1, 0));
    EXPECT_THAT(closed({-1, -1}), ElementsAre(-1, -1));
    EXPECT_THAT(closed({}), ElementsAre());
}

// However likely they are to be one.
TEST(GreedyContractionApart, HoldsThroughOthers) {
    const std::vector<Joint> joints{{0, 1, 5}, {1, 2, 4}, {0, 2, 6}, {2, 3, 1}};
    const std::vector<bool> free(4);
    const std::vector<double> none(4, 0.0);
    using Apart = std::vector<std::vector<std::int32_t>>;
    EXPECT_THAT(contract_greedily(4, joints, free, none, Apart{{2}, {}, {0}, {}}),
                ElementsAre(0, 0, 2, 2));
    // 0 and 2 are one by then: what is to be apart of either stays so.
    EXPECT_THAT(contract_greedily(4, joints, free, none, Apart{{3}, {}, {}, {0}}),
                ElementsAre(0, 0, 0, 3));
    EXPECT_THAT(contract_greedily(4, joints, {true, false, false, false},
                                  std::vector<double>{0, 9, 9, 9}, Apart{{1}, {0}, {}, {}}),
                ElementsAre(0, 1, 0, 0));
}

// Random graphs, all ways of starting: no state that the sampler is in breaks what is known.
TEST(SwendsenWangApart, HoldsInEveryState) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        constexpr std::int32_t count = 12;
        std::vector<Edge> edges;
        for (std::int32_t a = 0; a < count; ++a)
            for (std::int32_t b = a + 1; b < count; ++b)
                if (random.uniform() < 0.4) edges.push_back({a, b, random.uniform(0.1, 0.9)});
        std::vector<bool> pinned(count);
        pinned[0] = pinned[5] = true;
        std::vector<std::vector<std::int32_t>> apart(count);
        for (const auto& [a, b] : {std::pair{1, 2}, {3, 5}, {2, 7}}) {
            apart[a].push_back(b);
            apart[b].push_back(a);
        }
        // All would be one.
        const GroupEnergies energies{[](std::span<const GroupQuery> groups, std::span<double> out) {
                                         for (std::size_t n = 0; n < groups.size(); ++n)
                                             out[n] = -std::pow(double(groups[n].nodes.size()), 2);
                                     },
                                     {}};
        const CutProblem problem(count, edges, pinned, apart);
        EnergyCache cache(energies);
        std::set<std::vector<std::int32_t>> states;
        int step = 0;
        test::walk(problem, cache, Random(seed), 2000, 1.0, [&](const CutChain& chain) {
            states.insert(chain.labels());
            for (std::size_t n = 0; n < apart.size(); ++n)
                for (const std::int32_t other : apart[n])
                    ASSERT_NE(chain.labels()[n], chain.labels()[other])
                        << "seed " << seed << ", step " << step;
            ++step;
        });
        EXPECT_GT(states.size(), 5u) << "seed " << seed;
    }
}

class KnownObjects : public test::EachBackend {};
TOPPLE_ON_EACH_BACKEND(KnownObjects);

// Two blocks side by side that look like one, and a third across the room.
TEST_P(KnownObjects, AreWhatIsKnownOfThem) {
    test::FloorScene scene;
    scene.add(box({-0.6, 0, 0}, {-0.3, 0.3, 0.3}));
    scene.add(box({-0.3, 0, 0}, {0, 0.3, 0.3}));
    scene.add(box({0.5, 0, 0}, {0.8, 0.3, 0.3}));
    const ContactGraph contacts = scene.contacts(*device);
    const auto bodies = scene.bodies(*device);
    const ShellOdds shell{{6, -6, -6, -6}, {true, false, false, false}};
    const std::vector<Joint> joints{{0, 1, -4}, {0, 2, -4}, {0, 3, -4}, {1, 2, 4}};
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        GroupingOptions options;
        options.seed = seed;
        const auto grouped = [&](const KnownLinks& links) {
            options.links = links;
            return group_primitives(*device, contacts, bodies, joints, shell, options).group;
        };
        EXPECT_THAT(grouped({}), ElementsAre(-1, 0, 0, 1));
        EXPECT_THAT(grouped({{}, {{2, 1}}}), ElementsAre(-1, 0, 1, 2));
        EXPECT_THAT(grouped({{{1, 3}}, {}}), ElementsAre(-1, 0, 0, 0));
        EXPECT_THAT(grouped({{{1, 3}}, {{2, 3}}}), ElementsAre(-1, 0, 1, 0));
        EXPECT_THAT(grouped({{{0, 3}}, {}}), ElementsAre(-1, 0, 0, -1));
        // Others keep their numbers.
        options.before = {-1, 0, 0, 1};
        EXPECT_THAT(grouped({{}, {{2, 1}}}), ElementsAre(-1, 0, 2, 1));
        EXPECT_THAT(grouped({{{1, 3}}, {}}), ElementsAre(-1, 0, 0, 0));
        EXPECT_THAT(grouped({{{0, 1}}, {}}), ElementsAre(-1, -1, 0, 1));
        options.before = {-1, -1, -1, 0};
        EXPECT_THAT(grouped({{}, {{0, 1}}}), ElementsAre(-1, 1, 1, 0));
    }
    const auto certain = pair_probabilities(contacts, joints, shell, {{}, {{1, 2}}});
    const auto judged = pair_probabilities(contacts, joints, shell);
    for (std::size_t n = 0; n < contacts.pairs.size(); ++n) {
        const bool known = contacts.pairs[n].a == 1 && contacts.pairs[n].b == 2;
        EXPECT_EQ(certain[n], known ? 0 : judged[n]);
        EXPECT_TRUE(!known || judged[n] > 0.9);
    }
}

}  // namespace
}  // namespace topple::graph
