// SPDX-License-Identifier: MIT
#include "scale/point_spill.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/field_rules.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

// A portion that is written at a time: long enough to be read back without seeking about.
constexpr std::size_t portion_points = 1u << 15;

// A square kilometre of buildings, five storeys high; and fewer points a bin than show a surface.
constexpr std::size_t most_bins = 200'000;
constexpr std::uint64_t sparse_points = 500;
constexpr std::size_t few_bins = 2000;

// Bins lie within 10^6 m of the origin: 21 bits hold their index.
std::uint64_t key_of(const Bin& bin) {
    std::uint64_t key = 0;
    for (const std::int32_t b : bin) key = (key << 21) | static_cast<std::uint32_t>(b + (1 << 20));
    return key;
}

// Of the file of bins.
template <class Io, class Bins>
void bin_fields(Io& io, Bins& bins, std::uint64_t points) {
    const auto in_file = [points](const std::vector<SpilledPoints::Portion>& portions) {
        return std::ranges::all_of(portions, [&](const SpilledPoints::Portion& p) {
            return p.points <= portion_points && p.before <= points &&
                   p.points <= points - p.before;
        });
    };
    list_fields(io, bins, [&](auto& each, auto& bin) {
        each(bin.bin, rules::within(-(1 << 20), 1 << 20));
        each(bin.points);
        each(bin.portions, in_file);
    });
    io.expect(bins.size() <= most_bins &&
              std::ranges::is_sorted(bins, {}, [](const auto& bin) { return bin.bin; }));
}

}  // namespace

SpilledPoints::SpilledPoints(const fs::path& folder)
    : file_(folder / "points.bin"), colour_file_(folder / "colours.bin") {
    BinaryReader in(folder / bins_name);
    in(points_);
    in(dropped_);
    in(offset_m_, rules::finite);
    in(coloured_);
    bin_fields(in, bins_, points_);
    if (!PortionReader::holds<Point>(file_, points_)) damaged_file(file_);
    if (coloured_ && !PortionReader::holds<Rgb8>(colour_file_, points_)) damaged_file(colour_file_);
}

void SpilledPoints::read(std::size_t bin, const Use& use) const {
    PortionReader in(file_);
    std::optional<PortionReader> colours_in;
    if (coloured_) colours_in.emplace(colour_file_);
    std::vector<Point> points;
    std::vector<Rgb8> colours;
    for (const Portion& portion : bins_[bin].portions) {
        points.resize(portion.points);
        in.read(portion.before, portion.sum, points);
        if (coloured_) {
            colours.resize(portion.points);
            colours_in->read(portion.before, portion.colour_sum, colours);
        }
        use(points, colours);
    }
}

PointSpill::PointSpill(const fs::path& folder, std::uint64_t buffer_bytes)
    : folder_(folder), writer_(folder / "points.bin"), buffer_bytes_(buffer_bytes) {}

void PointSpill::flush(Open& bin) {
    if (bin.buffer.empty()) return;
    SpilledPoints::Portion portion{written_, bin.buffer.size(), writer_.add(bin.buffer), 0};
    if (colour_writer_) portion.colour_sum = colour_writer_->add(bin.colours);
    bin.written.portions.push_back(portion);
    bin.written.points += bin.buffer.size();
    written_ += bin.buffer.size();
    buffered_ -= bin.buffer.size() * sizeof(Point) + bin.colours.size() * sizeof(Rgb8);
    bin.buffer.clear();
    bin.colours.clear();
}

void PointSpill::add(const PointCloud& portion, const std::string& source) {
    // A file's points have colours all of them, or none.
    if (points_ == 0 && !portion.red.empty())
        colour_writer_ = std::make_unique<PortionWriter>(folder_ / "colours.bin");
    dropped_ += portion.dropped;
    points_ += portion.size();
    Bin last{};
    Open* open = nullptr;
    for (std::size_t n = 0; n < portion.size(); ++n) {
        const Point p{portion.x[n], portion.y[n], portion.z[n]};
        const Bin bin = bin_of(p.x, p.y, p.z);
        if (!open || bin != last) {
            const auto [at, fresh] = place_.try_emplace(key_of(bin), bins_.size());
            if (fresh) {
                bins_.emplace_back().written.bin = bin;
                if (bins_.size() > most_bins ||
                    (bins_.size() > few_bins && points_ < sparse_points * bins_.size())) {
                    throw Error(ErrorKind::input,
                                source + ": the first " + std::to_string(points_) +
                                    " points lie in " + std::to_string(bins_.size()) +
                                    " cubes of 5 m, too sparsely for surfaces; if the unit is the "
                                    "millimetre, say unit_m = 0.001 (--unit mm)");
                }
            }
            open = &bins_[at->second];
            last = bin;
        }
        open->buffer.push_back(p);
        buffered_ += sizeof(Point);
        if (colour_writer_) {
            const Rgb8 colour{portion.red.at(n), portion.green.at(n), portion.blue.at(n)};
            any_colour_ = any_colour_ || colour != Rgb8{0, 0, 0};
            open->colours.push_back(colour);
            buffered_ += sizeof(Rgb8);
        }
        if (open->buffer.size() == portion_points) flush(*open);
    }
    if (buffered_ > buffer_bytes_) {
        for (Open& bin : bins_) flush(bin);
        // The capacity stays; a bin that grows large often will again.
        std::uint64_t held = 0;
        for (const Open& bin : bins_)
            held += bin.buffer.capacity() * sizeof(Point) + bin.colours.capacity() * sizeof(Rgb8);
        if (held > 2 * buffer_bytes_) {
            for (Open& bin : bins_) {
                bin.buffer = {};
                bin.colours = {};
            }
        }
    }
}

void PointSpill::finish(const Vec3& offset_m) {
    for (Open& bin : bins_) flush(bin);
    writer_.finish();
    if (colour_writer_) colour_writer_->finish();
    std::ranges::sort(bins_, {}, [](const Open& bin) { return bin.written.bin; });
    BinaryWriter out(folder_ / bins_name);
    out(points_);
    out(dropped_);
    out(offset_m);
    out(any_colour_);
    std::vector<SpilledPoints::BinPoints> written;
    for (const Open& bin : bins_) written.push_back(bin.written);
    bin_fields(out, written, points_);
    out.finish();
}

}  // namespace topple::tiles
