// SPDX-License-Identifier: MIT
#include "cli/program.h"

// What can be told from the command line alone, without looking into the input.
namespace topple::test {
namespace {

using Usage = Program;

TEST_F(Usage, says_what_is_missing_or_unknown) {
    fails(2, "", {"subcommand", "--help"});
    fails(2, "prase x", {"unknown subcommand \"prase\"; did you mean parse?", "--help"});
    fails(2, "kaleidoscope", {"unknown subcommand", "there are parse, estimate"});
    fails(2, "parse", {"INPUT"});
    put_plane("plane.xyz");
    fails(2, "parse plane.xyz --colour", {"--colour"});
    fails(2, "parse plane.xyz more.xyz", {"more.xyz"});
    fails(2, "parse plane.xyz -o", {"--output"});
}

// What follows an unknown option is taken for an argument; the option is what is wrong.
TEST_F(Usage, names_the_unknown_option_and_the_nearest_one) {
    put_plane("plane.xyz");
    fails(2, "parse --wnd 3 plane.xyz", {"--wnd", "did you mean --wind?"});
    fails(2, "parse plane.xyz --densty=3", {"--densty;", "--density?"});
    fails(2, "--verison", {"--verison", "--version?"});
    fails(2, "parse plane.xyz --unit feet", {"--unit feet: expected m, cm, mm, in or ft"});
    fails(2, "generate room --kind office --scan glass",
          {"--scan glass: expected walk, sparse, cloud, laser or single"});
    fails(2, "parse plane.xyz --disturbance people",
          {"disturbances (--disturbance) people: expected human", "for people say human"});
    fails(2, "parse plane.xyz --motion a.bvh --motion-unit 0",
          {"--motion-unit 0: expected a number above 0"});
    fails(2, "parse plane.xyz --voxel 2cm",
          {"--voxel 2cm: expected a number without its unit: lengths are in metres, here 0.02"});
    fails(2, "parse plane.xyz --voxel cm", {"--voxel cm: expected a number (see"});
    fails(2, "parse plane.xyz --threads 100000", {"threads (--threads) 100000: at most"});
    fails(2, "parse plane.xyz --disturbance human,wind,human",
          {"disturbances (--disturbance): human is given twice"});
    // Nothing is near this one.
    const Finished far = topple("parse plane.xyz --kaleidoscope");
    EXPECT_THAT(far.err, Not(HasSubstr("did you mean")));
    EXPECT_THAT(far.err, HasSubstr("--kaleidoscope"));
}

TEST_F(Usage, says_how_to_write_what_has_a_space_in_it) {
    put_plane("plane.xyz");
    fails(2, "parse plane.xyz --disturbance human, earthquake",
          {"earthquake", "write the list without spaces: human,earthquake"});
    fails(2, "parse --disturbance human ,wind, earthquake plane.xyz",
          {"write the list without spaces: human,wind,earthquake"});
    fails(2, "parse plane.xyz --pga 0.3 g", {"write it without the space: 0.3g"});
    fails(2, "parse plane.xyz --title Room 12 --voxel 0.03",
          {"12", "put a title of several words in quotes, as in \"Room 12\""});
    const Finished other = topple("parse plane.xyz --voxel 0.03 more.xyz");
    EXPECT_THAT(other.err, Not(HasSubstr("without")));
}

// Not quiet: the name of a stage on stderr would show that the parse had begun.
TEST_F(Usage, refuses_values_before_it_parses) {
    put_plane("plane.xyz");
    const std::map<std::string, std::vector<std::string>> bad{
        {"--voxel", {"", "0", "-1", "nan", "inf", "1e-9", "50", "2cm"}},
        {"--up", {"", "0,0,0", "0,0", "0,0,1,0", "0,0,nan", "up", "0,0,1e400"}},
        {"--unit", {"", "yard", "0.001"}},
        {"--disturbance", {"", "flood", "human,flood"}},
        {"--motion", {""}},
        {"--threads", {"100000", "-1", "many"}},
        {"--backend", {"cuda"}},
        {"--wind", {"-3", "nan"}},
        {"--wind-from", {"north", "nan", "400"}},
        {"--pga", {"0", "0.3ft", "g", "0.3g/s", "30g"}},
        {"--floor-amplification", {"0", "nan"}},
        {"--tile", {"0", "0.5", "nan"}},
        {"--accelerogram-unit", {"m/s2", "ft"}},
        {"--density", {"-700"}},
        {"--friction", {"0"}},
        {"--max-memory", {"much", "-1G", "nan", "5 GB", "1e30T", "0.5"}},
        {"--seed", {"-1", "99999999999999999999"}},
    };
    for (const auto& [option, values] : bad)
        for (const std::string& value : values)
            // The value as it was given, or for numbers as it was understood.
            expect_failure(2, {"parse", "plane.xyz", option, value}, {option});
    fails(2, "parse plane.xyz --voxel -1", {"-1"});
    fails(2, "parse plane.xyz --disturbance flood", {"flood", "earthquake"});
    fails(2, "parse plane.xyz --people pets", {"people (--people) pets", "toddlers"});
    fails(2, "parse plane.xyz --disturbance human,reach", {"nobody", "toddlers"});
    fails(2, "parse plane.xyz --people adults,adults", {"adults is given twice"});
    fails(2, "parse plane.xyz --backend cuda", {"backend (--backend) cuda is unknown", "vulkan"});
    // Wrong usage counts before a backend that may be missing.
    fails(2, "parse plane.xyz --backend opencl --voxel 0", {"--voxel"});
    fails(2, "generate scan --frames 0", {"--frames"});
    fails(2, "generate scan --seed -1", {"--seed"});
    fails(2, "generate scan --building", {"scan", ".ply"});
    fails(2, "generate b.ply --building --tilt 5", {"--tilt"});
    fails(2, "generate b.ply --points 1000", {"--points", "--building"});
    fails(2, "generate b.ply --building --points 0", {"--points 0"});
    fails(2, "generate b.ply --building --spacing 9", {"--spacing 9"});
}

// One line, whatever names and values hold.
TEST_F(Usage, control_characters_are_told_as_such) {
    expect_failure(1, {"parse", "a\nb\033[31m.ply"}, {"a\\x0ab\\x1b[31m.ply"});
    put_plane("plane.xyz");
    expect_failure(2, {"parse", "plane.xyz", "--backend", "a\nb"}, {"a\\x0ab"});
    expect_failure(2, {"parse", "plane.xyz", "--voxel", "a\r1"}, {"--voxel", "a\\x0d1"});
    expect_failure(2, {"par\nse"}, {"par\\x0ase"});
}

// It is read before the scan is.
TEST_F(Usage, a_bad_accelerogram_is_refused_before_the_parse) {
    put_plane("plane.xyz");
    fails(1, "parse plane.xyz --accelerogram none.json", {"none.json"});
    put("quake.txt", "0 313\n0.02 0\n");
    fails(1, "parse plane.xyz --accelerogram quake.txt",
          {"quake.txt", "313 g", "--accelerogram-unit"});
    put("along.txt", "0 0.1\n0.02 0\n");
    put("up.txt", "0 0.1\n0.01 0\n");
    fails(1, "parse plane.xyz --accelerogram along.txt --accelerogram-up up.txt",
          {"up.txt", "0.01", "0.02", "one record"});
    fails(2, "parse plane.xyz --accelerogram-across along.txt", {"--accelerogram"});
}

TEST_F(Usage, a_bad_hazard_curve_is_refused_before_the_parse) {
    put_plane("plane.xyz");
    fails(1, "parse plane.xyz --hazard none.txt", {"none.txt"});
    put("hazard.txt", "0.2 0.01\n0.1 0.02\n");
    fails(1, "parse plane.xyz --hazard hazard.txt", {"hazard.txt", "rise"});
}

TEST_F(Usage, help_names_every_command_and_option) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"--help-all"}, {"parse", "--help-all"}}) {
        const Finished help = run(arguments);
        EXPECT_EQ(help.code, 0);
        EXPECT_EQ(help.err, "");
        for (const char* option :
             {"INPUT",  "--output",  "--backend",    "--voxel", "--up",      "--disturbance",
              "--unit", "--wind",    "--wind-from",  "--pga",   "--density", "--friction",
              "--seed", "--threads", "--max-memory", "--quiet", "native",    "opencl",
              "vulkan", "human",     "earthquake",   ".ply",    ".pcd",      ".xyz"}) {
            EXPECT_THAT(help.out, HasSubstr(option));
        }
        for (const char* internal : {"->", "{false}", "ENUM"})
            EXPECT_THAT(help.out, Not(HasSubstr(internal)));
        if (arguments.size() > 1) continue;
        for (const char* name :
             {"parse", "devices", "generate", "--version", "Exit codes", "1024^3", "130"}) {
            EXPECT_THAT(help.out, HasSubstr(name));
        }
    }
}

