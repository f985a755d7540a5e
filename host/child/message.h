// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "child/process.h"
#include "core/fields.h"

// Answers as fields in a row.
namespace topple::child {

// Thrown where an answer is not what a child of this version writes.
struct BadAnswer {};

// Writes an answer, by pieces.
class Writer : public FieldWriter<Writer> {
  public:
    explicit Writer(int descriptor = answer_descriptor);
    // Nothing comes after.
    void finish();

  private:
    friend FieldWriter<Writer>;
    void put(const void* data, std::size_t size);
    void flush();
    int descriptor_;
    std::string waiting_;
};

class Reader : public FieldReader<Reader> {
  public:
    explicit Reader(const Answer& answer) : answer_(answer), bytes_(answer.bytes()) {}
    // Throws where something comes after.
    void finish() const {
        if (left() != 0) refuse();
    }

  private:
    friend FieldReader<Reader>;
    std::uint64_t left() const { return bytes_.size() - at_; }
    [[noreturn]] static void refuse() { throw BadAnswer(); }
    const std::byte* take(std::uint64_t count, std::size_t each) {
        if (count > left() / each) refuse();
        const std::byte* from = bytes_.data() + at_;
        at_ += count * each;
        return from;
    }
    void taken() const { answer_.release(at_); }

    const Answer& answer_;
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

}  // namespace topple::child
