// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "host/pipeline/small_room.h"

// What somebody says of a room, and what is kept from parse to parse for that.
namespace topple::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

class CorrectedParse : public Program {
  protected:
    CorrectedParse() { put("room.xyz", cloud()); }

    static const std::string& cloud() {
        static const std::string text = [] {
            const SmallRoom room = SmallRoom::scattered();
            std::string out;
            char line[64];
            for (std::size_t n = 0; n < room.cloud.size(); ++n) {
                std::snprintf(line, sizeof(line), "%.4f %.4f %.4f\n", double{room.cloud.x[n]},
                              double{room.cloud.y[n]}, double{room.cloud.z[n]});
                out += line;
            }
            return out;
        }();
        return text;
    }
    void put_corrections(const std::string& entries) {
        put("corrections.json",
            R"({"schema": "topple.corrections/1", "corrections": [)" + entries + "]}");
    }
    Finished parsed(std::vector<std::string> more) {
        std::vector<std::string> arguments{"parse",  "room.xyz",      "--backend",
                                           "native", "--disturbance", "wind"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        Finished done = run(arguments);
        EXPECT_EQ(done.code, 0) << done.err;
        return done;
    }
    Json scene(const std::string& out) const {
        Json json = Json::parse(bytes_of_file(in(out + "/scene.json")));
        json.erase("timings_s");
        return json;
    }
    void expect_same(const std::string& a, const std::string& b) const {
        EXPECT_EQ(scene(a), scene(b));
        for (const char* file :
             {"points.ply", "solid.ply", "solids.bin", "volume.vdb", "landscapes.json"})
            EXPECT_TRUE(bytes_of_file(in(a + "/" + file)) == bytes_of_file(in(b + "/" + file)))
                << file;
    }
    static constexpr const char* crate_and_box =
        R"({"do": "one_thing", "at_m": [[1.0, 1.2, 0.25], [1.2, 1.2, 0.7]]},
           {"do": "name", "at_m": [[1.0, 1.2, 0.25]], "name": "chest"},
           {"do": "fixed", "at_m": [[0.5, 0.5, 0.9]]})";
    static constexpr const char* goes_on = "going on from";
};

TEST_F(CorrectedParse, goes_on_from_where_the_first_began_to_group) {
    EXPECT_THAT(parsed({"-o", "out"}).err, Not(HasSubstr(goes_on)));
    const Json plain = scene("out");
    EXPECT_FALSE(plain.contains("corrections"));
    ASSERT_TRUE(fs::exists(in("out/parse.cache")));
    put_corrections(crate_and_box);
    const Finished corrected = parsed({"-o", "out", "--corrections", "corrections.json"});
    EXPECT_THAT(corrected.err, HasSubstr(goes_on));
    EXPECT_THAT(corrected.err, Not(HasSubstr("ingest")));
    EXPECT_THAT(corrected.out, HasSubstr("2 of 3 corrections held."));
    EXPECT_THAT(corrected.out, HasSubstr("(chest)"));
    // Of the output that it replaces.
    EXPECT_THAT(corrected.out, HasSubstr("\nWorst before (out/scene.json): nothing is at risk; "));
    EXPECT_THAT(corrected.out,
                HasSubstr("Note: Correction 3 (fixed) did not hold: found nothing within"));
    const Json now = scene("out");
    EXPECT_EQ(now.at("objects").size() + 1, plain.at("objects").size());
    ASSERT_EQ(now.at("corrections").size(), 3u);
    EXPECT_EQ(now.at("corrections")[0].at("outcome"), "held");
    EXPECT_EQ(now.at("corrections")[2].at("held"), false);
    // The same as from the beginning, and as before without them.
    EXPECT_THAT(parsed({"-o", "anew", "--corrections", "corrections.json", "--no-cache"}).err,
                Not(HasSubstr(goes_on)));
    EXPECT_FALSE(fs::exists(in("anew/parse.cache")));
    expect_same("out", "anew");
    EXPECT_THAT(parsed({"-o", "out"}).err, HasSubstr(goes_on));
    EXPECT_EQ(scene("out"), plain);
    EXPECT_EQ(everything().size(), 2u + 2 + 8 + 7);  // the cloud, the corrections, both outputs
}

TEST_F(CorrectedParse, takes_away_what_is_not_there_from_all_files) {
    put_corrections(R"({"do": "not_there", "at_m": [[1.2, 1.2, 0.7]]})");
    parsed({"-o", "out", "--corrections", "corrections.json"});
    parsed({"-o", "out", "--corrections", "corrections.json"});
    parsed({"-o", "anew", "--corrections", "corrections.json", "--no-cache"});
    expect_same("out", "anew");
    const Json there = scene("out");
    for (const Json& p : there.at("primitives")) {
        const Json& at = p.at("center_of_mass_m");
        EXPECT_FALSE(at[2] > 0.55 && at[0] > 1.2 && at[0] < 1.45 && at[1] > 1.1 && at[1] < 1.3);
    }
}

