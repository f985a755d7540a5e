// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/checksum.h"
#include "core/fields.h"
#include "io/file_writer.h"
#include "io/text.h"

// Files of the work folder: fields (core/fields.h) between a mark that says whose they are and a
// checksum. They are ours, but a run may have been killed while it
// wrote them, or a disk may have turned a bit: what is read is what was written, or is refused.
namespace topple::tiles {

// Every file of the work folder but its manifest and its lock begins with this.
inline constexpr std::string_view file_mark = "topple.w";

inline constexpr const char* work_file_fault =
    "is damaged or cut short; the same command makes it anew";
[[noreturn]] inline void damaged_file(const std::filesystem::path& file) {
    io::fail(file, work_file_fault);
}

// For the work folder and others that only topple writes into. Writes beside the file and renames:
// it is there whole or not at all, after a loss of power, too.
class BinaryWriter : public FieldWriter<BinaryWriter> {
  public:
    explicit BinaryWriter(std::filesystem::path file)
        : file_(std::move(file)), part_(file_.native() + ".part"), writer_(part_) {
        put(file_mark.data(), file_mark.size());
    }
    // durable: whether it must be there after a loss of power.
    void finish(bool durable = true) {
        const Checksum::Value sum = sum_.value();
        writer_.write(&sum, sizeof(sum));
        if (durable) writer_.sync();
        writer_.close();
        std::error_code error;
        std::filesystem::rename(part_, file_, error);
        if (error) io::fail(file_, "can't be written: " + error.message());
        if (durable) io::sync_folder(file_.parent_path());
    }

  private:
    friend FieldWriter<BinaryWriter>;
    void put(const void* bytes, std::size_t count) {
        writer_.write(bytes, count);
        sum_.add(bytes, count);
    }

    std::filesystem::path file_, part_;
    io::FileWriter writer_;
    Checksum sum_;
};

class BinaryReader : public FieldReader<BinaryReader> {
  public:
    // fault: what is said of a file that isn't what was written.
    explicit BinaryReader(const std::filesystem::path& file, const char* fault = work_file_fault)
        : file_(file), fault_(fault), bytes_(io::read_file(file)), rest_(bytes_.text()) {
        Checksum::Value sum;
        if (rest_.size() < file_mark.size() + sizeof(sum) || !rest_.starts_with(file_mark))
            damaged();
        const std::size_t summed = rest_.size() - sizeof(sum);
        std::memcpy(&sum, rest_.data() + summed, sizeof(sum));
        if (Checksum::of(rest_.data(), summed) != sum) damaged();
        rest_ = rest_.substr(0, summed).substr(file_mark.size());
    }
    [[noreturn]] void damaged() const { io::fail(file_, fault_); }

  private:
    friend FieldReader<BinaryReader>;
    std::uint64_t left() const { return rest_.size(); }
    [[noreturn]] void refuse() const { damaged(); }
    const std::byte* take(std::uint64_t count, std::size_t each) {
        if (count > left() / each) refuse();
        const char* from = rest_.data();
        rest_.remove_prefix(count * each);
        return reinterpret_cast<const std::byte*>(from);
    }
    void taken() const {}

    std::filesystem::path file_;
    const char* fault_;
    io::FileBytes bytes_;
    std::string_view rest_;
};

// A file too large to be held whole: portions, each with a checksum that another file keeps.
class PortionWriter {
  public:
    using Sum = std::uint64_t;

    explicit PortionWriter(const std::filesystem::path& file) : writer_(file) {
        writer_.write(file_mark);
    }
    template <class T>
    Sum add(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        writer_.write(values.data(), values.size() * sizeof(T));
        return sum_of(values);
    }
    void finish() {
        writer_.sync();
        writer_.close();
    }
    template <class T>
    static Sum sum_of(const std::vector<T>& values) {
        return Checksum::of(values.data(), values.size() * sizeof(T))[0];
    }

  private:
    io::FileWriter writer_;
};

class PortionReader {
  public:
    explicit PortionReader(const std::filesystem::path& file) : file_(file) {
        stream_.open(file, std::ios::binary);
    }
    // Fills `values` with those that come after `before` others.
    template <class T>
    void read(std::uint64_t before, PortionWriter::Sum sum, std::vector<T>& values) {
        stream_.seekg(static_cast<std::streamoff>(file_mark.size() + before * sizeof(T)));
        stream_.read(reinterpret_cast<char*>(values.data()),
                     static_cast<std::streamsize>(values.size() * sizeof(T)));
        if (!stream_ || PortionWriter::sum_of(values) != sum) damaged_file(file_);
    }
    // Whether the file holds that many values and no more.
    template <class T>
    static bool holds(const std::filesystem::path& file, std::uint64_t values) {
        std::error_code error;
        const auto size = std::filesystem::file_size(file, error);
        std::ifstream stream(file, std::ios::binary);
        char mark[file_mark.size()];
        return !error && size == file_mark.size() + values * sizeof(T) &&
               stream.read(mark, sizeof(mark)) && file_mark == std::string_view(mark, sizeof(mark));
    }

  private:
    std::filesystem::path file_;
    std::ifstream stream_;
};

}  // namespace topple::tiles
