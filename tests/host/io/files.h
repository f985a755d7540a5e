// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "topple/error.h"

// What the tests of readers and writers share.
namespace topple::test {

// A folder of its own for each test, removed at its end.
class Files : public ::testing::Test {
  protected:
    Files() {
        // Tests write thousands of small files: in memory where the system offers that.
        const bool memory = access("/dev/shm", W_OK) == 0;
        const std::filesystem::path base =
            memory ? "/dev/shm" : std::filesystem::temp_directory_path();
        auto name = (base / "topple-test-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~Files() override {
        std::error_code error;
        std::filesystem::permissions(folder_, std::filesystem::perms::owner_all, error);
        std::filesystem::remove_all(folder_, error);
    }
    std::filesystem::path path(const std::string& name) const { return folder_ / name; }
    std::filesystem::path write(const std::string& name, std::string_view bytes) const {
        std::filesystem::create_directories(path(name).parent_path());
        std::ofstream(path(name), std::ios::binary)
            .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return path(name);
    }

    std::filesystem::path folder_;
};

inline std::string bytes_of_file(const std::filesystem::path& file) {
    std::ostringstream out;
    out << std::ifstream(file, std::ios::binary).rdbuf();
    return out.str();
}

// Appends a value in the given byte order.
template <class T>
void append(std::string& to, T value, bool big_endian = false) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big_endian != (std::endian::native == std::endian::big))
        std::reverse(bytes, bytes + sizeof(T));
    to.append(bytes, sizeof(T));
}

// The message of the Error(input) that `call` throws: one line, with every part of `parts` in it.
template <class Call>
void expect_input_error(Call call, std::initializer_list<std::string_view> parts) {
    try {
        call();
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(error.kind(), ErrorKind::input) << message;
        for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << message;
        for (const auto part : parts) {
            EXPECT_NE(message.find(part), std::string::npos) << message << "\nshould say: " << part;
        }
        return;
    }
    ADD_FAILURE() << "no error, where one should say: " << (parts.size() ? *parts.begin() : "");
}

// Steele and Vigna's splitmix64.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    std::uint64_t below(std::uint64_t limit) { return next() % limit; }

  private:
    std::uint64_t state_;
};

}  // namespace topple::test
