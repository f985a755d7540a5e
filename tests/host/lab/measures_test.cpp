// SPDX-License-Identifier: MIT
#include "lab/evaluation/measures.h"

#include "lab/evaluation/bases.h"
#include "lab/evaluation/tables.h"
#include "testing.h"

namespace topple::evaluation {
namespace {

scenes::MeasuredShape shape(const std::string& name) {
    for (scenes::MeasuredShape& s : scenes::measured_shapes())
        if (s.name == name) return s;
    throw std::out_of_range(name);
}

TrueMeasures truth_of(const std::string& name, std::uint64_t seed) {
    return true_measures(scenes::measured_world(shape(name), seed), scenes::measured_object, 700);
}

// A body tips over the nearest edge of its base: m g (sqrt(d^2 + z^2) - z).
double over_edge(double mass_kg, double d, double z) {
    return mass_kg * 9.80665 * (std::hypot(d, z) - z);
}

TEST(Measures, TruthsAreThoseOfClosedForms) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const TrueMeasures box = truth_of("box 20 x 30 x 50", seed);
        EXPECT_NEAR(box.mass_kg, 21, 1e-9);
        EXPECT_NEAR(box.barrier_J, over_edge(21, 0.1, 0.25), 1e-9);
        const double can_kg = 700 * M_PI / 4 * 0.065 * 0.065 * 0.17;
        const TrueMeasures can = truth_of("can 6.5 x 17", seed);
        EXPECT_NEAR(can.mass_kg, can_kg, 1e-9);
        EXPECT_NEAR(can.barrier_J, over_edge(can_kg, 0.0325, 0.085), 1e-4 * can.barrier_J);
        const TrueMeasures cone = truth_of("cone 24 x 40", seed);
        EXPECT_NEAR(cone.barrier_J, over_edge(cone.mass_kg, 0.12, 0.1), 1e-4 * cone.barrier_J);
        // A board of 0.96 x 0.04 m^3 on four legs.
        const TrueMeasures table = truth_of("table 120 x 80 x 72", seed);
        const double board = 1.2 * 0.8 * 0.04, legs = 4 * 0.06 * 0.06 * 0.68;
        EXPECT_NEAR(table.mass_kg, 700 * (board + legs), 1e-9);
        EXPECT_NEAR(table.center_of_mass_m[2], (board * 0.7 + legs * 0.34) / (board + legs), 1e-9);
        EXPECT_NEAR(table.barrier_J, over_edge(table.mass_kg, 0.4, table.center_of_mass_m[2]),
                    1e-9);
    }
}

TEST(Measures, ShapesAreManyAndOnTheirFeet) {
    const auto shapes = scenes::measured_shapes();
    EXPECT_GE(shapes.size(), 30u);
    std::set<std::string> names;
    for (const scenes::MeasuredShape& s : shapes) {
        SCOPED_TRACE(s.name);
        names.insert(s.name);
        double lowest = 1;
        for (const scenes::Part& part : s.parts) lowest = std::min(lowest, part.bottom());
        EXPECT_NEAR(lowest, 0, 1e-12);
        // Parts touch or are apart; none reaches into another.
        for (std::size_t a = 0; a < s.parts.size(); ++a)
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_GT(scenes::gap(s.parts[a], s.parts[b]), -2e-4) << a << ' ' << b;
        const TrueMeasures truth =
            true_measures(scenes::measured_world(s, 1), scenes::measured_object, 700);
        EXPECT_GT(truth.barrier_J, 0);
    }
    EXPECT_EQ(names.size(), shapes.size());
}

TEST(Measures, PointsLieOnWhatIsInView) {
    const scenes::World world = scenes::measured_world(shape("tin 8 x 11"), 3);
    const PointCloud cloud = scenes::clean_points(world, 0.01);
    ASSERT_EQ(cloud.nx.size(), cloud.size());
    std::size_t on_tin = 0;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        const Vec3 p{cloud.x[n], cloud.y[n], cloud.z[n]};
        const auto [off, part] = world.distance(p);
        ASSERT_NEAR(off, 0, 1e-6);
        const scenes::Part& on = world.parts[part];
        if (on.object != scenes::measured_object) continue;
        ++on_tin;
        EXPECT_GT(p[2], on.bottom() + 1e-4);  // it stands on its underside
    }
    // Side and lid, a point per square centimetre or more.
    EXPECT_GT(on_tin, 1e4 * M_PI * (0.08 * 0.11 + 0.04 * 0.04));
}

TEST(Measures, OfACrateAreFound) {
    MeasureOptions options;
    options.spacing_m = 0.01;
    options.parse.device = device::open_device("native");
    options.parse.disturbances = {};
    const MeasureScore score = measure(shape("cube 40"), 1, options);
    EXPECT_GT(score.mass, 0.8);
    EXPECT_LT(score.mass, 1.6);
    EXPECT_GT(score.barrier, 0.8);
    EXPECT_LT(score.center_m, 0.05);
    EXPECT_GT(score.parse_s, 0);
}

TEST(Measures, TableCountsWhatWasFound) {
    const auto score = [](const char* name, double mass, double barrier, double sigmas) {
        MeasureScore out;
        out.name = name;
        out.mass = mass;
        out.barrier = barrier;
        out.center_m = 0.003 * mass;
        out.barrier_sigmas = sigmas;
        return out;
    };
    const double none = MeasureScore::none;
    const std::vector<MeasureScore> scores{score("a", 1.02, 1.1, 1.5), score("a", 0.98, 1.3, 0.5),
                                           score("b", none, none, none)};
    const std::string table = measures_table(scores);
    for (const char* part :
         {"a                              2/2     1.000    1.200      3.0",
          "b                              0/1       nan      nan      nan", "mean bias +0.0 %",
          "mean bias +20.0 %", "barrier  within one standard error: 50.0, within two: 100.0"})
        EXPECT_NE(table.find(part), std::string::npos) << part << '\n' << table;
    const std::string csv = measures_csv(scores);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
}

