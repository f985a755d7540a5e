// SPDX-License-Identifier: MIT
#include "perf/peers/script.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "topple/error.h"

namespace topple::perf {

ScriptFile::ScriptFile(const char* name)
    : path_(std::filesystem::temp_directory_path() /
            ("topple-" + std::to_string(getpid()) + "-" + name)) {}

ScriptFile::~ScriptFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

void ScriptFile::write(std::span<const char> bytes) const {
    std::ofstream file(path_, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw Error(ErrorKind::input, path_.string() + ": can't be written");
}

std::string answer_of(const char* script, std::initializer_list<const ScriptFile*> files) {
    std::string command = "python3 '" TOPPLE_PERF_DIR "/peers/";
    command.append(script).append("'");
    for (const ScriptFile* file : files)
        command.append(" '").append(file->path().string()).append("'");
    std::string answer;
    if (std::FILE* pipe = popen(command.c_str(), "r")) {
        char text[256];
        while (std::fgets(text, sizeof(text), pipe)) answer += text;
        pclose(pipe);
    }
    return answer;
}

std::vector<Told> times_of(const char* script, std::initializer_list<const ScriptFile*> files) {
    std::istringstream lines(answer_of(script, files));
    std::vector<Told> out;
    for (Told told; std::getline(lines, told.name, '|') && std::getline(lines, told.library, '|') &&
                    lines >> told.seconds >> std::ws;)
        out.push_back(told);
    return out;
}

}  // namespace topple::perf
