// SPDX-License-Identifier: MIT
#include "live/checkpoint.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/field_rules.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "live/projection.h"
#include "live/scan_kind.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/rigid_pose.h"
#include "scale/binary_file.h"

namespace topple::live {
namespace {

// Changes with what is written below.
const std::string mark = "topple session 3";

template <class Io, class Of>
void intrinsics_fields(Io& io, Of& k) {
    io(k.width);
    io(k.height);
    for (auto* value : {&k.fx, &k.fy, &k.cx, &k.cy, &k.depth_scale}) io(*value);
}

// A camera, if there is one.
template <class Io, class Of, class Fault>
void camera_fields(Io& io, Of& camera, const Fault& fault) {
    bool there = camera.has_value();
    io(there);
    if (!there) return;
    if constexpr (!Io::writes) camera.emplace();
    intrinsics_fields(io, *camera);
    io.expect(!fault(*camera));
}

// Lists them for both ways; what is read is checked.
template <class Io, class Of>
void fields(Io& io, Of& of) {
    camera_fields(io, of.depth, io::depth_intrinsics_fault);
    camera_fields(io, of.colour, io::pinhole_fault);
    io.expect(of.depth || !of.colour);
    io(of.frames.next);
    io(of.frames.last);
    const auto frames_below_next = [&](const auto& map) {
        io.expect(map.empty() || map.rbegin()->first < of.frames.next);
    };
    map_fields(io, of.frames.kept, [&](auto& each, auto& kept) {
        if constexpr (Io::writes) {
            KeptFrame::fields(each, *kept.frame);
        } else {
            auto frame = std::make_shared<KeptFrame>();
            KeptFrame::fields(each, *frame);
            kept.frame = std::move(frame);
        }
        each.expect(of.depth ? kept.frame->is_of(of.depth->width, of.depth->height)
                             : kept.frame->is_of_points());
        each(kept.pose, rules::finite);
        Mat4 rigid = kept.pose;
        each.expect(!io::make_rigid(rigid));
    });
    frames_below_next(of.frames.kept);
    const std::size_t pixels = scan_kind(of)->projection().pixels();
    KnownThings::fields(io, of.remembered.things, of.depth ? std::optional(pixels) : std::nullopt);
    list_fields(io, of.remembered.gone, [&](auto& each, auto& thing) {
        map_fields(each, thing, [&](auto& of_frame, auto& shown) {
            of_frame(shown);
            of_frame.expect(
                std::ranges::all_of(shown, [&](std::uint32_t p) { return p < pixels; }));
        });
        frames_below_next(thing);
    });
    map_fields(io, of.remembered.poses, [](auto& each, auto& pose) { each(pose, rules::finite); });
    frames_below_next(of.remembered.poses);
}

}  // namespace

template <class Io, class Self>
void KnownThings::fields(Io& io, Self& known, std::optional<std::size_t> spots) {
    io(known.next_);
    list_fields(io, known.before_, [&](auto& each, auto& before) {
        each(before.id);
        each.expect(before.id < known.next_);
        each(before.middle_m, rules::finite);
        each(before.size_m, rules::finite);
        each(before.mass_kg);
        each(before.stands_on);
        each.expect(std::ranges::is_sorted(before.stands_on));
        each(before.category, rules::shown);
    });
    map_fields(io, known.showed_, [&](auto& each, auto& objects) {
        each(objects, rules::labels(known.before_.size()));
        each.expect(!spots || objects.size() == *spots);
    });
}

void Checkpoint::write(const std::filesystem::path& file) const {
    io::check_own_file(file, mark.substr(0, mark.rfind(' ')),
                       "is no checkpoint of topple; choose another name");
    io::PendingFile pending(file);
    tiles::BinaryWriter writer(pending.path());
    writer(mark);
    fields(writer, *this);
    writer.finish();
    pending.commit();
    io::sync_folder(std::filesystem::absolute(file).parent_path());
}

Checkpoint Checkpoint::read(const std::filesystem::path& file) {
    tiles::BinaryReader reader(
        file, "is no checkpoint of a session, or damaged or cut short; go on from an older one");
    if (reader.value<std::string>() != mark)
        io::fail(file, "is no checkpoint of a session of this version of topple; begin anew");
    Checkpoint out;
    fields(reader, out);
    return out;
}

}  // namespace topple::live
