// SPDX-License-Identifier: MIT
#include <map>
#include <regex>

#include "program.h"

// The library's messages name an option by its keyword in Python, which C and C++ have, too, and in
// brackets by the program's option: "voxel_m (--voxel)", "unit_m = 0.001 (--unit mm)".
namespace topple::test {
namespace {

const std::filesystem::path source = TOPPLE_SOURCE_DIR;

// Those that the texts in the library's sources name; nothing there names one in another way.
std::map<std::string, std::set<std::string>> named_options() {
    const std::set<std::string> programs{"cli", "lab", "mpi"};
    // Commands to type, and arguments of programs that are started.
    const std::set<std::string> commands{"write_outputs.cpp"};
    const std::regex text(R"("(?:[^"\\\n]|\\.)*")"),
        name(R"((\w+)(?: = [\w.]+)? \((--[a-z-]+)(?: \w+)?\))"),
        wrong(R"((^|[ ("])--[a-z]|Options::|\(\): |_m_s2\(\))");
    std::map<std::string, std::set<std::string>> names;
    for (const char* folder : {"host", "vdb"}) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
            const std::filesystem::path file = std::filesystem::relative(entry.path(), source);
            const std::string part = (++file.begin())->string();
            if (programs.contains(part) || commands.contains(file.filename()) ||
                (file.extension() != ".cpp" && file.extension() != ".h"))
                continue;
            const std::string code = bytes_of_file(entry.path());
            for (std::sregex_iterator at(code.begin(), code.end(), text), end; at != end; ++at) {
                const std::string said = at->str();
                for (std::sregex_iterator m(said.begin(), said.end(), name), last; m != last; ++m)
                    names[(*m)[1]].insert((*m)[2]);
                EXPECT_FALSE(std::regex_search(std::regex_replace(said, name, ""), wrong))
                    << file << ": " << said;
            }
        }
    }
    return names;
}

class OptionNames : public Program {};

TEST_F(OptionNames, AreThoseOfTheProgramAndOfPython) {
    const std::string help = topple("parse --help-all").out;
    const std::string stubs = bytes_of_file(source / "host/python/topple/__init__.pyi.in");
    const auto names = named_options();
    EXPECT_GT(names.size(), 20u);
    for (const auto& [name, options] : names) {
        SCOPED_TRACE(name);
        ASSERT_EQ(options.size(), 1u) << "by several options";
        EXPECT_TRUE(std::regex_search(help, std::regex(*options.begin() + "($|[^\\w-])")));
        EXPECT_TRUE(std::regex_search(
            stubs, std::regex("def (parse|open_device)\\([^>]*\\b" + name + ": ")));
    }
}

}  // namespace
}  // namespace topple::test
