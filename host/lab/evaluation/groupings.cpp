// SPDX-License-Identifier: MIT
#include "lab/evaluation/groupings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "graph/group_energy.h"
#include "graph/stable_objects.h"
#include "graph/supports.h"
#include "graph/undersides.h"
#include "lab/evaluation/greedy.h"
#include "lab/evaluation/tables.h"
#include "lab/evaluation/text.h"
#include "lab/temporary_folder.h"
#include "points/observation.h"
#include "result/labelled_points.h"
#include "solids/find_solids.h"

namespace topple::evaluation {
namespace {

// The true body of each primitive, by most of its points; -1 where they are nobody's.
std::vector<std::int32_t> bodies_of_primitives(const RoomParts& room) {
    const std::vector<std::int32_t> body = scenes::true_bodies(room.world);
    std::vector<std::map<std::int32_t, std::uint64_t>> votes(room.parts.bodies.size());
    for (std::size_t n = 0; n < room.part.size(); ++n) {
        if (room.points.primitive[n] < 0 || room.part[n] < 0) continue;
        ++votes[room.points.primitive[n]][body[room.part[n]]];
    }
    std::vector<std::int32_t> out;
    for (const auto& of_primitive : votes) {
        const auto most = std::ranges::max_element(of_primitive, {},
                                                   [](const auto& vote) { return vote.second; });
        out.push_back(most == of_primitive.end() ? -1 : most->first);
    }
    return out;
}

// What supports are told by, whatever the groups are: as a parse has it once it knows them.
struct Contacts {
    graph::ContactGraph graph;
    std::vector<double> pair_probability;
};
Contacts true_borders(device::Device& device, const RoomParts& room) {
    Contacts out;
    out.graph = graph::build_contact_graph(device, room.solids->cells(),
                                           static_cast<std::int32_t>(room.parts.bodies.size()),
                                           room.solids->boundary());
    out.pair_probability =
        graph::pair_probabilities(out.graph, room.parts.joints, room.parts.shell);
    return out;
}

// What a parse with these groups would say. group: of each primitive, -1 for the ground's.
scenes::RelationScore judged(const RoomParts& room, const Contacts& contacts,
                             const std::vector<std::int32_t>& group) {
    // The ground is object 0.
    std::vector<std::int32_t> object;
    Table<ObjectId, graph::Carried> carried(1, {.grounded = true});
    for (std::size_t p = 0; p < group.size(); ++p) {
        object.push_back(group[p] + 1);
        carried.resize(std::max(carried.size(), static_cast<std::size_t>(group[p] + 2)));
        carried[object.back()].mass_kg += room.parts.bodies[p].mass_kg;
    }
    Scene scene;
    scene.supports =
        graph::find_supports(contacts.graph, contacts.pair_probability, object, carried,
                             graph::undersides(room.solids->cells(), object, carried.size()));
    for (const std::int32_t p : room.points.primitive)
        scene.points.object.push_back(p < 0 ? -1 : object[p]);
    return scenes::relation_score(room.world, scene, room.part);
}

// Of a partition, label by label.
double energy_of_all(const EnergyOf& energy_of, const std::vector<std::int32_t>& label) {
    std::map<std::int32_t, graph::GroupQuery> groups;
    for (std::size_t n = 0; n < label.size(); ++n) {
        graph::GroupQuery& group = groups[label[n]];
        group.nodes.push_back(static_cast<std::int32_t>(n));
        group.pinned = label[n] < 0;
    }
    std::vector<graph::GroupQuery> queries;
    for (auto& [of, group] : groups) queries.push_back(std::move(group));
    std::vector<double> energy(queries.size());
    energy_of(queries, energy);
    return std::accumulate(energy.begin(), energy.end(), 0.0);
}

using scenes::RelationScore;

constexpr RelationScore Groupings::*ways[]{&Groupings::discriminative, &Groupings::greedy,
                                           &Groupings::sampled};

}  // namespace

RoomParts scan_parts(const RoomOptions& options) {
    scenes::World world = scenes::furnished_room(options.room);
    const scenes::TemporaryFolder folder("topple_groupings");
    scenes::write_sequence(folder.path(), world, scenes::walk(world, options.camera));
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options.parse);
    device::Device& device = *options.parse.device;
    Observation input = observe(device, folder.path(), options.parse);
    const auto [geometry, voxels] =
        find_solids(device, input, options.parse.voxel_m, options.parse, stage);
    ScenePoints points = labelled_points(input, geometry, voxels, true);
    std::vector<std::int32_t> part = scenes::true_parts(world, points);
    SolidParts solid = solid_parts(geometry, voxels);
    PartStage parts = weigh_parts(device, solid, options.parse, stage);
    return {std::move(world),        std::move(points),     std::move(part),
            std::move(solid.solids), voxels.scene->frame(), std::move(parts)};
}

