// SPDX-License-Identifier: MIT
#include "export/export_folder.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "export/colour_texture.h"
#include "export/write_obj.h"
#include "io/file_writer.h"
#include "io/open_file.h"
#include "io/replace_file.h"
#include "io/text.h"

namespace topple::exports {
namespace fs = std::filesystem;
namespace {

bool begins_as_ours(const fs::path& file) {
    const std::string text = io::beginning_of(file, 64);
    return text.starts_with(xml_mark) || text.starts_with(text_mark) || text.starts_with(usd_mark);
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) io::fail(folder, "can't be made: " + error.message());
}

void put(const fs::path& from, const fs::path& to) {
    if (std::rename(from.c_str(), to.c_str()) != 0)
        io::fail(to, std::string("can't be written: ") + std::strerror(errno));
}

}  // namespace

void check_folder_ours(const fs::path& folder) {
    std::error_code error;
    const auto status = fs::symlink_status(folder, error);
    if (status.type() == fs::file_type::not_found) return;
    if (status.type() != fs::file_type::directory)
        io::fail(folder, "exists and is no export of topple; choose another folder");
    for (const std::string& name : io::folder_names(folder, error)) {
        const fs::path file = folder / name;
        std::error_code unknown;
        const bool regular = fs::symlink_status(file, unknown).type() == fs::file_type::regular;
        if (!regular || (name != colour_file && !begins_as_ours(file)))
            io::fail(file, "is no export of topple's; move it away or choose another folder");
    }
    if (error) io::fail(folder, "can't be listed: " + error.message());
}

std::string name_beside(std::string_view format) {
    return std::string("scene_").append(format);
}

void check_ours(const fs::path& file) {
    io::check_replaceable_file(file);
    std::error_code error;
    if (fs::exists(file, error) && !begins_as_ours(file))
        io::fail(file, "exists and is no export of topple; choose another folder");
}

void replace_file(const fs::path& file, std::string_view text) {
    check_ours(file);
    if (file.has_parent_path()) make_folder(file.parent_path());
    io::replace_file(file, text);
}

ExportFolder::ExportFolder(const fs::path& folder, const std::string& format,
                           const std::string& top, const std::string& variant)
    : folder_(folder), beside_(name_beside(format)), loaded_{top} {
    if (!variant.empty()) loaded_.push_back(variant);
    for (const std::string& name : loaded_) check_ours(folder_ / name);
    check_folder_ours(folder_ / beside_);
    make_folder(folder_);
    staging_.emplace(folder_);
    make_folder(staging_->path() / beside_);
}

void ExportFolder::add(const std::string& name, std::string_view text) {
    io::write_file(staging_->path() / beside_ / name, text);
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

void ExportFolder::commit(std::string_view top_text, std::string_view variant_text) {
    io::write_file(staging_->path() / loaded_.front(), top_text);
    if (loaded_.size() > 1) io::write_file(staging_->path() / loaded_.back(), variant_text);
    // The earlier one goes as a whole, before anything of it changes: its own folder into the
    // staging folder, of which it goes for good.
    for (const std::string& name : loaded_) check_ours(folder_ / name);
    check_folder_ours(folder_ / beside_);
    const fs::path earlier = staging_->path() / "earlier", files = staging_->path() / beside_;
    std::error_code error;
    for (const std::string& name : loaded_)
        if (::unlink((folder_ / name).c_str()) != 0 && errno != ENOENT)
            io::fail(folder_ / name, std::string("can't be replaced: ") + std::strerror(errno));
    if (fs::exists(folder_ / beside_, error)) put(folder_ / beside_, earlier);
    if (!fs::is_empty(files, error)) put(files, folder_ / beside_);
    for (const std::string& name : loaded_) put(staging_->path() / name, folder_ / name);
}

}  // namespace topple::exports
