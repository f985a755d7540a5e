// SPDX-License-Identifier: MIT
#include "export/export_folder.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

#include "export/colour_texture.h"
#include "export/write_obj.h"
#include "io/file_writer.h"
#include "io/replace_file.h"
#include "io/text.h"

namespace topple::exports {
namespace fs = std::filesystem;
namespace {

bool begins_as_ours(const fs::path& file) {
    std::array<char, 64> start{};
    std::ifstream stream(file, std::ios::binary);
    stream.read(start.data(), start.size());
    const std::string_view text(start.data(), static_cast<std::size_t>(stream.gcount()));
    return text.starts_with(xml_mark) || text.starts_with(text_mark) || text.starts_with(usd_mark);
}

// Throws unless a folder is missing, or holds nothing but what an export puts there.
void check_folder_ours(const fs::path& folder) {
    std::error_code error;
    const auto status = fs::symlink_status(folder, error);
    if (status.type() == fs::file_type::not_found) return;
    if (status.type() != fs::file_type::directory)
        io::fail(folder, "exists and is no export of topple; choose another folder");
    fs::directory_iterator entries(folder, error);
    if (error) io::fail(folder, "can't be listed: " + error.message());
    for (; entries != fs::directory_iterator(); entries.increment(error)) {
        if (error) break;
        const fs::path file = entries->path();
        const bool regular = fs::symlink_status(file, error).type() == fs::file_type::regular;
        if (!regular || (file.filename() != colour_file && !begins_as_ours(file)))
            io::fail(file, "is no export of topple's; move it away or choose another folder");
    }
    if (error) io::fail(folder, "can't be listed: " + error.message());
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) io::fail(folder, "can't be made: " + error.message());
}

void put(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) io::fail(to, "can't be written: " + error.message());
}

}  // namespace

void check_ours(const fs::path& file) {
    std::error_code error;
    const auto status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) return;
    if (status.type() != fs::file_type::regular || !begins_as_ours(file))
        io::fail(file, "exists and is no export of topple; choose another folder");
}

void replace_file(const fs::path& file, std::string_view text) {
    check_ours(file);
    if (file.has_parent_path()) make_folder(file.parent_path());
    io::replace_file(file, text);
}

ExportFolder::ExportFolder(const fs::path& folder, const std::string& format,
                           const std::string& top)
    : folder_(folder), top_(top) {
    beside_ = "scene_";
    beside_ += format;
    std::string name = ".";
    name += beside_;
    name += ".topple-tmp";
    check_ours(folder_ / top_);
    check_folder_ours(folder_ / beside_);
    make_folder(folder_);
    // What an export left that was interrupted.
    std::error_code error;
    fs::remove_all(folder_ / name, error);
    make_folder(folder_ / name / beside_);
    temporary_ = folder_ / name;
}

ExportFolder::~ExportFolder() {
    std::error_code ignored;
    fs::remove_all(temporary_, ignored);
}

void ExportFolder::add(const std::string& name, std::string_view text) {
    io::write_file(temporary_ / beside_ / name, text);
}

bool ExportFolder::add_visuals(std::span<const NamedBody> bodies) {
    bool any = false;
    for (const NamedBody& named : bodies) {
        if (named.body->visual.triangle.empty()) continue;
        add(named.name + ".obj", visual_obj(named.body->visual));
        any = true;
    }
    if (!any) return false;
    add(material_file, material());
    add(colour_file, colour_texture());
    return true;
}

void ExportFolder::add_parts(std::span<const NamedBody> bodies) {
    for (const NamedBody& named : bodies)
        for (const NamedPart& each : named.parts)
            if (is_mesh(each.shape))
                add(each.name + ".obj", part_obj(*each.part, named.body->center_m));
}

void ExportFolder::commit(std::string_view top_text) {
    io::write_file(temporary_ / top_, top_text);
    std::error_code error;
    // The earlier one goes as a whole, before anything of it changes.
    fs::remove(folder_ / top_, error);
    if (error) io::fail(folder_ / top_, "can't be replaced: " + error.message());
    fs::remove_all(folder_ / beside_, error);
    if (error) io::fail(folder_ / beside_, "can't be replaced: " + error.message());
    const fs::path files = temporary_ / beside_;
    if (!fs::is_empty(files, error)) put(files, folder_ / beside_);
    put(temporary_ / top_, folder_ / top_);
}

}  // namespace topple::exports
