// SPDX-License-Identifier: MIT
#include "scale/tiled_stages.h"

#include <algorithm>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <ranges>
#include <set>
#include <utility>

#include "core/number_text.h"
#include "core/thread_pool.h"
#include "io/text.h"
#include "points/budget.h"
#include "points/parse_memory.h"
#include "scale/block_stage.h"
#include "scale/shared_stage.h"
#include "scale/work_files.h"
#include "scale/work_folder.h"
#include "topple/version.h"

namespace topple {
namespace {

namespace fs = std::filesystem;

// What the leader tells the others of a stage. As text its parts are separated by zeros, which no
// path holds.
struct Order {
    std::string stage;
    fs::path folder;
    std::string manifest;
    double size_m = 0;  // of the thinning's cells, or of the blocks' tiles

    std::string text() const {
        std::string out = stage;
        for (const std::string& part : {folder.string(), manifest, to_digits(size_m, 17)})
            out.append(1, '\0').append(part);
        return out;
    }
    static Order from(const std::string& text) {
        std::vector<std::string> parts;
        for (const auto part : std::views::split(text, '\0'))
            parts.emplace_back(part.begin(), part.end());
        if (parts.size() != 4)
            throw Error(ErrorKind::input, "the leader's order is of another version of topple");
        double size_m = 0;
        io::parse_number(parts[3], size_m);
        return {parts[0], parts[1], parts[2], size_m};
    }
};

// A member's part of the thinning: a bin on each thread.
void thin_some(Crew& crew, device::Device& device, const tiles::SpilledPoints& points,
               const Order& order, const std::function<void()>& tell) {
    work_off(
        crew, device, device.threads().threads(),
        [&](std::uint64_t bin) { tiles::thin_bin(points, bin, order.size_m, order.folder); }, tell);
}

// Devices for blocks that are parsed at the same time. Much of a block's work is done by one
// thread: of native devices each thread gets one of its own, as far as memory allows; another
// device is alone.
class BlockDevices {
  public:
    BlockDevices(device::Device& device, const tiles::Layout& layout, const ParseOptions& options) {
        const unsigned threads = device.threads().threads();
        if (device.info().backend != device::Backend::native || threads < 2) {
            free_.push_back(&device);
        } else {
            const unsigned lanes = std::min(threads, most_lanes(layout, options));
            for (unsigned n = 0; n < lanes; ++n) {
                own_.push_back(device::open_device("native", lanes == 1 ? threads : 1));
                free_.push_back(own_.back().get());
            }
        }
        lanes_ = static_cast<unsigned>(free_.size());
    }
    unsigned lanes() const { return lanes_; }

    // Calls work(device) with a device that nobody else uses. At most lanes() at a time.
    template <class Work>
    void with(const Work& work) {
        device::Device* mine = nullptr;
        {
            const std::lock_guard lock(mutex_);
            mine = free_.back();
            free_.pop_back();
        }
        const auto give_back = [&](device::Device* d) {
            const std::lock_guard lock(mutex_);
            free_.push_back(d);
        };
        const std::unique_ptr<device::Device, decltype(give_back)> held(mine, give_back);
        work(*mine);
    }

  private:
    static unsigned most_lanes(const tiles::Layout& layout, const ParseOptions& options) {
        if (memory_bound(options) == UINT64_MAX) return UINT_MAX;
        return static_cast<unsigned>(std::clamp(
            static_cast<double>(memory_bound(options)) / block_bytes(tiles::largest_block(layout)),
            1.0, 1024.0));
    }

