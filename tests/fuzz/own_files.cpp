// SPDX-License-Identifier: MIT
#include "fuzz/own_files.h"

#include "core/checksum.h"
#include "device/devices.h"
#include "export/sim_scene.h"
#include "io/text.h"
#include "lab/temporary_folder.h"
#include "objects/object_stage.h"
#include "pipeline/stages.h"
#include "result/solids_file.h"
#include "scale/block_stage.h"
#include "scale/blocks.h"
#include "scale/join_blocks.h"
#include "scale/parts_fields.h"
#include "scale/point_spill.h"
#include "topple/parse.h"

namespace topple::fuzz {
namespace {

namespace fs = std::filesystem;

// A box on a floor.
PointCloud box_on_floor() {
    PointCloud out;
    const auto add = [&](double x, double y, double z) {
        out.x.push_back(static_cast<float>(x));
        out.y.push_back(static_cast<float>(y));
        out.z.push_back(static_cast<float>(z));
    };
    constexpr int floor = 20, box = 8;
    constexpr double step = 0.05;
    for (int i = -floor; i <= floor; ++i)
        for (int j = -floor; j <= floor; ++j) add(i * step, j * step, 0);
    for (int i = -box; i <= box; ++i) {
        for (int k = 0; k <= 2 * box; ++k) {
            for (const double side : {-box * step, box * step}) {
                add(i * step, side, k * step);
                add(side, i * step, k * step);
            }
        }
        for (int j = -box; j <= box; ++j) add(i * step, j * step, 2 * box * step);
    }
    return out;
}

std::string bytes_of(const fs::path& file) {
    return std::string(io::read_file(file).text());
}

// All of topple's files of that room.
class Room {
  public:
    static Room& get() {
        static Room room;
        return room;
    }

    scenes::TemporaryFolder folder{"topple_own_files"};
    ParseOptions options;
    Scene scene;
    tiles::Layout layout;

  private:
    Room() {
        options.device = device::open_device("native", 1);
        options.disturbances = {};
        options.voxel_m = 0.1;
        const PointCloud cloud = box_on_floor();
        write_parts(cloud);
        write_work(cloud);
    }

    void write_parts(const PointCloud& cloud) {
        std::vector<std::pair<std::string, double>> timings;
        StageClock stage(timings, options);
        device::Device& device = *options.device;
        const FoundParts ground =
            find_parts(device, observe_cloud(device, cloud, options), options, "room", stage);
        layout.frame = ground.parts.frame;
        tiles::BinaryWriter file(folder.path() / "parse.cache");
        topple::write_parts(file, ground);
        file.finish(false);
        ParseResult result = parse(cloud, options);
        const fs::path out = folder.path() / "out";
        OutputOptions outputs;
        outputs.threads = 1;
        write_outputs(result, out, outputs);
        fs::rename(out / "solids.bin", folder.path() / "solids.bin");
        scene = std::move(result.scene);
    }

