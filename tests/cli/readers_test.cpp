// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "cli/program.h"
#include "host/io/mesh_files.h"

// What the program leaves to processes of its own: foreign formats and drivers.
namespace topple::test {
namespace {

class Readers : public Program {
  protected:
    ~Readers() override {
        unsetenv("OCL_ICD_VENDORS");
        unsetenv("TOPPLE_READERS");
    }
};

TEST_F(Readers, a_driver_that_ends_whoever_loads_it_is_not_usable) {
    put("drivers/aborting.icd", TOPPLE_ABORTING_DRIVER "\n");
    setenv("OCL_ICD_VENDORS", in("drivers").c_str(), 1);
    const Finished listed = run({"devices"});
    EXPECT_EQ(listed.code, 0) << listed.err;
    EXPECT_THAT(listed.out, HasSubstr("native"));
    EXPECT_THAT(listed.out, HasSubstr("not usable: its driver crashed (Aborted)"));
    put("box.obj", box_obj());
    expect_failure(3, {"estimate", "box.obj", "--backend", "opencl"}, {"crashed (Aborted)"});
    EXPECT_EQ(run({"estimate", "box.obj", "--backend", "auto", "--quiet"}).code, 0);
}

TEST_F(Readers, that_of_points_does_not_load_openvdb) {
    const auto beside = std::filesystem::path(TOPPLE_PROGRAM).parent_path();
    const auto loads = [&](const char* reader) {
        return bytes_of_file(beside / reader).find("libopenvdb.so") != std::string::npos;
    };
    EXPECT_TRUE(loads("topple-volume-reader"));
    EXPECT_FALSE(loads("topple-reader"));
}

TEST_F(Readers, without_them_it_says_what_to_do) {
    put("box.obj", box_obj());
    put("empty/x", "x");
    setenv("TOPPLE_READERS", in("empty").c_str(), 1);
    expect_failure(2, {"estimate", "box.obj", "--backend", "native", "--quiet"},
                   {"TOPPLE_READERS", "topple-reader"});
    EXPECT_EQ(run({"estimate", "box.obj", "--backend", "native", "--quiet", "--no-isolate"}).code,
              0);
}

TEST_F(Readers, hostile_meshes_are_refused_in_a_line) {
    const std::string head = R"({"asset": {"version": "2.0"}, "nodes": [)";
    const struct {
        std::string nodes, message;
    } cases[] = {
        {R"({"children": [1, 1]}, {})", "twice"},
        {R"({"children": [1]}, {"children": [0]})", "cycle"},
        {R"({"children": [0]})", "cycle"},
        {R"({"children": [5]})", "no node"},
    };
    for (const auto& c : cases) {
        put("a.gltf", head + c.nodes + "]}");
        for (const char* command : {"estimate", "parse"})
            expect_failure(1, {command, "a.gltf", "--backend", "native", "--quiet"},
                           {"a.gltf", c.message});
    }
    for (const char* uri : {"../a.bin", "/etc/hostname", "%2e%2e/a.bin", "file:///etc/hostname"}) {
        put("a.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": ")" +
                          std::string(uri) + "\"}]}");
        expect_failure(1, {"parse", "a.gltf", "--quiet"}, {"a.gltf", "folder"});
    }
}

}  // namespace
}  // namespace topple::test
