// SPDX-License-Identifier: MIT
#include "graph/known_links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/random.h"
#include "graph/cut_chain.h"
#include "graph/greedy_contraction.h"
#include "graph/stable_objects.h"
#include "host/graph/floor_scene.h"
#include "kernels/device_harness.h"

namespace topple::graph {
namespace {

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
        CutChain chain(problem, cache, Random(seed));
        std::set<std::vector<std::int32_t>> states;
        for (int step = 0; step < 2000; ++step) {
            chain.step(1.0);
            states.insert(chain.labels());
            for (std::size_t n = 0; n < apart.size(); ++n)
                for (const std::int32_t other : apart[n])
                    ASSERT_NE(chain.labels()[n], chain.labels()[other])
                        << "seed " << seed << ", step " << step;
        }
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
            return group_primitives(contacts, bodies, joints, shell, options, 1).group;
        };
        EXPECT_THAT(grouped({}), ElementsAre(-1, 0, 0, 1));
        EXPECT_THAT(grouped({{}, {{2, 1}}}), ElementsAre(-1, 0, 1, 2));
        EXPECT_THAT(grouped({{{1, 3}}, {}}), ElementsAre(-1, 0, 0, 0));
        EXPECT_THAT(grouped({{{1, 3}}, {{2, 3}}}), ElementsAre(-1, 0, 1, 0));
        EXPECT_THAT(grouped({{{0, 3}}, {}}), ElementsAre(-1, 0, 0, -1));
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
