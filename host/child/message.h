// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "child/process.h"

// Answers as fields in a row. Writer and Reader take the same calls, so that one function lists a
// type's fields for both sides.
namespace topple::child {

// Thrown where an answer is not what a child of this version writes.
struct BadAnswer {};

template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>;

// Writes an answer, by pieces.
class Writer {
  public:
    explicit Writer(int descriptor = answer_descriptor);
    template <Plain T>
    void operator()(const T& value) {
        write(&value, sizeof(value));
    }
    void operator()(bool value) { (*this)(static_cast<std::uint8_t>(value)); }
    void operator()(const std::string& text) {
        (*this)(static_cast<std::uint64_t>(text.size()));
        write(text.data(), text.size());
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        if constexpr (Plain<T>) {
            write(values.data(), values.size() * sizeof(T));
        } else {
            for (const T& value : values) (*this)(value);
        }
    }
    // Nothing comes after.
    void finish();

  private:
    void write(const void* data, std::size_t size);
    void flush();
    int descriptor_;
    std::string waiting_;
};

class Reader {
  public:
    explicit Reader(const Answer& answer) : answer_(answer), bytes_(answer.bytes()) {}
    template <Plain T>
    void operator()(T& value) {
        std::memcpy(&value, take(1, sizeof(value)), sizeof(value));
    }
    void operator()(bool& value) {
        std::uint8_t byte = 0;
        (*this)(byte);
        if (byte > 1) throw BadAnswer();
        value = byte != 0;
    }
    void operator()(std::string& text) {
        const std::uint64_t size = count();
        text.assign(reinterpret_cast<const char*>(take(size, 1)), size);
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        const std::uint64_t size = count();
        values.clear();
        if constexpr (Plain<T>) {
            const std::byte* from = take(size, sizeof(T));
            values.resize(size);
            if (size > 0) std::memcpy(values.data(), from, size * sizeof(T));
            answer_.release(at_);
        } else {
            for (std::uint64_t n = 0; n < size; ++n) (*this)(values.emplace_back());
        }
    }
    // Throws where something comes after.
    void finish() const {
        if (at_ != bytes_.size()) throw BadAnswer();
    }

  private:
    std::uint64_t count() {
        std::uint64_t size = 0;
        (*this)(size);
        if (size > bytes_.size()) throw BadAnswer();  // each takes a byte at least
        return size;
    }
    const std::byte* take(std::uint64_t count, std::size_t each) {
        if (count > (bytes_.size() - at_) / each) throw BadAnswer();
        const std::byte* from = bytes_.data() + at_;
        at_ += count * each;
        return from;
    }

    const Answer& answer_;
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

}  // namespace topple::child
