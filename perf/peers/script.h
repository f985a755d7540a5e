// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace topple::perf {

// A file for a script to read or write, gone at the end.
class ScriptFile {
  public:
    explicit ScriptFile(const char* name);
    ~ScriptFile();
    ScriptFile(const ScriptFile&) = delete;
    ScriptFile& operator=(const ScriptFile&) = delete;
    const std::filesystem::path& path() const { return path_; }
    void write(std::span<const char> bytes) const;  // throws where it can't

  private:
    std::filesystem::path path_;
};

// What a script of this folder prints of some files, by the python3 of PATH; nothing where it can't
// be run.
std::string answer_of(const char* script, std::initializer_list<const ScriptFile*> files);

// What a library of Python's took, in a line of timing.py.
struct Told {
    std::string name;     // "normals/open3d": the stage that it stands beside, and itself
    std::string library;  // its name and version
    double seconds = 0;
};
std::vector<Told> times_of(const char* script, std::initializer_list<const ScriptFile*> files);

}  // namespace topple::perf
