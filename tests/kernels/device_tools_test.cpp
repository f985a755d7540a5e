// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

// tools/build_kernels.py refuses broken kernels, and names the file and the line in it.
namespace topple::test {
namespace {

// What the tool says of a kernel with the statement on its line 6; empty where it takes it.
std::string verdict(const std::string& statement) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("topple_kernel_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "sample.kernel") << "// A sample.\n"
                                               "KERNEL(sample, 64)\n"
                                               "    BUFFER_OUT(0, float, o)\n"
                                               "    PARAMS(TriadParams, p)\n"
                                               "BEGIN\n"
                                            << statement << "\nEND\n";
    const std::string command = std::string("python3 '") + TOPPLE_SOURCE_DIR +
                                "/kernels/tools/build_kernels.py' '" +
                                (folder / "sample.kernel").string() + "' '" + folder.string() +
                                "' --glslang glslangValidator 2>&1";
    std::string said;
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return "popen failed";
    std::array<char, 512> piece{};
    while (std::fgets(piece.data(), piece.size(), pipe)) said += piece.data();
    const int status = pclose(pipe);
    std::filesystem::remove_all(folder);
    EXPECT_EQ(status == 0, said.empty()) << said;
    return said;
}

TEST(DeviceTools, TakesWhatTheDialectHas) {
    EXPECT_EQ(verdict("o[GLOBAL_ID] = 1.5f * sqrt(2.0f) + 1.0e-3f; // 0.5 and exp(1) in words"),
              "");
}

TEST(DeviceTools, RefusesByFileAndLine) {
    const std::array<std::array<std::string, 2>, 7> cases{{
        {"o[0] = 0.5;", "kernels/sample.kernel:6: 0.5 is a double"},
        {"o[0] = 1e-3;", "kernels/sample.kernel:6: 1e-3 is a double"},
        {"o[0] = exp(1.0f);", "kernels/sample.kernel:6: exp( differs between backends"},
        {"o[0] = fma(o[0], o[1], o[2]);", "kernels/sample.kernel:6: fma( rounds differently"},
        {"double d = 1.0f;", "kernels/sample.kernel:6: double is not a type"},
        {"o[0] = p.scal;", "kernels/sample.kernel:6: 'scal' : no such field"},
        {"o[0] = nowhere;", "kernels/sample.kernel:6: 'nowhere' : undeclared identifier"},
    }};
    for (const auto& [statement, expected] : cases) {
        const std::string said = verdict(statement);
        EXPECT_NE(said.find(expected), std::string::npos) << statement << "\n" << said;
    }
}

}  // namespace
}  // namespace topple::test
