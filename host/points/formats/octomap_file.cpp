// SPDX-License-Identifier: MIT
#include "points/formats/octomap_file.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "io/text.h"
#include "points/formats/scalar.h"

namespace topple::io {
namespace {

// A map's voxels, in its unit: from below the noise of any sensor in metres, to its millimetres.
constexpr double finest = 1e-4, coarsest = 1e4;

// Walks over a stored tree, depth first as it lies in the file.
class Walk {
  public:
    Walk(const std::filesystem::path& file, std::string_view bytes, bool binary)
        : file_(file), bytes_(bytes), binary_(binary) {}

    std::size_t length() {
        if (bytes_.empty()) fail(file_, "is an OctoMap without a tree: nothing follows its header");
        // Children left to walk over, by depth.
        std::array<int, octomap_depth + 1> left{};
        int depth = 0;
        left[0] = 1;
        while (depth >= 0) {
            if (left[depth] == 0) {
                --depth;
                continue;
            }
            --left[depth];
            const int children = binary_ ? binary_node() : node();
            if (children == 0) continue;
            if (++depth > octomap_depth - (binary_ ? 1 : 0)) {
                fail(file_, "its tree is deeper than the " + std::to_string(octomap_depth) +
                                " levels of an OctoMap; the file is damaged");
            }
            left[depth] = children;
        }
        return at_;
    }

  private:
    const char* take(std::size_t count) {
        if (count > bytes_.size() - at_) {
            fail(file_, "its tree goes on after its " + std::to_string(bytes_.size()) +
                            " bytes; the file is cut short");
        }
        at_ += count;
        return bytes_.data() + at_ - count;
    }
    // Two bits a child: 1 and 2 are leaves, 3 has children of its own. Returns how many of these.
    int binary_node() {
        const char* bits = take(2);
        int inner = 0;
        bool any = false;
        for (int child = 0; child < 8; ++child) {
            const int kind = static_cast<unsigned char>(bits[child / 4]) >> (child % 4 * 2) & 3;
            inner += kind == 3;
            any = any || kind != 0;
        }
        if (!any) fail(file_, "its tree has an inner node without a child; the file is damaged");
        return inner;
    }
    // Log-odds, then a bit a child. Returns how many of these.
    int node() {
        const char* data = take(5);
        if (!std::isfinite(load_scalar(Scalar::f32, data, std::endian::native == std::endian::big)))
            fail(file_, "a node's log-odds are not finite; the file is damaged");
        int children = 0;
        for (int child = 0; child < 8; ++child)
            children += static_cast<unsigned char>(data[4]) >> child & 1;
        return children;
    }

    const std::filesystem::path& file_;
    std::string_view bytes_;
    bool binary_;
    std::size_t at_ = 0;
};

}  // namespace

OctomapFile open_octomap(const std::filesystem::path& file, std::string_view bytes) {
    if (!bytes.starts_with("# Octomap OcTree")) {
        fail(file, "starts with " + in_quotes(bytes.substr(0, 16)) +
                       ", where an OctoMap starts with \"# Octomap OcTree\"");
    }
    OctomapFile map;
    Lines lines(bytes);
    std::string_view line;
    lines.next(line);
    map.binary = line.starts_with("# Octomap OcTree binary file");
    std::string id;
    while (lines.next(line)) {
        const auto bad = [&](const std::string& message) {
            fail(file, "line " + std::to_string(lines.number()) + ": " + message);
        };
        if (line.starts_with('#')) continue;
        const auto keyword = next_token(line);
        const auto value = next_token(line);
        if (keyword == "id") {
            id = value;
        } else if (keyword == "res") {
            if (!parse_number(value, map.resolution_m) || !(map.resolution_m >= finest) ||
                !(map.resolution_m <= coarsest))
                bad("the resolution is " + in_quotes(value) + ", but must be metres, from " +
                    short_number(finest) + " to " + short_number(coarsest));
        } else if (keyword == "data") {
            break;
        } else if (keyword != "size" && !keyword.empty()) {
            bad(in_quotes(keyword) + " is no keyword of an OctoMap's header");
        }
    }
    if (id != "OcTree") {
        fail(file, "holds a tree of kind " + in_quotes(id) +
                       "; OcTree is read: convert it, or write it with octomap as .bt");
    }
    if (!(map.resolution_m > 0)) fail(file, "its header has no line `res` before its data");
    map.tree = bytes.substr(lines.offset());
    map.tree = map.tree.substr(0, Walk(file, map.tree, map.binary).length());
    return map;
}

}  // namespace topple::io
