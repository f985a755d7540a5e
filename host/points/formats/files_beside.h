// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "io/mapped_file.h"
#include "points/formats/gltf_checks.h"
#include "topple/error.h"

namespace topple::io {

// The files that the library which reads meshes may open: the mesh's own and, where it has parts
// in others, those of file_beside(); of a mesh in memory, none.
class FilesBeside final : public Assimp::DefaultIOSystem {
  public:
    FilesBeside(std::filesystem::path file, bool has_parts)
        : file_(std::move(file)), has_parts_(has_parts) {}

    bool Exists(const char* name) const override { return resolved(name).has_value(); }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        const std::optional<FileName> found = resolved(name);
        if (!found || mode[0] != 'r') return nullptr;
        try {
            return new Stream(*found);
        } catch (const Error&) {
            return nullptr;
        }
    }

  private:
    // Of what is open, so that nothing is looked up by name once more.
    class Stream final : private MappedFile, public Assimp::MemoryIOStream {
      public:
        explicit Stream(const FileName& name)
            : MappedFile(name),
              MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text().data()), text().size()) {}
    };

    // None: not to be opened. The library puts the folder before names, or not.
    std::optional<FileName> resolved(const std::string& name) const {
        if (!has_parts_) return std::nullopt;
        if (name == file_.string()) return file_;
        const std::filesystem::path folder = file_.parent_path();
        const std::filesystem::path relative =
            folder.empty() ? std::filesystem::path(name)
                           : std::filesystem::path(name).lexically_relative(folder);
        try {
            return file_beside(file_, relative.string());
        } catch (const Error&) {
            return std::nullopt;
        }
    }

    std::filesystem::path file_;
    bool has_parts_;
};

}  // namespace topple::io
