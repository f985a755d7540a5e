// SPDX-License-Identifier: MIT
#include "points/formats/cloud_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "core/room_measures.h"
#include "io/text.h"

namespace topple::io {
namespace {

// Points with a colour that tell what full brightness is.
constexpr std::uint64_t enough_colours = 1 << 16;

bool usable_channel(double value) {
    return std::isfinite(value) && value >= 0;
}

double full_brightness(const std::vector<std::array<float, 3>>& colours, ColourValues values) {
    std::uint64_t bright = 0, above_1 = 0, above_255 = 0;
    for (const auto& colour : colours) {
        for (const float value : colour) {
            if (!usable_channel(value)) continue;
            bright += value > 0;
            above_1 += value > 1;
            above_255 += value > 255;
        }
    }
    if (values == ColourValues::real && 100 * above_1 <= bright) return 1;
    return 100 * above_255 <= bright ? 255 : 65535;
}

// Points that a sink gets at a time.
constexpr std::uint64_t portion = 1u << 20;

bool finite(const std::array<double, 3>& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

std::array<std::vector<float>*, 3> viewpoints_of(PointCloud& cloud) {
    return {&cloud.viewpoint_x, &cloud.viewpoint_y, &cloud.viewpoint_z};
}

// Distance between the 2nd and the 98th hundredth of the values, from at most ~10,000 of them:
// stray points must not decide.
double robust_extent(const std::vector<float>& values) {
    std::vector<float> sample;
    const std::size_t stride = values.size() / 10000 + 1;
    for (std::size_t i = 0; i < values.size(); i += stride) sample.push_back(values[i]);
    std::sort(sample.begin(), sample.end());
    const std::size_t cut = sample.size() / 50;
    return double(sample[sample.size() - 1 - cut]) - sample[cut];
}

}  // namespace

void ColourScale::put(const std::array<double, 3>& colour, PointCloud& cloud) const {
    const bool known = std::ranges::all_of(colour, usable_channel);
    const auto byte = [&](double value) {
        return static_cast<std::uint8_t>(known ? std::lround(std::min(value / full_, 1.0) * 255)
                                               : 0);
    };
    cloud.red.push_back(byte(colour[0]));
    cloud.green.push_back(byte(colour[1]));
    cloud.blue.push_back(byte(colour[2]));
}

void ColourScale::add(const std::array<double, 3>& colour, PointCloud& cloud) {
    if (values_ == ColourValues::none) return;
    if (values_ == ColourValues::bytes) full_ = 255;
    if (full_ > 0) {
        put(colour, cloud);
        return;
    }
    waiting_.push_back({static_cast<float>(colour[0]), static_cast<float>(colour[1]),
                        static_cast<float>(colour[2])});
    bright_ += std::ranges::any_of(colour, [](double value) { return value > 0; });
    if (bright_ == enough_colours) settle(cloud);
}

void ColourScale::settle(PointCloud& cloud) {
    if (waiting_.empty()) return;
    full_ = full_brightness(waiting_, values_);
    for (const auto& colour : waiting_) put({colour[0], colour[1], colour[2]}, cloud);
    waiting_ = {};
}

CloudBuilder::CloudBuilder(const std::filesystem::path& file, std::uint64_t promised,
                           CloudFields fields, const CloudSink* sink)
    : file_(file), sink_(sink), fields_(fields), colours_(fields.colours) {
    if (sink) {
        promised = std::min(promised, portion);
    } else {
        cloud_.source = file.string();
    }
    try {
        for (auto* values : {&cloud_.x, &cloud_.y, &cloud_.z}) values->reserve(promised);
        if (fields.normals) {
            for (auto* values : {&cloud_.nx, &cloud_.ny, &cloud_.nz}) values->reserve(promised);
        }
        if (fields.viewpoints) {
            for (auto* values : viewpoints_of(cloud_)) values->reserve(promised);
        }
        if (fields.colours != ColourValues::none) {
            for (auto* values : {&cloud_.red, &cloud_.green, &cloud_.blue})
                values->reserve(promised);
        }
        if (!sink) cloud_.pixel.reserve(promised);
    } catch (const std::exception&) {
        fail(file, counted(promised, "point") + " don't fit into memory; thin the cloud");
    }
}

void CloudBuilder::pass_on() {
    passed_on_ += cloud_.size();
    colours_.settle(cloud_);
    PointCloud next;
    for (const auto values : {&PointCloud::x, &PointCloud::y, &PointCloud::z})
        (next.*values).reserve(portion);
    std::swap(cloud_, next);
    (*sink_)(std::move(next));
}

void CloudBuilder::add(const FilePoint& point) {
    const auto& [at, normal, colour, viewpoint] = point;
    if (sink_ && cloud_.size() == portion) pass_on();
    const auto index = seen_++;
    if (!finite(at)) {
        ++cloud_.dropped;
        return;
    }
    for (const double value : at) {
        if (std::abs(value) > farthest_m) fail(file_, too_far(index, value));
    }
    cloud_.x.push_back(static_cast<float>(at[0]));
    cloud_.y.push_back(static_cast<float>(at[1]));
    cloud_.z.push_back(static_cast<float>(at[2]));
    // Whether the cloud is organised shows at the end; 2^32 pixels and more are refused before.
    if (!sink_) cloud_.pixel.push_back(static_cast<std::uint32_t>(index));
    colours_.add(colour, cloud_);
    if (fields_.viewpoints) {
        const auto columns = viewpoints_of(cloud_);
        for (std::size_t a = 0; a < 3; ++a) {
            const double value = std::abs(viewpoint[a]) <= farthest_m
                                     ? viewpoint[a]
                                     : std::numeric_limits<double>::quiet_NaN();
            columns[a]->push_back(static_cast<float>(value));
        }
    }
    if (!fields_.normals) return;
    const double length =
        std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const bool usable = std::isfinite(length) && length > 1e-6;
    any_normal_ = any_normal_ || usable;
    cloud_.nx.push_back(usable ? static_cast<float>(normal[0] / length) : 0.0f);
    cloud_.ny.push_back(usable ? static_cast<float>(normal[1] / length) : 0.0f);
    cloud_.nz.push_back(usable ? static_cast<float>(normal[2] / length) : 0.0f);
}

PointCloud CloudBuilder::finish(std::uint32_t width, std::uint32_t height) {
    if (cloud_.x.empty() && passed_on_ == 0) {
        fail(file_, seen_ == 0 ? std::string("has no points")
                               : "none of its " + counted(seen_, "point") +
                                     " is finite; at least one must be");
    }
    if (sink_) {
        if (cloud_.size() + cloud_.dropped > 0) pass_on();
        return {};
    }
    if (height > 1) {
        cloud_.width = width;
        cloud_.height = height;
        for (auto* values : viewpoints_of(cloud_)) *values = {};  // an image has one
    } else {
        cloud_.pixel = {};
    }
    if (!any_normal_) cloud_.nx = cloud_.ny = cloud_.nz = {};
    colours_.settle(cloud_);
    // Formats with room for colours are used for scans without any, too.
    const auto dark = [](const std::vector<std::uint8_t>& channel) {
        return std::ranges::all_of(channel, [](std::uint8_t value) { return value == 0; });
    };
    if (dark(cloud_.red) && dark(cloud_.green) && dark(cloud_.blue))
        cloud_.red = cloud_.green = cloud_.blue = {};
    return std::move(cloud_);
}

std::string too_far(std::uint64_t index, double coordinate) {
    return "point " + std::to_string(index) + " has a coordinate of " + short_number(coordinate) +
           ", beyond the limit of 1e+06 m; coordinates must be metres from an origin near the "
           "scene: convert the units, or subtract the map's offset";
}

void note_extent(PointCloud& cloud) {
    double extent = 0, reach = 0;
    for (const auto* values : {&cloud.x, &cloud.y, &cloud.z}) {
        extent = std::max(extent, robust_extent(*values));
        for (const float value : *values) reach = std::max(reach, double(std::abs(value)));
    }
    // Rooms and buildings stay below 300 m; the same in millimetres starts at 1000.
    if (extent > 300) {
        cloud.notes.push_back(
            "The points extend over " + short_number(extent) +
            " m: if the file's unit is the millimetre, say unit_m = 0.001 (--unit mm).");
    }
    // Half a millimetre is what a float resolves at 8192 m.
    if (reach > 8192 && extent <= 300) {
        cloud.notes.push_back(
            "The points lie up to " + short_number(reach) +
            " m from the origin, where 32-bit coordinates are coarser than 0.5 mm: "
            "subtract the offset from the file's coordinates.");
    }
}

}  // namespace topple::io
