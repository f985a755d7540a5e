// SPDX-License-Identifier: MIT
#include "result/solids_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/checksum.h"
#include "core/saved_solids.h"
#include "io/file_writer.h"
#include "io/text.h"

// A head, the arrays one after another in the machine's byte order, which is little-endian wherever
// topple runs, and the checksum of all that.
namespace topple::io {
namespace {

struct Head {
    std::array<char, 16> name{'t', 'o', 'p', 'p', 'l', 'e', ' ', 's',
                              'o', 'l', 'i', 'd', 's', ' ', '1', '\n'};
    double voxel_m = 0;
    std::uint64_t cells = 0, below = 0, strays = 0, boundary = 0, patches = 0, primitives = 0;
};
static_assert(sizeof(Head) == 72 && std::is_trivially_copyable_v<Head>);

// The patches without the gaps that a struct has.
struct FlatPatches {
    std::vector<std::array<double, 15>> form;  // origin, coefficients, noise, offset
    std::vector<std::int32_t> primitive;
};

FlatPatches flattened(const std::vector<SurfacePatch>& patches) {
    FlatPatches out;
    for (const SurfacePatch& p : patches) {
        auto& form = out.form.emplace_back();
        auto end = std::ranges::copy(p.origin, form.begin()).out;
        end = std::ranges::copy(p.c, end).out;
        *end++ = p.noise_m;
        *end = p.offset_m;
        out.primitive.push_back(p.primitive);
    }
    return out;
}

std::vector<SurfacePatch> patches_of(const FlatPatches& flat) {
    std::vector<SurfacePatch> out(flat.form.size());
    for (std::size_t n = 0; n < out.size(); ++n) {
        const double* from = flat.form[n].data();
        std::copy_n(from, 3, out[n].origin.begin());
        std::copy_n(from + 3, 10, out[n].c.begin());
        out[n].noise_m = from[13];
        out[n].offset_m = from[14];
        out[n].primitive = flat.primitive[n];
    }
    return out;
}

// All arrays in their order in the file: visit(array, how many).
template <class Solids, class Patches, class Visit>
void each_array(Solids& solids, Patches& patches, const Head& head, const Visit& visit) {
    SolidCells::each_array([&](auto& array) { visit(array, head.cells); }, solids.cells);
    visit(solids.cells.unseen_below, head.below);
    SolidCells::each_array([&](auto& array) { visit(array, head.strays); }, solids.strays);
    BoundaryCells::each_array([&](auto& array) { visit(array, head.boundary); }, solids.boundary);
    visit(patches.form, head.patches);
    visit(patches.primitive, head.patches);
    visit(solids.roles, head.primitives);
}

class SolidsReader {
  public:
    SolidsReader(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), bytes_(bytes) {}

    std::shared_ptr<const SolidScene> read() {
        check_whole();
        SavedSolids solids;
        solids.cells.voxel_m = solids.strays.voxel_m = head_.voxel_m;
        FlatPatches patches;
        const auto take = [&](auto& array, std::uint64_t count) {
            using Item = typename std::remove_reference_t<decltype(array)>::value_type;
            array.resize(count);
            if (count > 0) std::memcpy(array.data(), bytes_.data() + at_, count * sizeof(Item));
            at_ += count * sizeof(Item);
        };
        each_array(solids, patches, head_, take);
        solids.boundary.patches = patches_of(patches);
        try {
            return scene_of(std::move(solids));
        } catch (const Error& error) {
            damaged(std::string(": ") + error.what());
        }
    }

  private:
    [[noreturn]] void damaged(const std::string& why = "") const {
        fail(file_, "is damaged" + why + "; parse the scan again");
    }
    void expect(bool right) const {
        if (!right) damaged();
    }

    // Sizes and checksum, before anything is allocated.
    void check_whole() {
        const Head expected;
        if (bytes_.size() < sizeof(Head) + sizeof(Checksum::Value)) damaged();
        std::memcpy(&head_, bytes_.data(), sizeof(Head));
        if (head_.name != expected.name)
            fail(file_, "is no file of solids that this version reads; parse the scan again");
        at_ = sizeof(Head);
        std::uint64_t size = sizeof(Head) + sizeof(Checksum::Value);
        const auto add = [&](auto& array, std::uint64_t count) {
            using Item = typename std::remove_reference_t<decltype(array)>::value_type;
            expect(count <= bytes_.size());
            size += count * sizeof(Item);
        };
        SavedSolids none;
        FlatPatches patches;
        each_array(none, patches, head_, add);
        expect(size == bytes_.size());
        const std::size_t summed = bytes_.size() - sizeof(Checksum::Value);
        const Checksum::Value sum = Checksum::of(bytes_.data(), summed);
        expect(std::memcmp(&sum, bytes_.data() + summed, sizeof(sum)) == 0);
    }

    const std::filesystem::path& file_;
    std::string_view bytes_;
    Head head_;
    std::size_t at_ = 0;
};

}  // namespace

void write_solids(const std::filesystem::path& file, const SolidScene& scene) {
    const SavedSolids solids = saved(scene);
    Head head;
    head.voxel_m = scene.voxel_m();
    head.cells = solids.cells.size();
    head.below = solids.cells.unseen_below.size();
    head.strays = solids.strays.size();
    head.boundary = solids.boundary.size();
    head.patches = solids.boundary.patches.size();
    head.primitives = solids.roles.size();
    FileWriter out(file);
    Checksum sum;
    const auto put = [&](const void* bytes, std::size_t count) {
        sum.add(bytes, count);
        out.write(bytes, count);
    };
    put(&head, sizeof(head));
    const auto put_array = [&](const auto& array, std::uint64_t) {
        put(array.data(), array.size() * sizeof(array[0]));
    };
    const FlatPatches patches = flattened(solids.boundary.patches);
    each_array(solids, patches, head, put_array);
    const Checksum::Value value = sum.value();
    out.write(&value, sizeof(value));
    out.close();
}

std::shared_ptr<const SolidScene> read_solids(const FileName& name) {
    const std::filesystem::path& file = name.path();
    const FileBytes bytes = read_file(name);
    return SolidsReader(file, bytes.text()).read();
}

}  // namespace topple::io
