// SPDX-License-Identifier: MIT
#include "points/apart/scan_message.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/text.h"
#include "points/formats/cloud_builder.h"

namespace topple::reader {
namespace {

// 0: a scan; else 1 + the kind of an error.
using Outcome = std::uint8_t;

template <class Archive, class Map>
void fields(Archive& a, Map& map) {
    auto& cloud = map.cloud;
    for (auto* values : {&cloud.x, &cloud.y, &cloud.z, &cloud.nx, &cloud.ny, &cloud.nz}) a(*values);
    for (auto* values : {&cloud.viewpoint_x, &cloud.viewpoint_y, &cloud.viewpoint_z}) a(*values);
    for (auto* values : {&cloud.red, &cloud.green, &cloud.blue}) a(*values);
    a(cloud.dropped);
    a(cloud.width);
    a(cloud.height);
    a(cloud.pixel);
    a(cloud.has_viewpoint);
    a(cloud.viewpoint);
    a(cloud.origin_m);
    a(cloud.offset_m);
    a(cloud.source);
    a(cloud.notes);
    a(map.space.voxel_m);
    a(map.space.corner_m);
    a(map.space.free);
    a(map.space.solid);
}

void expect(bool holds) {
    if (!holds) throw child::BadAnswer();
}

template <class Values>
void expect_finite(const Values& values, double most) {
    // False for NaN, too.
    expect(std::ranges::all_of(values, [&](double v) { return std::abs(v) <= most; }));
}

void check(const PointCloud& cloud) {
    const std::size_t size = cloud.x.size();
    const auto each_or_none = [&](const auto& values) {
        expect(values.empty() || values.size() == size);
    };
    expect(size > 0 && cloud.y.size() == size && cloud.z.size() == size);
    each_or_none(cloud.nx);
    expect(cloud.ny.size() == cloud.nx.size() && cloud.nz.size() == cloud.nx.size());
    each_or_none(cloud.viewpoint_x);
    expect(cloud.viewpoint_y.size() == cloud.viewpoint_x.size() &&
           cloud.viewpoint_z.size() == cloud.viewpoint_x.size());
    each_or_none(cloud.red);
    expect(cloud.green.size() == cloud.red.size() && cloud.blue.size() == cloud.red.size());
    for (const auto* values : {&cloud.x, &cloud.y, &cloud.z})
        expect_finite(*values, std::numeric_limits<float>::max());  // in metres, of any unit
    for (const auto* values : {&cloud.nx, &cloud.ny, &cloud.nz}) expect_finite(*values, 1.001);
    expect_finite(cloud.viewpoint, std::numeric_limits<double>::max());
    expect_finite(cloud.origin_m, std::numeric_limits<double>::max());
    expect_finite(cloud.offset_m, std::numeric_limits<double>::max());
    const std::uint64_t pixels = std::uint64_t{cloud.width} * cloud.height;
    expect(cloud.pixel.size() == (pixels > 0 ? size : 0));
    expect(std::ranges::all_of(cloud.pixel, [&](std::uint64_t p) { return p < pixels; }));
}

void check(const SpaceMap& space) {
    expect(space.voxel_m >= 0 && std::isfinite(space.voxel_m));
    expect_finite(space.corner_m, std::numeric_limits<double>::max());
    expect(space.voxel_m > 0 || (space.free.empty() && space.solid.empty()));
    for (const auto* boxes : {&space.free, &space.solid}) {
        for (const SpaceMap::Box& box : *boxes) {
            for (std::size_t a = 0; a < 3; ++a)
                expect(box.low[a] <= box.high[a] && box.low[a] > INT32_MIN / 2 &&
                       box.high[a] < INT32_MAX / 2);
        }
    }
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
        expect(outcome <= 1 + static_cast<int>(ErrorKind::device));
        constexpr std::size_t most = 8192;  // paths have up to 4096 bytes
        throw Error(static_cast<ErrorKind>(outcome - 1), io::printable(message, most));
    }
    ScannedMap map;
    fields(in, map);
    in.finish();
    check(map.cloud);
    check(map.space);
    for (std::string& note : map.cloud.notes) note = io::printable(note, 8192);
    return map;
}

}  // namespace topple::reader