TEST_F(Usage, help_fits_a_screen) {
    for (const char* command : {"parse", "estimate", "generate", "evaluate", "perf"}) {
        const Finished help = run({command, "--help"});
        EXPECT_EQ(help.code, 0);
        EXPECT_LE(std::ranges::count(help.out, '\n'), 50) << help.out;
        EXPECT_THAT(help.out, HasSubstr("--help-all"));
    }
    const Finished all = topple("--help");
    EXPECT_LE(std::ranges::count(all.out, '\n'), 30) << all.out;
    for (const char* word : {"parse", "generate", "devices", "--help-all", "--version", "130"})
        EXPECT_THAT(all.out, HasSubstr(word));
}

TEST_F(Usage, version) {
    const Finished finished = succeeds("--version");
    EXPECT_EQ(finished.err, "");
    EXPECT_TRUE(finished.out.starts_with("topple ")) << finished.out;
    EXPECT_EQ(std::count(finished.out.begin(), finished.out.end(), '.'), 2) << finished.out;
}

// Every backend has a line, usable or not.
TEST_F(Usage, devices_of_all_three_backends) {
    const Finished finished = succeeds("devices");
    for (const std::string backend : {"native", "opencl", "vulkan"})
        EXPECT_THAT("\n" + finished.out, HasSubstr("\n" + backend + " "));
    EXPECT_THAT(finished.out, HasSubstr("driver"));
    EXPECT_TRUE(everything().empty());
}

}  // namespace
}  // namespace topple::test
