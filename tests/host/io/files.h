// SPDX-License-Identifier: MIT
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include "errors.h"
#include "topple/kernel_testing/random.h"

// What the tests of readers and writers share.
namespace topple::test {

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

// Bytes that `read` refuses with an Error(input), and what its message says.
struct BadFile {
    std::string bytes;
    std::vector<std::string_view> says;
};

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

    // Each, as the file `name`, is refused by a message that names the file and says what it
    // should.
    template <class Bad, class Read>
    void expect_refused(const std::string& name, const Bad& files, Read read) const {
        for (const auto& bad : files) {
            SCOPED_TRACE(bad.bytes.substr(0, 400));
            const auto file = write(name, bad.bytes);
            expect_input_error([&] { read(file); }, {name});
            expect_input_error([&] { read(file); }, bad.says);
        }
    }

    std::filesystem::path folder_;
};

}  // namespace topple::test
