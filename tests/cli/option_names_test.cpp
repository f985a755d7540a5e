// SPDX-License-Identifier: MIT
#include "topple/option_names.h"

#include <regex>

#include "program.h"

// Every option that a message can name is in the table, and every name in the table is one of its
// interface: of the headers, of the program's help, and of Python's signatures.
namespace topple::test {
namespace {

const std::filesystem::path source = TOPPLE_SOURCE_DIR;

std::string without_comments(std::string code) {
    std::size_t at = 0;
    while ((at = code.find("//")) != std::string::npos) code.erase(at, code.find('\n', at) - at);
    while ((at = code.find("/*")) != std::string::npos)
        code.erase(at, code.find("*/", at) + 2 - at);
    return code;
}

// What stands between the braces of a struct.
std::string body_of(const std::string& header, const std::string& name) {
    const std::string code =
        without_comments(bytes_of_file(source / "host/include/topple" / header));
    const std::size_t from = code.find("struct " + name + " {");
    EXPECT_NE(from, std::string::npos) << name;
    return code.substr(from, code.find("\n}", from) - from)
        .substr(("struct " + name + " {").size());
}

// The names that a struct declares, as "double a = 0, b; std::function<void(int)> c;" does a, b, c.
std::vector<std::string> members_of(std::string body) {
    for (std::string last; last != body;)
        body = std::regex_replace(last = body, std::regex(R"(<[^<>]*>|\([^()]*\)|\{[^{}]*\})"), "");
    body = std::regex_replace(body, std::regex(R"(=[^,;]*)"), "");
    std::vector<std::string> out;
    const std::regex declared(R"((\w+)\s*[,;])");
    for (std::sregex_iterator at(body.begin(), body.end(), declared), end; at != end; ++at)
        out.push_back((*at)[1]);
    return out;
}

bool has_word(const std::string& text, const std::string& word) {
    return std::regex_search(text, std::regex("(^|[^\\w-])" + word + "($|[^\\w-])"));
}

// What a name is before its value: "unit_m" of "unit_m = 0.001".
std::string option_of(const std::string& name) {
    return name.substr(0, name.find_first_of(" ="));
}

std::vector<std::string> table() {
    std::vector<std::string> out;
    for (const OptionName& name : option_names()) out.emplace_back(name.member);
    return out;
}

bool known(const std::string& member) {
    return std::ranges::any_of(table(), [&](const std::string& m) { return m == member; });
}

TEST(OptionNames, HoldAllOptions) {
    // What no message can mean: nobody gives them in words, or to change what is wrong.
    const std::set<std::string> unnamed{"ParseOptions::coordinates", "ParseOptions::work_folder",
                                        "ParseOptions::crew",        "ParseOptions::progress",
                                        "ParseOptions::cancelled",   "ParseOptions::notice",
                                        "ExportOptions::cancelled"};
    std::set<std::string> all;
    for (const auto& [header, name] :
         {std::pair("parse.h", "ParseOptions"), std::pair("motion.h", "MotionFileOptions"),
          std::pair("export.h", "ExportOptions")}) {
        const auto members = members_of(body_of(header, name));
        EXPECT_GE(members.size(), 3u) << name;
        for (const std::string& member : members) all.insert(std::string(name) + "::" + member);
    }
    for (const std::string& member : all)
        EXPECT_EQ(known(member), !unnamed.contains(member)) << member;
    for (const std::string& member : unnamed) EXPECT_TRUE(all.contains(member)) << member;
    for (const std::string& member : table()) {
        if (member.find("Options::") == std::string::npos) continue;
        EXPECT_TRUE(all.contains(option_of(member))) << member;
    }
}

class NamesOfInterfaces : public Program {};

TEST_F(NamesOfInterfaces, AreTheirOwn) {
    const std::string help = topple("parse --help-all").out;
    const std::filesystem::path include = source / "host/include/topple";
    const std::string c = without_comments(bytes_of_file(include / "topple.h"));
    const std::string fields = body_of("topple.h", "topple_options");
    const std::string stubs = bytes_of_file(source / "host/python/topple/__init__.pyi.in");
    std::string python;  // arguments
    for (const char* function : {"def parse(", "def export(", "def open_device("}) {
        const std::size_t from = stubs.find(function);
        ASSERT_NE(from, std::string::npos) << function;
        python += stubs.substr(from, stubs.find("->", from) - from);
    }
    const std::set<std::string> arguments{"backend", "threads"},
        formats{"mjcf", "urdf", "sdf", "usd"};
    for (const OptionName& name : option_names()) {
        SCOPED_TRACE(name.member);
        EXPECT_TRUE(has_word(help, option_of(name.command_line)));
        EXPECT_TRUE(has_word(python, option_of(name.python) + ":"));
        if (!name.c || formats.contains(name.c)) continue;
        EXPECT_TRUE(has_word(arguments.contains(name.c) ? c : fields, option_of(name.c)));
    }
    // A C program has all options that it can name.
    const std::set<std::string> cpp_only{"ParseOptions::motions", "ParseOptions::accelerogram"};
    for (const OptionName& name : option_names()) {
        if (!std::string(name.member).starts_with("ParseOptions::")) continue;
        EXPECT_EQ(name.c == nullptr, cpp_only.contains(name.member)) << name.member;
    }
}

// The texts in the library's sources name options as members, and none that the table lacks.
TEST(OptionNames, HoldAllThatMessagesName) {
    const std::set<std::string> programs{"cli", "lab", "mpi"};
    // Commands to type, and arguments of programs that are started.
    const std::set<std::string> commands{"write_outputs.cpp"};
    const std::regex text(R"("(?:[^"\\\n]|\\.)*")"),
        member(R"(\w+Options::\w+|open_device\(\): \w+|acceleration_unit_m_s2\(\))"),
        option(R"((^|[ ("])--[a-z])");
    std::size_t named = 0;
    for (const char* folder : {"host", "vdb"}) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
            const std::filesystem::path file = std::filesystem::relative(entry.path(), source);
            const std::string part = (++file.begin())->string();
            if (programs.contains(part) || (file.extension() != ".cpp" && file.extension() != ".h"))
                continue;
            const std::string code = bytes_of_file(entry.path());
            for (std::sregex_iterator at(code.begin(), code.end(), text), end; at != end; ++at) {
                const std::string said = at->str();
                if (file.stem() != "option_names" && !commands.contains(file.filename())) {
                    EXPECT_FALSE(std::regex_search(said, option)) << file << ": " << said;
                }
                for (std::sregex_iterator m(said.begin(), said.end(), member), last; m != last;
                     ++m) {
                    ++named;
                    EXPECT_TRUE(known(m->str())) << file << ": " << said;
                }
            }
        }
    }
    EXPECT_GT(named, 30u);
}

}  // namespace
}  // namespace topple::test