void add_examples(const RoomParts& room, JointExamples& examples) {
    const std::vector<std::int32_t> body = bodies_of_primitives(room);
    const auto joints =
        features_of(room.parts.contacts, room.parts.bodies, room.parts.shell.pinned);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto a = static_cast<std::size_t>(room.parts.contacts.pairs[j].a),
                   b = static_cast<std::size_t>(room.parts.contacts.pairs[j].b);
        if (body[a] < 0 || body[b] < 0 ||
            (room.parts.shell.pinned[a] && room.parts.shell.pinned[b]))
            continue;
        examples.joints.push_back(joints[j]);
        examples.fixed.push_back(body[a] == body[b]);
    }
}

Groupings compare_groupings(device::Device& device, const RoomParts& room,
                            const JointWeights& weights) {
    const PartStage& p = room.parts;
    Groupings out;
    out.seed = room.world.seed;
    const Contacts contacts = true_borders(device, room);
    const auto joints = features_of(p.contacts, p.bodies, p.shell.pinned);
    out.discriminative =
        judged(room, contacts, join_by_probability(p.contacts, joints, weights, p.shell.pinned));

    const graph::GroupingOptions options;
    const auto biased = graph::biased_joints(p.joints, options.joint_bias);
    graph::GroupEnergy energy(device, p.contacts, p.bodies, biased, p.shell,
                              options.standing_weight);
    const EnergyOf energy_of = energy.callbacks().of;
    std::vector<graph::Edge> edges;
    for (const graph::Joint& joint : p.joints) edges.push_back({joint.a, joint.b});
    const GreedyPartition greedy =
        greedy_merges(p.contacts.primitives, edges, p.shell.pinned, energy_of);
    out.greedy = judged(room, contacts, greedy.label);
    out.greedy_energy = greedy.energy;

    const graph::Grouping sampled =
        graph::group_primitives(device, p.contacts, p.bodies, p.joints, p.shell, options);
    out.sampled = judged(room, contacts, sampled.group);
    out.sampled_energy = energy_of_all(energy_of, sampled.group);
    return out;
}

std::string table_of(const std::vector<Groupings>& rooms) {
    std::string text;
    append(text,
           "Joints and supports by three ways of grouping (6.3, Table 3), percent: means of %zu "
           "rooms\n",
           rooms.size());
    append(text, "  %-26s  %14s  %8s  %8s\n", "", "discriminative", "greedy", "SWC");
    const struct {
        const char* name;
        scenes::Share RelationScore::*measure;
    } rows[] = {{"fixed joints, recall", &RelationScore::fixed_recall},
                {"fixed joints, precision", &RelationScore::fixed_precision},
                {"supports, recall", &RelationScore::support_recall},
                {"supports, precision", &RelationScore::support_precision}};
    const auto add_row = [&](const char* name, double discriminative, double greedy, double swc) {
        append(text, "  %-26s  %14s  %8s  %8s\n", name, percent(discriminative).c_str(),
               percent(greedy).c_str(), percent(swc).c_str());
    };
    for (const auto& [name, measure] : rows) {
        const auto mean_of = [&](RelationScore Groupings::*way) {
            return mean(known(rooms, [&](const Groupings& r) { return (r.*way.*measure).value; }));
        };
        add_row(name, mean_of(ways[0]), mean_of(ways[1]), mean_of(ways[2]));
    }
    using Paper = PaperFigures;
    add_row("paper: fixed joints", Paper::discriminative_fixed_joints, Paper::greedy_fixed_joints,
            Paper::fixed_joints);
    add_row("paper: supports", Paper::discriminative_support, Paper::greedy_support,
            Paper::support);
    text.append(
        "\nEach room: fixed joints, recall / precision, then supports; energy of the partition\n"
        "  seed  discriminative                greedy                        SWC                   "
        "  "
        "      greedy     SWC\n");
    for (const Groupings& room : rooms) {
        append(text, "  %4llu", static_cast<unsigned long long>(room.seed));
        for (const auto way : ways) {
            const RelationScore& s = room.*way;
            append(text, "  %5s / %5s %5s / %5s ", percent(s.fixed_recall.value).c_str(),
                   percent(s.fixed_precision.value).c_str(),
                   percent(s.support_recall.value).c_str(),
                   percent(s.support_precision.value).c_str());
        }
        append(text, "  %8.3f %7.3f\n", room.greedy_energy, room.sampled_energy);
    }
    return text;
}

}  // namespace topple::evaluation
