// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/file_writer.h"
#include "io/text.h"

// Files of the work folder: arrays of plain values in this machine's byte order. They are ours, but
// a run may have been killed while it wrote them, so that lengths are checked all the same.
namespace topple::tiles {

// Writes beside the file and renames: it is there whole or not at all.
class BinaryWriter {
  public:
    explicit BinaryWriter(std::filesystem::path file)
        : file_(std::move(file)), part_(file_.native() + ".part"), writer_(part_) {}
    template <class T>
    void value(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        writer_.write(&v, sizeof(T));
    }
    template <class T>
    void array(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        value(static_cast<std::uint64_t>(values.size()));
        writer_.write(values.data(), values.size() * sizeof(T));
    }
    void finish() {
        writer_.close();
        std::filesystem::rename(part_, file_);
    }

  private:
    std::filesystem::path file_, part_;
    io::FileWriter writer_;
};

class BinaryReader {
  public:
    explicit BinaryReader(const std::filesystem::path& file)
        : file_(file), bytes_(io::read_file(file)), rest_(bytes_.text()) {}
    template <class T>
    T value() {
        T v;
        take(&v, sizeof(T));
        return v;
    }
    template <class T>
    std::vector<T> array() {
        const auto count = value<std::uint64_t>();
        if (count > rest_.size() / sizeof(T)) damaged();
        std::vector<T> values(count);
        take(values.data(), count * sizeof(T));
        return values;
    }
    [[noreturn]] void damaged() const {
        io::fail(file_, "is damaged or cut short; remove its folder and start again");
    }

  private:
    void take(void* to, std::size_t size) {
        if (size > rest_.size()) damaged();
        if (size > 0) std::memcpy(to, rest_.data(), size);
        rest_.remove_prefix(size);
    }

    std::filesystem::path file_;
    io::FileBytes bytes_;
    std::string_view rest_;
};

}  // namespace topple::tiles