    void write_work(const PointCloud& cloud) {
        constexpr double cell_m = 0.05;
        tiles::PointSpill spill(folder.path(), 1 << 20);
        spill.add(cloud, "room");
        spill.finish();
        const tiles::SpilledPoints points(folder.path());
        std::vector<tiles::Bin> bins;
        for (std::size_t b = 0; b < points.bins().size(); ++b) {
            tiles::thin_bin(points, b, cell_m, folder.path());
            bins.push_back(points.bins()[b].bin);
        }
        layout = tiles::cut_into_blocks(folder.path(), bins, layout.frame, cell_m, 0.1);
        tiles::write_layout(folder.path(), layout);
        for (std::size_t b = 0; b < layout.blocks.size(); ++b) {
            const std::vector<std::size_t> one{b};
            tiles::TileReader reader(folder.path(), bins, layout, one);
            write_block(
                folder.path(), b,
                parse_block(*options.device, reader.next(), layout, layout.blocks[b], options));
        }
        fs::copy(folder.path() / tiles::thinned_name(bins[0]), folder.path() / "cells-0_0_0",
                 fs::copy_options::overwrite_existing);
    }
};

// --- What is changed ---

constexpr std::array<std::uint32_t, 14> odd_words{
    0,        1,          2,          255,        256,        1U << 20,   1U << 30,
    1U << 31, 0x7fffffff, 0xfffffffe, 0xffffffff, 0x7f800000, 0x7fc00000, 0xff7fffff};
constexpr std::array<std::uint64_t, 10> odd_long_words{0,
                                                       1,
                                                       ~std::uint64_t{0},
                                                       std::uint64_t{1} << 63,
                                                       std::uint64_t{1} << 32,
                                                       0x7ff0000000000000,
                                                       0x7ff8000000000000,
                                                       0x7fe1ccf385ebc8a0,
                                                       0xbff0000000000000,
                                                       0x3e112e0be826d695};

struct Change {
    std::uint32_t at;
    std::uint8_t kind, value, low, high;
};
static_assert(sizeof(Change) == 8);

void make_change(const Change& change, std::string& bytes) {
    const std::size_t at = change.at % bytes.size();
    const auto put = [&](const auto& word) {
        const std::size_t size = std::min(sizeof(word), bytes.size() - at);
        std::memcpy(bytes.data() + at, &word, size);
    };
    const auto word_at = [&](std::size_t from) {
        std::uint32_t word = 0;
        std::memcpy(&word, bytes.data() + from, std::min(sizeof(word), bytes.size() - from));
        return word;
    };
    const auto small = static_cast<std::uint32_t>(change.low | change.high << 8);
    switch (change.kind % 8) {
        case 0:
            return put(change.value);
        case 1:
            return put(odd_words[change.value % odd_words.size()]);
        case 2:
            return put(odd_long_words[change.value % odd_long_words.size()]);
        case 3:
            return put(word_at(at) + small - 0x8000);
        case 4:
            return put(word_at((std::size_t{small} << 8 | change.value) % bytes.size()));
        case 5:
            return put(static_cast<std::uint8_t>(static_cast<std::uint8_t>(bytes[at]) ^
                                                 1U << change.value % 8));
        case 6:
            return put(small);
        default:  // a row of equal words
            for (std::size_t n = 0; n < small % 64 && at + 4 * n + 4 <= bytes.size(); ++n)
                std::memcpy(bytes.data() + at + 4 * n, &odd_words[change.value % odd_words.size()],
                            4);
    }
}

// The mark in front says whose file it is; the checksum behind is that of the rest.
std::string sealed(const std::string& good, std::size_t mark, std::string_view changes) {
    std::string bytes = good;
    for (; changes.size() >= sizeof(Change); changes.remove_prefix(sizeof(Change))) {
        Change change;
        std::memcpy(&change, changes.data(), sizeof(change));
        make_change(change, bytes);
    }
    bytes.replace(0, mark, good, 0, mark);
    const std::size_t summed = bytes.size() - sizeof(Checksum::Value);
    const Checksum::Value sum = Checksum::of(bytes.data(), summed);
    std::memcpy(bytes.data() + summed, &sum, sizeof(sum));
    return bytes;
}

constexpr std::size_t solids_mark = 16, work_mark = tiles::file_mark.size();

template <const char* const& name, std::size_t mark>
std::string made(std::string_view changes) {
    static const std::string good = bytes_of(Room::get().folder.path() / name);
    return sealed(good, mark, changes);
}

// --- What is done with it ---

// What takes long is done with one of so many of those that are read.
template <std::size_t of_many>
bool chosen() {
    static std::size_t read = 0;
    return read++ % of_many == 0;
}

void read_as_solids(const fs::path& file) {
    const auto solids = io::read_solids(file);
    if (!chosen<16>()) return;
    const Room& room = Room::get();
    exports::sim_scene(room.scene, *solids, false, true, 1);
}

void read_as_groundwork(const fs::path& file) {
    tiles::BinaryReader in(file);
    FoundParts ground = read_parts(in);
    if (!chosen<64>()) return;
    const Room& room = Room::get();
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, room.options);
    find_objects(*room.options.device, room.options, stage, ground.parts,
                 std::move(ground.weighed));
}

void read_as_block(const fs::path& file) {
    const Room& room = Room::get();
    const BlockParts parts = read_block(file.parent_path(), 0);
    if (!chosen<4>()) return;
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, room.options);
    tiles::Layout one = room.layout;
    one.blocks.resize(1);
    join_blocks(file.parent_path(), one, stage);
}

void read_as_bins(const fs::path& file) {
    const tiles::SpilledPoints points(file.parent_path());
    for (std::size_t b = 0; b < points.bins().size(); ++b) points.read(b, [](auto, auto) {});
}

// The points that the bins name.
void put_points(const fs::path& folder) {
    fs::copy(Room::get().folder.path() / "points.bin", folder / "points.bin",
             fs::copy_options::overwrite_existing);
}

constexpr const char* solids_name = "solids.bin";
constexpr const char* cache_name = "parse.cache";
constexpr const char* block_name = "block-0";
constexpr const char* bins_name = "bins.bin";
constexpr const char* cells_name = "cells-0_0_0";

constexpr Reader listed[] = {
    {"solids", solids_name, read_as_solids, made<solids_name, solids_mark>},
    {"groundwork", cache_name, read_as_groundwork, made<cache_name, work_mark>},
    {"block", block_name, read_as_block, made<block_name, work_mark>},
    {"layout", tiles::layout_name,
     [](const fs::path& file) { tiles::read_layout(file.parent_path()); },
     made<tiles::layout_name, work_mark>},
    {"bins", bins_name, read_as_bins, made<bins_name, work_mark>, put_points},
    {"cells", cells_name, [](const fs::path& file) { tiles::read_thinned(file.parent_path(), {}); },
     made<cells_name, work_mark>},
};

}  // namespace

std::span<const Reader> own_files() {
    return listed;
}

}  // namespace topple::fuzz
