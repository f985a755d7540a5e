// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace topple::io {

// Writes one new file through a buffer and notices every error, at the latest in close(): a full
// disk may show only then. For folders that nobody else writes into, such as a StagingFolder: what
// had the name before goes, a link itself and not what it leads to. Errors are Error(input) that
// name the file and the system's reason.
class FileWriter {
  public:
    explicit FileWriter(const std::filesystem::path& file);
    ~FileWriter();  // closes without a check, for the way out after an error
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;

    void write(const void* bytes, std::size_t count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    // What was written so far outlives a loss of power from here on.
    void sync();
    void close();

  private:
    void flush();

    std::filesystem::path file_;
    std::vector<char> buffer_;
    int descriptor_ = -1;
};

// So does a file's name, and that another one is gone.
void sync_folder(const std::filesystem::path& folder);

// Writes a whole file.
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace topple::io