TEST_F(CorrectedParse, of_a_cloud_in_blocks) {
    put_corrections(R"({"do": "not_there", "at_m": [[1.2, 1.2, 0.7]]},
                       {"do": "name", "at_m": [[1.0, 1.2, 0.25]], "name": "chest"})");
    parsed({"-o", "plain", "--tile", "5"});
    parsed({"-o", "out", "--tile", "5", "--corrections", "corrections.json"});
    EXPECT_FALSE(fs::exists(in("out/parse.cache")));
    const Json plain = scene("plain"), now = scene("out");
    ASSERT_EQ(now.at("objects").size() + 1, plain.at("objects").size());
    EXPECT_EQ(now.at("objects")[1].at("name"), "chest");
    for (const Json& correction : now.at("corrections"))
        EXPECT_EQ(correction.at("outcome"), "held");
    const auto points = [](const Json& of) {
        std::size_t sum = 0;
        for (const Json& p : of.at("primitives")) sum += p.at("points").get<std::size_t>();
        return sum;
    };
    EXPECT_LT(points(now), points(plain));
    EXPECT_LT(fs::file_size(in("out/solid.ply")), fs::file_size(in("plain/solid.ply")));
    EXPECT_EQ(fs::file_size(in("out/points.ply")), fs::file_size(in("plain/points.ply")));
}

TEST_F(CorrectedParse, begins_anew_where_anything_else_is_given) {
    const auto anew = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"-o", "out", "--cache", "kept"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return parsed(arguments).err.find(goes_on) == std::string::npos;
    };
    EXPECT_TRUE(anew({}));
    EXPECT_FALSE(anew({"--friction", "0.5", "--seed", "3"}));
    EXPECT_FALSE(fs::exists(in("out/parse.cache")));
    EXPECT_TRUE(anew({"--voxel", "0.03"}));
    EXPECT_TRUE(anew({"--density", "500"}));
    EXPECT_TRUE(anew({}));
    std::string other = cloud();
    other[3] = other[3] == '1' ? '2' : '1';
    put("room.xyz", other);
    EXPECT_TRUE(anew({}));
    EXPECT_FALSE(anew({}));
}

TEST_F(CorrectedParse, does_without_a_cache_that_is_damaged) {
    const std::vector<std::string> coarsely{"-o", "out", "--voxel", "0.06", "--walks", "4"};
    parsed(coarsely);
    const std::string whole = bytes_of_file(in("out/parse.cache"));
    const Json plain = scene("out");
    Random random(3);
    for (int n = 0; n < 3; ++n) {
        std::string damaged = whole;
        if (n == 0)
            damaged.clear();
        else if (n == 1)
            damaged.resize(random.below(whole.size()));
        else
            damaged[random.below(whole.size())] ^= 0x10;
        put("out/parse.cache", damaged);
        const Finished done = parsed(coarsely);
        EXPECT_THAT(done.err, Not(HasSubstr(goes_on)));
        EXPECT_THAT(done.err, HasSubstr("parse.cache is damaged"));
        EXPECT_EQ(scene("out"), plain);
        EXPECT_TRUE(bytes_of_file(in("out/parse.cache")) == whole);
    }
    // Nor is one that can't be written more than a word.
    std::vector<std::string> elsewhere = coarsely;
    elsewhere.insert(elsewhere.end(), {"--cache", "no/such/folder"});
    const Finished done = parsed(elsewhere);
    EXPECT_THAT(done.err, HasSubstr("the next parse begins anew"));
}

TEST_F(CorrectedParse, fails_by_what_contradicts_itself) {
    const std::vector<std::string> arguments{
        "parse", "room.xyz", "-o", "out", "--quiet", "--corrections", "corrections.json"};
    expect_failure(1, arguments, {"corrections.json"});
    put("corrections.json", "{}");
    expect_failure(1, arguments, {"corrections.json", "schema"});
    put_corrections(R"({"do": "fixed", "at_m": [[0, 0, 0]]}, {"do": "weld", "at_m": [[0, 0, 0]]})");
    expect_failure(1, arguments, {"corrections.json", "correction 2", "\"weld\""});
    put_corrections(R"({"do": "one_thing", "at_m": [[1.0, 1.2, 0.25], [1.2, 1.2, 0.7]]},
                       {"do": "apart", "at_m": [[1.7, 1.2, 0.25]], "from_m": [[1.45, 1.2, 0.7]]})");
    expect_failure(1, arguments, {"correction 2 (apart) contradicts correction 1 (one_thing)"});
    fails(2, "parse room.xyz --cache file --no-cache", {"--no-cache"});
}

}  // namespace
}  // namespace topple::test
