// SPDX-License-Identifier: MIT
#include "vdb/archive.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <ios>
#include <string>
#include <vector>

#include "core/checksum.h"
#include "io/file_writer.h"
#include "topple/error.h"

namespace topple::vdb {
namespace {

[[noreturn]] void can_not_write(const std::filesystem::path& path, int reason) {
    throw Error(ErrorKind::input, path.string() + ": can't be written: " +
                                      (reason != 0 ? std::strerror(reason) : "the stream failed") +
                                      (reason == ENOSPC || reason == EDQUOT
                                           ? "; free some space or choose another place"
                                           : ""));
}

// What OpenVDB's own File writes, to a stream that throws at the first failure: File checks none,
// and goes on with offsets that a failed write has left undefined. Nothing is packed but the runs
// of equal values, and there is no table of leaves for delayed loading: where memory is short,
// Blosc ends the program and zlib's failure is passed over.
class CheckedArchive : public openvdb::io::Archive {
  public:
    CheckedArchive() { setCompression(openvdb::io::COMPRESS_ACTIVE_MASK); }

    void write_to(std::ostream& out, const openvdb::GridPtrVec& grids,
                  const openvdb::MetaMap& meta) const {
        writeHeader(out, /*seekable=*/true);
        meta.writeMeta(out);
        const auto count = static_cast<std::int32_t>(grids.size());
        out.write(reinterpret_cast<const char*>(&count), sizeof count);
        for (const auto& grid : grids) write_grid(out, *grid);
    }

  private:
    void write_grid(std::ostream& out, openvdb::GridBase& grid) const {
        openvdb::io::setDataCompression(out, compression());
        openvdb::io::GridDescriptor about(grid.getName(), grid.type(), grid.saveFloatAsHalf());
        about.writeHeader(out);
        const auto offsets = out.tellp();
        about.writeStreamPos(out);
        about.setGridPos(out.tellp());
        setGridCompression(out, grid);
        grid.addStatsMetadata();
        grid.insertMeta(openvdb::GridBase::META_FILE_COMPRESSION,
                        openvdb::StringMetadata(openvdb::io::compressionToString(compression())));
        grid.writeMeta(out);
        grid.writeTransform(out);
        grid.writeTopology(out);
        about.setBlockPos(out.tellp());
        grid.writeBuffers(out);
        about.setEndPos(out.tellp());
        out.seekp(offsets);
        about.writeStreamPos(out);
        about.seekToEnd(out);
    }
};

// Where the file's UUID stands, which OpenVDB draws by chance: after the magic number (8 bytes),
// three version numbers (4 each) and a flag.
constexpr std::streamoff uuid_at = 21;
constexpr std::size_t uuid_length = 36;

// The file's checksum as a UUID, of version 8 (RFC 9562: made by a rule of one's own).
std::string as_uuid(const Checksum::Value& sum) {
    const std::uint64_t high = (sum[1] & ~0xf000ULL) | 0x8000ULL,
                        low = (sum[0] & ~(3ULL << 62)) | (1ULL << 63);
    std::array<char, uuid_length + 1> text{};
    std::snprintf(text.data(), text.size(), "%08x-%04x-%04x-%04x-%012llx",
                  static_cast<unsigned>(high >> 32), static_cast<unsigned>(high >> 16 & 0xffff),
                  static_cast<unsigned>(high & 0xffff), static_cast<unsigned>(low >> 48),
                  static_cast<unsigned long long>(low & 0xffffffffffffULL));
    return text.data();
}

// Gives the file a UUID that follows from all else in it, so that equal volumes are equal files.
void make_reproducible(const std::filesystem::path& path) {
    errno = 0;
    try {
        std::fstream file;
        file.exceptions(std::ios::failbit | std::ios::badbit);
        file.open(path, std::ios::binary | std::ios::in | std::ios::out);
        const std::string none(uuid_length, '0');
        file.seekp(uuid_at).write(none.data(), uuid_length);
        file.seekg(0, std::ios::end);
        auto left = static_cast<std::uint64_t>(file.tellg());
        file.seekg(0);
        Checksum sum;
        for (std::vector<char> piece(1 << 20); left > 0;) {
            const auto count = std::min<std::uint64_t>(left, piece.size());
            file.read(piece.data(), static_cast<std::streamsize>(count));
            sum.add(piece.data(), count);
            left -= count;
        }
        file.seekp(uuid_at).write(as_uuid(sum.value()).data(), uuid_length);
        file.close();
    } catch (const std::ios_base::failure&) {
        can_not_write(path, errno);
    }
}

}  // namespace

openvdb::math::Transform::Ptr transform_of(const Vec3& corner_m, const std::array<Vec3, 3>& along) {
    // OpenVDB multiplies row vectors from the left: world = index * M. Its index (i, j, k) is the
    // cell's middle already, ours its corner.
    openvdb::Mat4d m = openvdb::Mat4d::identity();
    for (int a = 0; a < 3; ++a) {
        for (int d = 0; d < 3; ++d) m(a, d) = along[a][d];
    }
    for (int d = 0; d < 3; ++d) m(3, d) = 0.5 * (m(0, d) + m(1, d) + m(2, d)) + corner_m[d];
    return openvdb::math::Transform::createLinearTransform(m);
}

void describe(openvdb::GridBase& grid, const std::string& name,
              const openvdb::math::Transform::Ptr& transform, double voxel_m) {
    grid.setName(name);
    grid.setTransform(transform);
    grid.setCreator("topple");
    grid.insertMeta("voxel_size_m", openvdb::DoubleMetadata(voxel_m));
}

openvdb::MetaMap about_file(const std::string& schema) {
    openvdb::MetaMap meta;
    meta.insertMeta("creator", openvdb::StringMetadata("topple"));
    meta.insertMeta("topple_schema", openvdb::StringMetadata(schema));
    return meta;
}

void write_archive(const std::filesystem::path& path, const openvdb::GridPtrVec& grids,
                   const openvdb::MetaMap& meta) {
    errno = 0;
    try {
        std::ofstream out;
        out.exceptions(std::ios::failbit | std::ios::badbit);
        io::write_file(path, "");  // a new file, whatever had its name
        out.open(path, std::ios::binary | std::ios::trunc);
        CheckedArchive().write_to(out, grids, meta);
        out.close();
        make_reproducible(path);
    } catch (const std::ios_base::failure&) {
        can_not_write(path, errno);
    } catch (const openvdb::Exception& error) {
        throw Error(ErrorKind::input, path.string() + ": can't be written: " + error.what());
    }
}

}  // namespace topple::vdb
