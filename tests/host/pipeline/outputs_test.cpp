// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "host/pipeline/scan.h"

// The files of a whole parse, as a reader who knows only their description finds them.
namespace topple::test {
namespace {

using Json = nlohmann::json;

double length(const Json& vector) {
    EXPECT_EQ(vector.size(), 3u) << vector;
    return std::hypot(vector.at(0).get<double>(), vector.at(1).get<double>(),
                      vector.at(2).get<double>());
}

// A number, finite (what is not is written as null), and not below `lowest`.
void expect_number(const Json& in, const char* key, double lowest) {
    ASSERT_TRUE(in.contains(key)) << key << " in " << in;
    ASSERT_TRUE(in.at(key).is_number()) << key << " in " << in;
    EXPECT_GE(in.at(key).get<double>(), lowest) << key << " in " << in;
}

void check_head(const Json& scene) {
    EXPECT_EQ(scene.at("schema"), "topple.scene/1");
    for (const char* key : {"source", "topple_version", "backend", "device"})
        EXPECT_NE(scene.at(key).get<std::string>(), "") << key;
    EXPECT_EQ(scene.at("seed"), 5);
    for (const char* key : {"voxel_size_m", "density_kg_m3", "friction"})
        expect_number(scene, key, 1e-6);
    EXPECT_NEAR(length(scene.at("up")), 1, 1e-6);
    const Json& m = scene.at("manhattan_from_input");
    ASSERT_EQ(m.size(), 4u);
    for (std::size_t row = 0; row < 3; ++row) {
        ASSERT_EQ(m[row].size(), 4u);
        const Json rotation{m[row][0], m[row][1], m[row][2]};
        EXPECT_NEAR(length(rotation), 1, 1e-6) << "row " << row;
    }
    EXPECT_EQ(m[3], Json({0.0, 0.0, 0.0, 1.0}));
    EXPECT_FALSE(scene.at("timings_s").empty());
    for (const auto& [stage, seconds] : scene.at("timings_s").items())
        EXPECT_GE(seconds.get<double>(), 0) << stage;
}

void check_primitives(const Json& scene) {
    const std::size_t objects = scene.at("objects").size();
    const double voxel = scene.at("voxel_size_m");
    std::size_t id = 0;
    for (const Json& p : scene.at("primitives")) {
        ASSERT_EQ(p.at("id"), id++);
        ASSERT_LT(p.at("object").get<std::size_t>(), objects) << p;
        EXPECT_TRUE(std::set<std::string>({"plane", "quadric", "merged"}).contains(p.at("model")))
            << p;
        expect_number(p, "points", 0);
        expect_number(p, "solid_voxels", 1);
        // Its surface passes through some of its voxels, and through some beside them.
        const double cube = voxel * voxel * voxel, volume = p.at("volume_m3");
        EXPECT_GE(volume, 0) << p;
        EXPECT_LE(volume, 3 * (p.at("solid_voxels").get<double>() + 1) * cube) << p;
        const double mass = volume * scene.at("density_kg_m3").get<double>();
        // Closed furniture is boards around contents; what may be is in between, and its error says
        // by how much.
        const Json& object = scene.at("objects").at(p.at("object").get<std::size_t>());
        if (object.at("mass_model") == "solid")
            EXPECT_NEAR(p.at("mass_kg").get<double>(), mass,
                        1e-6 * mass + object.at("mass_error_kg").get<double>())
                << p;
        else
            EXPECT_LT(p.at("mass_kg").get<double>(), mass) << p;
        EXPECT_TRUE(std::isfinite(length(p.at("center_of_mass_m")))) << p;
    }
}

// What is said of an object's easiest step is what its numbers are.
// How sure its risks are, where it would fall, and what to do about it.
void check_prospects(const Json& o) {
    double worst = 0;
    bool falls = false;
    for (const auto& [name, risk] : o.at("risk_J").items()) {
        const double spread = o.at("risk_spread_J").at(name), chance = o.at("fall_chance").at(name);
        EXPECT_GE(spread, 0);
        EXPECT_GE(o.at("risk_error_J").at(name).get<double>(), spread);
        EXPECT_GE(chance, 0);
        EXPECT_LE(chance, 1 + 1e-9);
        EXPECT_EQ(chance > 0, risk.get<double>() > 0) << name << " of " << o.at("id");
        falls = falls || chance > 0;
        worst = std::max(worst, risk.get<double>());
    }
    const Json &fall = o.at("fall"), &advice = o.at("advice");
    EXPECT_EQ(fall.at("falls"), falls);
    EXPECT_TRUE(std::isfinite(length(fall.at("lands_m"))));
    for (const Json& along : fall.at("takes_along")) EXPECT_NE(along, o.at("id"));
    expect_number(fall, "hits_J", 0);
    EXPECT_EQ(fall.at("people_share").is_null(),
              o.at("grounded").get<bool>() || !o.at("risk_J").contains("human"));
    if (!fall.at("people_share").is_null()) {
        expect_number(fall, "people_share", 0);
        EXPECT_LE(fall.at("people_share").get<double>(), 1);
    }
    const Json& category = o.at("unsafety_category");
    EXPECT_EQ(category.is_null(), !o.at("seen_enough").get<bool>());
    if (!category.is_null()) {
        EXPECT_TRUE(std::set<std::string>({"none", "low", "medium", "high"}).contains(category));
    }
    if (category.is_null()) {
        EXPECT_FALSE(o.at("unsafety_certain").get<bool>());
    }
    const std::string kind = advice.at("kind");
    EXPECT_EQ(advice.at("sentence").get<std::string>().empty(), kind.empty()) << o;
    EXPECT_EQ(kind == "check" || kind == "move" || kind == "fix", worst > 0.1) << o;
    if (kind == "move") {
        EXPECT_GT(length(advice.at("move_m")), 0);
        EXPECT_LE(advice.at("risk_J").get<double>(), 0.1);
    } else {
        EXPECT_EQ(length(advice.at("move_m")), 0);
    }
}

void check_why(const Json& scene, const Json& o) {
    const Json& why = o.at("why");
    EXPECT_EQ(why.at("W_J"), o.at("barrier_J"));
    EXPECT_EQ(why.at("S_J"), o.at("release_J"));
    std::vector<Json> carriers;
    for (const Json& s : scene.at("supports"))
        if (s.at("supported") == o.at("id")) carriers.push_back(s.at("supporter"));
    EXPECT_EQ(why.at("stands_on"), Json(carriers));
    EXPECT_TRUE(why.at("edge_m").empty() || why.at("edge_m").size() == 2) << why;
    expect_number(why, "drop_m", 0);
    if (why.at("drop_m") == 0) {
        EXPECT_EQ(why.at("lands_on"), -1);
    } else {
        EXPECT_GE(why.at("S_J").get<double>(), o.at("mass_kg").get<double>() * 9.80665 *
                                                   why.at("drop_m").get<double>() * (1 - 1e-9));
    }
    EXPECT_EQ(why.at("way_m").get<double>() > 0, o.at("mode") == "slide" && why.at("W_J") > 0)
        << why;
    const std::string sentence = why.at("sentence");
    EXPECT_TRUE(sentence.ends_with(".")) << sentence;
    if (o.at("mode") == "none") return;
    // Clockwise from the second axis of the scene's frame.
    std::array<double, 2> along{};
    for (std::size_t row = 0; row < 2; ++row) {
        for (std::size_t c = 0; c < 3; ++c)
            along[row] += scene.at("manhattan_from_input").at(row).at(c).get<double>() *
                          o.at("direction").at(c).get<double>();
    }
    const double azimuth = why.at("azimuth_deg").get<double>() * std::numbers::pi / 180;
    EXPECT_NEAR(std::sin(azimuth), along[0], 1e-6) << why;
    EXPECT_NEAR(std::cos(azimuth), along[1], 1e-6) << why;
}

void check_objects(const Json& scene, const std::set<std::string>& disturbances) {
    const Json& primitives = scene.at("primitives");
    std::set<std::int32_t> members;
    std::size_t id = 0;
    for (const Json& o : scene.at("objects")) {
        ASSERT_EQ(o.at("id"), id++);
        EXPECT_FALSE(o.at("primitives").empty()) << o;
        double mass = 0;
        for (const Json& p : o.at("primitives")) {
            const Json& primitive = primitives.at(p.get<std::size_t>());
            EXPECT_EQ(primitive.at("object"), o.at("id")) << primitive;
            EXPECT_TRUE(members.insert(p.get<std::int32_t>()).second) << p << " is in two objects";
            mass += primitive.at("mass_kg").get<double>();
        }
        EXPECT_NEAR(o.at("mass_kg").get<double>(), mass, 1e-4 * mass) << o.at("id");
        EXPECT_TRUE(o.at("grounded").is_boolean());
        EXPECT_TRUE(std::isfinite(length(o.at("center_of_mass_m"))));
        expect_number(o, "barrier_J", 0);
        expect_number(o, "release_J", 0);
        // At most that of a body which rolls, its support known to two voxels: what a sparse scan
        // leaves open.
        const double error = o.at("barrier_error_J");
        const double off_kg = o.at("mass_error_kg"), barrier = o.at("barrier_J");
        EXPECT_LE(error, (mass + 1e-3) * 9.80665 * 2 * scene.at("voxel_size_m").get<double>() +
                             barrier * off_kg / mass)
            << o;
        EXPECT_EQ(error > 0, !o.at("grounded").get<bool>());
        EXPECT_TRUE(std::set<std::string>({"tip", "slide", "none"}).contains(o.at("mode")));
        const bool moves = o.at("mode") != "none";
        EXPECT_NEAR(length(o.at("direction")), moves ? 1 : 0, 1e-6) << o;
        check_why(scene, o);
        double earlier_w = -1, earlier_s = -1;
        for (const Json& step : o.at("instability")) {
            expect_number(step, "W_J", earlier_w);
            expect_number(step, "S_J", earlier_s);
            earlier_w = step.at("W_J"), earlier_s = step.at("S_J");
        }
        std::set<std::string> named;
        for (const auto& [name, risk] : o.at("risk_J").items()) {
            named.insert(name);
            EXPECT_GE(risk.get<double>(), 0) << name << " of " << o.at("id");
        }
        EXPECT_EQ(named, disturbances);
        check_prospects(o);
        // What was not seen enough has no rank.
        if (o.at("seen_enough").get<bool>()) {
            expect_number(o, "unsafety", 1);
            EXPECT_LE(o.at("unsafety").get<double>(), 10);
        } else {
            EXPECT_TRUE(o.at("unsafety").is_null()) << o;
        }
    }
    EXPECT_EQ(members.size(), primitives.size()) << "each primitive is in an object";
}

void check_relations(const Json& scene) {
    const std::size_t primitives = scene.at("primitives").size();
    const auto object = [&](const Json& p) {
        return scene.at("primitives").at(p.get<std::size_t>()).at("object");
    };
    EXPECT_FALSE(scene.at("contacts").empty());
    for (const Json& c : scene.at("contacts")) {
        ASSERT_LT(c.at("a").get<std::size_t>(), primitives) << c;
        ASSERT_LT(c.at("b").get<std::size_t>(), primitives) << c;
        EXPECT_NE(c.at("a"), c.at("b"));
        expect_number(c, "area_m2", 1e-9);
        EXPECT_NEAR(length(c.at("normal")), 1, 1e-5) << c;
        expect_number(c, "probability", 0);
        EXPECT_LE(c.at("probability").get<double>(), 1) << c;
        const std::string relation = c.at("relation");
        EXPECT_EQ(relation == "fixed", object(c.at("a")) == object(c.at("b"))) << c;
        EXPECT_TRUE(std::set<std::string>({"fixed", "support", "adjacent"}).contains(relation));
    }
    EXPECT_FALSE(scene.at("supports").empty());
    std::set<std::pair<std::size_t, std::size_t>> seen;
    for (const Json& s : scene.at("supports")) {
        const std::size_t from = s.at("supporter"), to = s.at("supported");
        ASSERT_LT(from, scene.at("objects").size()) << s;
        ASSERT_LT(to, scene.at("objects").size()) << s;
        EXPECT_NE(from, to) << s;
        EXPECT_TRUE(seen.insert({from, to}).second) << s << " twice";
        expect_number(s, "area_m2", 1e-9);
        expect_number(s, "probability", 0);
        EXPECT_LE(s.at("probability").get<double>(), 1) << s;
    }
}

// The floor: of the large primitives the one whose centre lies lowest along up.
void check_floor(const Json& scene) {
    const Json& up = scene.at("up");
    double lowest = std::numeric_limits<double>::infinity(), most = 0;
    for (const Json& p : scene.at("primitives"))
        most = std::max(most, p.at("points").get<double>());
    const Json* floor = nullptr;
    for (const Json& p : scene.at("primitives")) {
        if (p.at("points").get<double>() < most / 4) continue;
        double height = 0;
        for (std::size_t c = 0; c < 3; ++c)
            height += up[c].get<double>() * p.at("center_of_mass_m")[c].get<double>();
        if (height < lowest) lowest = height, floor = &p;
    }
    ASSERT_NE(floor, nullptr);
    const Json& object = scene.at("objects").at(floor->at("object").get<std::size_t>());
    EXPECT_TRUE(object.at("grounded").get<bool>()) << *floor;
    EXPECT_EQ(object.at("unsafety"), 1.0);
}

// A binary .ply with float, int and uchar properties, as columns.
std::map<std::string, std::vector<double>> read_columns(const std::filesystem::path& file) {
    const std::string bytes = bytes_of_file(file);
    const auto body = bytes.find("end_header\n");
    EXPECT_NE(body, std::string::npos) << file;
    std::istringstream header(bytes.substr(0, body));
    std::vector<std::pair<std::string, std::string>> properties;
    std::size_t count = 0;
    for (std::string line; std::getline(header, line);) {
        std::istringstream words(line);
        std::string word, type, name;
        words >> word >> type >> name;
        if (word == "element") count = std::stoul(name);
        if (word == "property") properties.emplace_back(type, name);
    }
    std::map<std::string, std::vector<double>> columns;
    const char* at = bytes.data() + body + 11;
    const char* const end = bytes.data() + bytes.size();
    for (std::size_t n = 0; n < count; ++n) {
        for (const auto& [type, name] : properties) {
            const std::size_t size = type == "uchar" ? 1 : 4;
            if (end - at < static_cast<std::ptrdiff_t>(size)) {
                ADD_FAILURE() << file << " ends within vertex " << n << " of " << count;
                return columns;
            }
            float real = 0;
            std::int32_t whole = 0;
            std::memcpy(type == "float" ? static_cast<void*>(&real) : &whole, at, size);
            columns[name].push_back(type == "float" ? real : whole);
            at += size;
        }
    }
    EXPECT_EQ(at, end) << "bytes after the last vertex";
    return columns;
}

// Every label is an object's, and the primitive's own.
void check_labels(const std::map<std::string, std::vector<double>>& columns, const Json& scene) {
    const auto &primitive = columns.at("primitive"), &object = columns.at("object");
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < primitive.size(); ++n) {
        if (primitive[n] < 0) {
            wrong += primitive[n] != -1 || object[n] != -1;
        } else {
            const auto p = static_cast<std::size_t>(primitive[n]);
            wrong += p >= scene.at("primitives").size() ||
                     scene.at("primitives")[p].at("object") != static_cast<int>(object[n]);
        }
    }
    EXPECT_EQ(wrong, 0u);
}

using Outputs = Files;

TEST_F(Outputs, of_depth_frames_obey_their_description) {
    const Scan scan = scan_of_room(5, 12);
    scenes::write_sequence(path("scan"), scan.world, scan.sequence);
    ParseOptions options = on(device::open_device("native"));
    options.seed = 5;
    write_outputs(parse(path("scan"), options), path("out"));
    for (const char* name :
         {"points.ply", "solid.ply", "volume.vdb", "report.html", "landscapes.json", "scene.json"})
        EXPECT_GT(std::filesystem::file_size(path("out") / name), 100u) << name;
    EXPECT_FALSE(std::filesystem::is_empty(path("scan"))) << "the input stays";

    const Json scene = Json::parse(bytes_of_file(path("out/scene.json")));
    check_head(scene);
    check_primitives(scene);
    check_objects(scene, {"human", "wind", "earthquake"});
    check_relations(scene);
    check_floor(scene);

    const auto points = read_columns(path("out/points.ply"));
    check_labels(points, scene);
    std::vector<std::size_t> count(scene.at("primitives").size());
    for (const double p : points.at("primitive")) {
        if (p >= 0) ++count[p];
    }
    for (std::size_t p = 0; p < count.size(); ++p)
        EXPECT_EQ(scene.at("primitives")[p].at("points"), count[p]) << "primitive " << p;

    const auto solid = read_columns(path("out/solid.ply"));
    check_labels(solid, scene);
    std::fill(count.begin(), count.end(), 0);
    for (std::size_t n = 0; n < solid.at("x").size(); ++n) {
        ASSERT_TRUE(solid.at("state")[n] == 0 || solid.at("state")[n] == 1) << n;
        // Fragments too small to be solids belong to no primitive.
        if (solid.at("primitive")[n] >= 0) ++count[solid.at("primitive")[n]];
    }
    for (std::size_t p = 0; p < count.size(); ++p)
        EXPECT_EQ(scene.at("primitives")[p].at("solid_voxels"), count[p]) << "primitive " << p;
}

// A cloud's finite points come back one by one, in the order of the input.
TEST_F(Outputs, of_a_bare_cloud_keep_its_points) {
    const PointCloud cloud = cloud_of_room(2);
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(cloud.size() + cloud.size() / 100) +
                      "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        for (const float c : {cloud.x[n], cloud.y[n], cloud.z[n]}) append(ply, c);
        if (n % 100 != 99) continue;
        for (const float c : {cloud.x[n], std::numeric_limits<float>::quiet_NaN(), cloud.z[n]})
            append(ply, c);
    }
    write("cloud.ply", ply);
    ParseOptions options = on(device::open_device("native"));
    options.seed = 5;
    options.disturbances = {"wind"};
    write_outputs(parse(path("cloud.ply"), options), path("out"));

    const auto points = read_columns(path("out/points.ply"));
    ASSERT_EQ(points.at("x").size(), cloud.size());
    std::size_t moved = 0;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        moved += points.at("x")[n] != cloud.x[n] || points.at("y")[n] != cloud.y[n] ||
                 points.at("z")[n] != cloud.z[n];
    }
    EXPECT_EQ(moved, 0u);
    const Json scene = Json::parse(bytes_of_file(path("out/scene.json")));
    check_head(scene);
    check_primitives(scene);
    check_objects(scene, {"wind"});
    check_relations(scene);
    check_labels(points, scene);
}

}  // namespace
}  // namespace topple::test
