// SPDX-License-Identifier: MIT
#include "points/apart/scan_message.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <new>

#include "core/field_rules.h"
#include "io/text.h"
#include "points/formats/cloud_builder.h"

namespace topple::reader {
namespace {

bool is_right(const SpaceMap::Box& box) {
    for (std::size_t a = 0; a < 3; ++a)
        if (box.low[a] > box.high[a] || box.low[a] <= INT32_MIN / 2 || box.high[a] >= INT32_MAX / 2)
            return false;
    return true;
}

// 0: a scan; else 1 + the kind of an error.
using Outcome = std::uint8_t;

// With what each must be: a child may have been taken over by its file.
template <class Io, class Map>
void fields(Io& io, Map& map) {
    using namespace rules;
    constexpr auto unit = within(-1.001, 1.001);
    auto& cloud = map.cloud;
    io(cloud.x, finite, [](const auto& x) { return !x.empty(); });  // in metres, of any unit
    const std::size_t size = cloud.x.size();
    for (auto* values : {&cloud.y, &cloud.z}) io(*values, length(size), finite);
    io(cloud.nx, length_or_none(size), unit);
    for (auto* values : {&cloud.ny, &cloud.nz}) io(*values, length(cloud.nx.size()), unit);
    io(cloud.viewpoint_x, length_or_none(size));
    for (auto* values : {&cloud.viewpoint_y, &cloud.viewpoint_z})
        io(*values, length(cloud.viewpoint_x.size()));
    io(cloud.red, length_or_none(size));
    for (auto* values : {&cloud.green, &cloud.blue}) io(*values, length(cloud.red.size()));
    io(cloud.dropped);
    io(cloud.width);
    io(cloud.height);
    const std::size_t pixels = std::size_t{cloud.width} * cloud.height;
    io(cloud.pixel, length(pixels > 0 ? size : 0), ids(pixels));
    io(cloud.has_viewpoint);
    for (auto* place : {&cloud.viewpoint, &cloud.origin_m, &cloud.offset_m}) io(*place, finite);
    io(cloud.source);
    io(cloud.notes);
    auto& space = map.space;
    io(space.voxel_m, finite, [](double edge) { return edge >= 0; });
    io(space.corner_m, finite);
    for (auto* boxes : {&space.free, &space.solid})
        io(*boxes, [&](const auto& all) {
            return all.empty() || (space.voxel_m > 0 && std::ranges::all_of(all, is_right));
        });
}

}  // namespace

void write_scan(const ScannedMap& map, int descriptor) {
    child::Writer out(descriptor);
    out(Outcome{0});
    fields(out, map);
    out.finish();
}

void write_error(const Error& error, int descriptor) {
    child::Writer out(descriptor);
    out(static_cast<Outcome>(1 + static_cast<int>(error.kind())));
    out(std::string(error.what()));
    out.finish();
}

ScannedMap take_scan(const child::Answer& answer) {
    child::Reader in(answer);
    Outcome outcome = 0;
    in(outcome);
    if (outcome > 0) {
        std::string message;
        in(message);
        in.finish();
        in.expect(outcome <= 1 + static_cast<int>(ErrorKind::device));
        constexpr std::size_t most = 8192;  // paths have up to 4096 bytes
        throw Error(static_cast<ErrorKind>(outcome - 1), io::printable(message, most));
    }
    ScannedMap map;
    fields(in, map);
    in.finish();
    for (std::string& note : map.cloud.notes) note = io::printable(note, 8192);
    return map;
}

std::string unit_text(double unit_m) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), unit_m, std::chars_format::hex);
    return {text, end.ptr};
}

void answer_scan(const std::string& unit, const std::filesystem::path& file,
                 const std::function<ScannedMap(const std::filesystem::path&, double)>& read) {
    double unit_m = 0;
    std::from_chars(unit.data(), unit.data() + unit.size(), unit_m, std::chars_format::hex);
    const auto refuse = [&](const std::string& why) {
        write_error({ErrorKind::input, io::path_text(file) + ": " + why});
    };
    try {
        write_scan(read(file, unit_m));
    } catch (const Error& error) {
        write_error(error);
    } catch (const std::bad_alloc&) {
        refuse(
            "takes more memory to read than a file of its size may; it is damaged, or, if you "
            "trust it, say isolate = false (--no-isolate)");
    } catch (const std::exception& error) {
        refuse("can't be read: " + io::printable(error.what(), 200));
    }
}

}  // namespace topple::reader