    std::mutex mutex_;
    std::vector<std::shared_ptr<device::Device>> own_;
    std::vector<device::Device*> free_;
    unsigned lanes_ = 0;
};

// The blocks of a tile that are not there yet.
std::vector<std::size_t> blocks_left(const std::vector<std::size_t>& tile,
                                     const std::set<std::string>& there) {
    std::vector<std::size_t> out;
    for (const std::size_t b : tile) {
        if (!there.contains(block_file({}, b).string())) out.push_back(b);
    }
    return out;
}

// A member's part of the blocks.
void parse_some(Crew& crew, device::Device& device, const tiles::SpilledPoints& points,
                const tiles::Layout& layout, const Order& order, const ParseOptions& options,
                const std::function<void()>& tell) {
    const fs::path& folder = order.folder;
    const auto tiles = tiles::tiles_of(layout, order.size_m);
    const std::vector<tiles::Bin> bins = bins_of(points);
    std::optional<BlockDevices> devices;
    try {
        devices.emplace(device, layout, options);
    } catch (...) {
        crew.end(std::current_exception(), tell);  // the others wait for everyone's end
        return;
    }
    work_off(
        crew, device, devices->lanes(),
        [&](std::uint64_t tile) {
            const auto left = blocks_left(tiles.at(tile), tiles::names_in(folder));
            tiles::TileReader reader(folder, bins, layout, left);
            devices->with([&](device::Device& own) {
                for (const std::size_t b : left)
                    write_block(folder, b,
                                parse_block(own, reader.next(), layout, layout.blocks[b], options));
            });
        },
        tell);
}

// Tells the progress of a stage: of its whole weight `before` was done by an earlier run.
std::function<void()> progress_of(const char* name, const Crew& crew, std::uint64_t before,
                                  std::uint64_t all, StageClock& stage) {
    return [=, &crew, &stage] {
        stage.progress(name,
                       static_cast<double>(before + crew.finished()) / static_cast<double>(all));
    };
}

// What is wrong with a member that got this order.
void check_order(const Order& order, const ParseOptions& options) {
    if (!order.manifest.ends_with(options_text(options)))
        throw Error(ErrorKind::usage,
                    "was started with other options than the leader, or is another version of "
                    "topple; start the same program with the same options everywhere");
    if (!tiles::is_work_folder(order.folder, order.manifest))
        io::fail(order.folder,
                 "is not the leader's folder of that name; the output must be on a file system "
                 "that all machines share");
}

// Another member's part of a stage, with all that can be wrong before its first task.
std::function<void()> part_of_stage(Crew& crew, device::Device& device, const std::string& text,
                                    const ParseOptions& options) {
    const Order order = Order::from(text);
    check_order(order, options);
    const auto points = std::make_shared<const tiles::SpilledPoints>(order.folder);
    const auto nothing = [] {};
    if (order.stage == "thinning")
        return [=, &crew, &device] { thin_some(crew, device, *points, order, nothing); };
    const auto layout = std::make_shared<const tiles::Layout>(tiles::read_layout(order.folder));
    return [=, &crew, &device, &options] {
        parse_some(crew, device, *points, *layout, order, options, nothing);
    };
}

}  // namespace

std::string options_text(const ParseOptions& o) {
    char text[256];
    // To be counted up where the files of a work folder change within a version.
    constexpr int layout = 3;
    std::snprintf(text, sizeof(text), " voxel %a unit %a up %a %a %a version %s layout %d",
                  o.voxel_m, o.unit_m, o.up ? (*o.up)[0] : 0, o.up ? (*o.up)[1] : 0,
                  o.up ? (*o.up)[2] : 0, version, layout);
    return text;
}

std::vector<tiles::Bin> bins_of(const tiles::SpilledPoints& points) {
    std::vector<tiles::Bin> out;
    for (const auto& bin : points.bins()) out.push_back(bin.bin);
    return out;
}

void thin_bins(const SharedWork& shared, const tiles::SpilledPoints& points, double cell_m,
               StageClock& stage) {
    const std::set<std::string> there = tiles::names_in(shared.folder);
    std::vector<Crew::Task> tasks;
    std::uint64_t before = 0;
    for (std::size_t b = 0; b < points.bins().size(); ++b) {
        const auto& bin = points.bins()[b];
        if (there.contains(tiles::thinned_name(bin.bin))) {
            before += bin.points;
        } else {
            tasks.push_back({b, bin.points});
        }
    }
    large_first(tasks);
    const Order order{"thinning", shared.folder, shared.manifest, cell_m};
    shared.crew.begin(order.text(), std::move(tasks));
    thin_some(shared.crew, shared.device, points, order,
              progress_of("thinning", shared.crew, before, points.points(), stage));
}

void parse_blocks(const SharedWork& shared, const tiles::SpilledPoints& points,
                  const tiles::Layout& layout, const ParseOptions& options, StageClock& stage) {
    const std::set<std::string> there = tiles::names_in(shared.folder);
    std::vector<Crew::Task> tasks;
    std::uint64_t before = 0, all = 0;
    const Order order{"blocks", shared.folder, shared.manifest,
                      options.tile_m > 0 ? options.tile_m : tiles::block_edge_m};
    for (const tiles::Block& block : layout.blocks) all += block.cells;
    before = all;
    const auto tiles = tiles::tiles_of(layout, order.size_m);
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        std::uint64_t cells = 0;
        for (const std::size_t b : blocks_left(tiles[t], there)) cells += layout.blocks[b].cells;
        if (cells > 0) tasks.push_back({t, cells});
        before -= cells;
    }
    large_first(tasks);
    shared.crew.begin(order.text(), std::move(tasks));
    parse_some(shared.crew, shared.device, points, layout, order, options,
               progress_of("blocks", shared.crew, before, all, stage));
}

void help_parse(Crew& crew, const ParseOptions& options) {
    const auto device = options.device ? options.device : device::open_device("auto");
    while (const std::optional<std::string> order = crew.wait()) {
        std::function<void()> part;
        try {
            part = part_of_stage(crew, *device, *order, options);
        } catch (...) {
            crew.end(std::current_exception(), [] {});
            continue;
        }
        part();
    }
}

}  // namespace topple
