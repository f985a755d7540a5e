// SPDX-License-Identifier: MIT
#include "points/formats/colour_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <system_error>

#include "io/open_file.h"
#include "io/text.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

// Proportions of two images that differ by less are the same.
constexpr double same_proportions = 0.02;

// The images in color/ by their names without extension; hidden files are other programs'.
std::map<fs::path, std::string> images_in(const fs::path& scan) {
    const fs::path folder = scan / "color";
    std::map<fs::path, std::string> out;
    std::error_code error;
    if (!fs::is_directory(folder, error)) return out;
    const std::vector<std::string> names = folder_names(FileName::in(scan, "color"), error);
    if (error) fail(folder, why_not_opened(error.value()));
    for (const std::string& name : names) {
        const fs::path file = name;
        const std::string extension = lower_case(file.extension().string());
        if ((extension != ".png" && extension != ".jpg" && extension != ".jpeg") ||
            name.front() == '.')
            continue;
        const auto [at, fresh] = out.try_emplace(file.stem(), name);
        if (!fresh) {
            // Of a list: by reference, it would return the names of two files that are gone.
            const auto both = std::minmax({at->second, name});
            fail(folder,
                 "has both " + both.first + " and " + both.second + "; keep the one that is meant");
        }
    }
    return out;
}

// The intrinsics of a camera whose images are the same, but of another size.
Intrinsics scaled(const Intrinsics& from, std::uint32_t width, std::uint32_t height) {
    const double x = static_cast<double>(width) / from.width,
                 y = static_cast<double>(height) / from.height;
    Intrinsics out = from;
    out.width = width;
    out.height = height;
    out.fx *= x;
    out.fy *= y;
    // A pixel's centre is at a whole number, so the image begins half a pixel before 0.
    out.cx = (from.cx + 0.5) * x - 0.5;
    out.cy = (from.cy + 0.5) * y - 0.5;
    return out;
}

// The pixels [first, last) of a row that `count` pixels of another one fall into.
struct Footprint {
    std::uint32_t first = 0, last = 0;
};

// By pixel of the other camera, whose centre and focal length are `from`, along one axis.
std::vector<Footprint> footprints(std::uint32_t count, double from_f, double from_c, double to_f,
                                  double to_c, std::uint32_t size) {
    const double scale = to_f / from_f;
    std::vector<Footprint> out(count);
    for (std::uint32_t n = 0; n < count; ++n) {
        const double middle = (n - from_c) * scale + to_c;
        double first = std::ceil(middle - scale / 2), last = std::ceil(middle + scale / 2);
        if (!(last > first)) {
            first = std::round(middle);
            last = first + 1;
        }
        const double end = size;
        out[n] = {static_cast<std::uint32_t>(std::clamp(first, 0.0, end)),
                  static_cast<std::uint32_t>(std::clamp(last, 0.0, end))};
    }
    return out;
}

}  // namespace

std::vector<std::uint8_t> seen_by(const Intrinsics& other, const Intrinsics& camera,
                                  const ColourImage& image) {
    const std::vector<Footprint> columns =
        footprints(other.width, other.fx, other.cx, camera.fx, camera.cx, image.width);
    const std::vector<Footprint> rows =
        footprints(other.height, other.fy, other.cy, camera.fy, camera.cy, image.height);
    std::vector<std::uint8_t> out;
    out.reserve(std::size_t{3} * other.width * other.height);
    for (const Footprint& row : rows) {
        for (const Footprint& column : columns) {
            std::array<std::uint64_t, 3> sum{};
            std::uint64_t known = 0;
            for (std::uint32_t v = row.first; v < row.last; ++v) {
                const std::uint8_t* at =
                    image.rgb.data() + 3 * (std::size_t{v} * image.width + column.first);
                for (std::uint32_t u = column.first; u < column.last; ++u, at += 3) {
                    if ((at[0] | at[1] | at[2]) == 0) continue;
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += at[c];
                    ++known;
                }
            }
            for (const std::uint64_t s : sum)
                out.push_back(known == 0 ? std::uint8_t{0}
                                         : static_cast<std::uint8_t>((s + known / 2) / known));
        }
    }
    return out;
}

ColourFrames ColourFrames::open(const fs::path& folder, const std::vector<FileName>& depth_images,
                                const Intrinsics& depth) {
    ColourFrames out;
    const auto images = images_in(folder);
    if (images.empty()) return out;
    std::size_t found = 0;
    for (const FileName& frame : depth_images) {
        const auto at = images.find(frame.path().stem());
        out.images_.emplace_back();
        if (at == images.end()) continue;
        out.images_.back() = FileName::in(folder, fs::path("color") / at->second);
        ++found;
    }
    if (found == 0) {
        out.images_.clear();
        out.notes_.push_back("No image in color/ is named like a depth image, such as " +
                             depth_images.front().path().stem().string() +
                             ".jpg, so the scan has no colours.");
        return out;
    }
    if (found < depth_images.size()) {
        out.notes_.push_back(counted(depth_images.size() - found, "frame") + " of " +
                             std::to_string(depth_images.size()) +
                             " has no image of its name in color/.");
    }
    out.camera_ = {depth, read_colour_intrinsics(folder)};
    return out;
}

std::optional<std::string> ColourCamera::size_fault(std::uint32_t width, std::uint32_t height,
                                                    const std::string& mend) const {
    const std::string is = "is " + size_text(width, height) + " pixels, but ";
    const auto size = [](const Intrinsics& k) { return size_text(k.width, k.height); };
    if (own) {
        if (width == own->width && height == own->height) return std::nullopt;
        return is + "its intrinsics say " + size(*own);
    }
    const double ratio =
        (static_cast<double>(width) * depth.height) / (static_cast<double>(height) * depth.width);
    if (std::abs(ratio - 1) <= same_proportions) return std::nullopt;
    return is + "the depth images are " + size(depth) + ", of other proportions; " + mend;
}

std::vector<std::uint8_t> ColourCamera::seen_by_depth(const ColourImage& image) const {
    return seen_by(depth, own ? *own : scaled(depth, image.width, image.height), image);
}

const FileName* ColourFrames::file(std::size_t index) const {
    return images_.empty() || !images_.at(index) ? nullptr : &*images_[index];
}

std::vector<std::uint8_t> ColourFrames::load(std::size_t index) const {
    const FileName* const name = file(index);
    if (!name) return {};
    const fs::path& file = name->path();
    const char* const mend =
        "give the colour camera's intrinsics as \"color_intrinsics\" in intrinsics.json, or move "
        "color/ away";
    const ColourImage image =
        decode_colour_image(file, read_file(*name).text(), [&](std::uint32_t w, std::uint32_t h) {
            if (const auto fault = camera_.size_fault(w, h, mend)) fail(file, *fault);
        });
    return camera_.seen_by_depth(image);
}

}  // namespace topple::io
