// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "export/named_bodies.h"
#include "io/staging_folder.h"

namespace topple::exports {

// How files of an earlier export are known: they begin with one of these.
inline constexpr std::string_view xml_mark = "<!-- topple export -->\n";
inline constexpr std::string_view text_mark = "# topple export\n";
inline constexpr std::string_view usd_mark = "#usda 1.0\n# topple export\n";

// Throws Error(input): the file is there, and another one's.
void check_ours(const std::filesystem::path& file);
// The same of the folder that an export has beside the file that is loaded.
void check_folder_ours(const std::filesystem::path& folder);
std::string name_beside(std::string_view format);

// Writes a file beside its place and then puts it there in one step. Throws Error(input): it is
// another one's, or can't be written.
void replace_file(const std::filesystem::path& file, std::string_view text);

// An export of several files: one that is loaded, such as scene.urdf, and those that it refers to,
// in a folder beside it, scene_urdf. All are written into a folder of their own, and moved when
// they are whole, the one that is loaded last: where that is, the others are, and are of the same
// export. An earlier export is replaced; files of others are not. Errors are Error(input).
class ExportFolder {
  public:
    // folder: made where it is missing. variant: another file that may be loaded, which refers to
    // `top`; "": none.
    ExportFolder(const std::filesystem::path& folder, const std::string& format,
                 const std::string& top, const std::string& variant = "");

    // The name of the folder for what is referred to.
    const std::string& beside() const { return beside_; }
    // Writes a file there.
    void add(const std::string& name, std::string_view text);
    // What the visuals of these bodies take: name.obj of each that has one, and the colours.
    // Returns whether there are any.
    bool add_visuals(std::span<const NamedBody> bodies);
    // name.obj of each part that is no simple shape.
    void add_parts(std::span<const NamedBody> bodies);

    void commit(std::string_view top_text, std::string_view variant_text = {});

  private:
    std::filesystem::path folder_;
    std::string beside_;
    std::vector<std::string> loaded_;  // the variant last: where that is, what it refers to is
    std::optional<io::StagingFolder> staging_;
};

}  // namespace topple::exports
