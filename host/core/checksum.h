// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace topple {

// XXH3, 128 bits, of bytes that come piece by piece: tells damage, not forgery.
class Checksum {
  public:
    using Value = std::array<std::uint64_t, 2>;

    Checksum();
    ~Checksum();
    Checksum(const Checksum&) = delete;
    Checksum& operator=(const Checksum&) = delete;

    void add(const void* bytes, std::size_t count);
    Value value() const;

    static Value of(const void* bytes, std::size_t count);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace topple