// A box on a floor; what is inside is right, what is above it is not, and the floor is not judged.
TEST(Bases, AreJudgedByTheTruth) {
    scenes::World world;
    world.room = {4, 3, 2.5};
    world.objects = {{"room", "room"}, {"box", "floor"}};
    world.parts.push_back({scenes::Shape::box, {2, 1.5, -0.05}, {4, 3, 0.1}, 0, 0, 0, "floor"});
    world.parts.push_back({scenes::Shape::box, {2, 1.5, 0.2}, {0.4, 0.4, 0.4}, 0, 0, 1, "box"});
    SolidCells cells;
    cells.voxel_m = 0.02;
    const auto add = [&](std::int32_t k, Basis basis) {
        cells.i.push_back(100);
        cells.j.push_back(75);
        cells.k.push_back(k);
        cells.primitive.push_back(0);
        cells.basis.push_back(basis);
    };
    add(-2, Basis::surface);
    for (std::int32_t k = 5; k < 10; ++k) add(k, Basis::half_enclosed);
    add(30, Basis::half_enclosed);
    add(40, Basis::gap);
    BasisCounts counts;
    add_voxels(world, SolidScene(std::move(cells), {Role::none}), {.voxel_m = 0.02}, counts);
    const auto of = [&](Basis b) { return counts.basis[static_cast<std::size_t>(b)]; };
    EXPECT_EQ(of(Basis::surface).of, 0u);
    EXPECT_EQ(of(Basis::half_enclosed).of, 6u);
    EXPECT_EQ(of(Basis::half_enclosed).right, 5u);
    EXPECT_EQ(of(Basis::gap).of, 1u);
    EXPECT_EQ(of(Basis::gap).right, 0u);
    EXPECT_NE(table_of(counts).find("0.8333"), std::string::npos);
}

std::vector<RoomScore> three_rooms() {
    std::vector<RoomScore> rooms(3);
    for (std::size_t n = 0; n < rooms.size(); ++n) {
        rooms[n].seed = n + 1;
        const double v = 0.1 * static_cast<double>(n);
        rooms[n].parts_by_primitive = {0.01 + v, 0, 0.02, 0.125 + v, 0.9 - v};
        rooms[n].completed = {{0.95 - v, 100}, {0.80 + v, 100}};
    }
    rooms[0].relations.fixed_recall = {0.5, 10};  // the other rooms have no joints
    return rooms;
}

TEST(Spread, MedianAndRange) {
    auto rooms = three_rooms();
    const auto hamming = [](const RoomScore& r) { return r.parts_by_primitive.hamming; };
    const Spread odd = spread(rooms, hamming);
    EXPECT_DOUBLE_EQ(odd.median, 0.11);
    EXPECT_DOUBLE_EQ(odd.least, 0.01);
    EXPECT_DOUBLE_EQ(odd.greatest, 0.21);
    rooms.pop_back();
    EXPECT_DOUBLE_EQ(spread(rooms, hamming).median, 0.06);
    EXPECT_TRUE(std::isnan(spread({}, hamming).median));
}

TEST(Spread, LeavesOutWhatIsNoNumber) {
    const Spread s =
        spread(three_rooms(), [](const RoomScore& r) { return r.relations.fixed_recall.value; });
    EXPECT_EQ(s.median, 0.5);
    EXPECT_EQ(s.least, 0.5);
}

// The line that starts with `name`, its words.
std::vector<std::string> row(const std::string& text, const std::string& name) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t at = line.find_first_not_of(' ');
        if (at == std::string::npos || line.compare(at, name.size(), name) != 0) continue;
        std::istringstream words(line.substr(at + name.size()));
        return {std::istream_iterator<std::string>(words), {}};
    }
    return {};
}

TEST(Tables, ShowMedianWorstAndThePaper) {
    const std::string text = tables(three_rooms());
    using Row = std::vector<std::string>;
    EXPECT_EQ(row(text, "after filling"), (Row{"85.0", "75.0", "94.1", "90.0", "80.0", "87.4"}));
    EXPECT_EQ(row(text, "surface alone"), (Row{"-", "-", "98.5", "-", "-", "7.8"}));
    EXPECT_EQ(row(text, "fixed joints"), (Row{"50.0", "50.0", "-", "-", "81.8", "66.0"}));
    // Worst is the greatest error, but the least intersection over union.
    EXPECT_EQ(row(text, "primitives"), (Row{"0.225", "0.325", "0.110", "0.210", "0.000", "0.000",
                                            "0.020", "0.020", "0.800", "0.700"}));
    EXPECT_EQ(row(text, "2").at(0), "0");  // a line for each room
    EXPECT_EQ(row(text, "3").at(2), "70.0");
}

TEST(Csv, HasALineForEachRoomAndAsManyFieldsAsNames) {
    std::istringstream lines(csv(three_rooms()));
    std::size_t names = 0, count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        const auto fields = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
        if (count == 0) names = fields;
        EXPECT_EQ(fields, names) << line;
        const std::string seed = count == 0 ? "seed," : std::to_string(count) + ",";
        EXPECT_TRUE(line.starts_with(seed)) << line;
    }
    EXPECT_EQ(count, 4u);
    EXPECT_GT(names, 30u);
}

}  // namespace
}  // namespace topple::evaluation
