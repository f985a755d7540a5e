// SPDX-License-Identifier: MIT
#include "vdb/volume_checks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "io/text.h"

namespace topple::io {
namespace {

constexpr std::string_view magic(" BDV\0\0\0\0", 8);
// Of the first published OpenVDB (2012); what was before had another header.
constexpr std::uint32_t oldest = 220;
constexpr std::uint32_t compression_of_each_grid = 222;

// Bytes of the maps from index to world as OpenVDB writes them, by type; others are not known.
constexpr std::array<std::pair<std::string_view, std::uint64_t>, 7> maps{{
    {"UniformScaleMap", 120},
    {"ScaleMap", 120},
    {"UniformScaleTranslateMap", 144},
    {"ScaleTranslateMap", 144},
    {"TranslationMap", 24},
    {"AffineMap", 128},
    {"UnitaryMap", 128},
}};

class VolumeChecks {
  public:
    VolumeChecks(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), bytes_(bytes) {}

    void run() {
        if (!bytes_.starts_with(magic))
            fail(file_, "is no OpenVDB file: it doesn't start with its magic number");
        at_ = magic.size();
        version_ = number<std::uint32_t>("version");
        if (version_ < oldest) {
            fail(file_, "is of OpenVDB's file version " + std::to_string(version_) + "; from " +
                            std::to_string(oldest) + " on they are read: write it anew");
        }
        skip(8, "version");
        const bool table = number<std::uint8_t>("header") != 0;
        if (version_ < compression_of_each_grid) skip(1, "header");
        skip(36, "id");
        metadata();
        const auto grids = count("grids", 3 * 4 + 3 * 8);
        // A file that was written to a stream has no table, and its first grid follows.
        for (std::uint64_t n = 0; n < (table ? grids : std::min<std::uint64_t>(grids, 1)); ++n)
            grid(n, table);
    }

  private:
    void grid(std::uint64_t index, bool table) {
        which_ = "grid " + std::to_string(index) + "'s ";
        text("name");
        const std::string_view type = text("type");
        const bool instance = !text("instance").empty();
        const auto begin = number<std::int64_t>("place"), values = number<std::int64_t>("place"),
                   end = number<std::int64_t>("place");
        if (!table) {
            body(type, instance);
            return;
        }
        const auto size = static_cast<std::int64_t>(bytes_.size());
        if (end > size) {
            fail(file_, "is cut short: its grids reach to byte " + std::to_string(end) +
                            ", the file has " + std::to_string(size) + "; copy it again");
        }
        // The tree of an instance is another grid's, and it has no values.
        if (begin < static_cast<std::int64_t>(at_) || end < begin ||
            (!instance && (values < begin || end < values)))
            fail(file_, which_ + "place in the file makes no sense: it is damaged");
        const std::size_t next = static_cast<std::size_t>(end);
        at_ = static_cast<std::size_t>(begin);
        body(type, instance);
        at_ = next;
    }

    // A grid's own metadata, its map, and the root of its tree.
    void body(std::string_view type, bool instance) {
        if (version_ >= compression_of_each_grid) skip(4, "compression");
        metadata();
        const std::string_view map = text("map");
        const auto known = std::ranges::find(maps, map, [](const auto& m) { return m.first; });
        if (instance || known == maps.end() ||
            !(type.starts_with("Tree_float_5_4_3") || type.starts_with("Tree_int32_5_4_3")))
            return;  // others are not read
        skip(known->second, "map");
        skip(4, "tree");  // how many buffers, which is not used
        skip(4, "background");
        const auto tiles = number<std::uint32_t>("tiles"), nodes = number<std::uint32_t>("nodes");
        // A tile's place, value and state; a node's place and two masks of 32^3 bits.
        const std::uint64_t needed = std::uint64_t{17} * tiles + std::uint64_t{12 + 8192} * nodes;
        if (needed > left()) {
            fail(file_, which_ + "tree is said to have " + counted(tiles, "tile") + " and " +
                            counted(nodes, "node") +
                            ", more than the file has bytes for: it is "
                            "damaged");
        }
    }

    void metadata() {
        const auto entries = count("entries of metadata", 3 * 4);
        for (std::uint64_t n = 0; n < entries; ++n) {
            text("metadata's name");
            text("metadata's type");
            text("metadata");
        }
    }

    std::uint64_t left() const { return bytes_.size() - at_; }

    void skip(std::uint64_t size, const char* what) {
        if (size > left())
            fail(file_, "is cut short: " + which_ + what + " would lie beyond its end");
        at_ += static_cast<std::size_t>(size);
    }

    template <class Number>
    Number number(const char* what) {
        const std::size_t from = at_;
        skip(sizeof(Number), what);
        Number value;
        std::memcpy(&value, bytes_.data() + from, sizeof(Number));
        return value;
    }

    // A count of things of `least` bytes or more each.
    std::uint64_t count(const char* what, std::uint64_t least) {
        const auto value = number<std::int32_t>(what);
        if (value < 0 || static_cast<std::uint64_t>(value) > left() / least) {
            fail(file_, which_ + what + " are said to be " + std::to_string(value) +
                            ", more than the file has bytes for: it is damaged");
        }
        return static_cast<std::uint64_t>(value);
    }

    // A length, and as many bytes.
    std::string_view text(const char* what) {
        const auto length = number<std::int32_t>(what);
        if (length < 0 || static_cast<std::uint64_t>(length) > left()) {
            fail(file_, which_ + what + " is said to have " + std::to_string(length) +
                            " bytes, the file has " + std::to_string(left()) +
                            " more: it is damaged");
        }
        const std::size_t from = at_;
        at_ += static_cast<std::size_t>(length);
        return bytes_.substr(from, static_cast<std::size_t>(length));
    }

    const std::filesystem::path& file_;
    std::string_view bytes_;
    std::size_t at_ = 0;
    std::uint32_t version_ = 0;
    std::string which_ = "its ";  // whose what is read is
};

}  // namespace

void check_volume(const std::filesystem::path& file, std::string_view bytes) {
    VolumeChecks(file, bytes).run();
}

}  // namespace topple::io
