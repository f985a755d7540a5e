// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <string>

#include "io/gltf_checks.h"
#include "topple/error.h"

namespace topple::io {

// The files that the library which reads meshes may open: the mesh's own and, where it has parts
// in others, those of file_beside(); of a mesh in memory, none.
class FilesBeside final : public Assimp::DefaultIOSystem {
  public:
    FilesBeside(std::filesystem::path file, bool has_parts)
        : file_(std::move(file)), has_parts_(has_parts) {}

    bool Exists(const char* name) const override { return !resolved(name).empty(); }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        const std::string path = resolved(name);
        return path.empty() || mode[0] != 'r' ? nullptr : DefaultIOSystem::Open(path.c_str(), mode);
    }

  private:
    // Empty: not to be opened. The library puts the folder before names, or not.
    std::string resolved(const std::string& name) const {
        if (!has_parts_) return {};
        if (name == file_.string()) return name;
        const std::filesystem::path folder = file_.parent_path();
        const std::filesystem::path relative =
            folder.empty() ? std::filesystem::path(name)
                           : std::filesystem::path(name).lexically_relative(folder);
        try {
            return file_beside(file_, relative.string()).string();
        } catch (const Error&) {
            return {};
        }
    }

    std::filesystem::path file_;
    bool has_parts_;
};

}  // namespace topple::io
