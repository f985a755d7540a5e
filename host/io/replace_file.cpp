// SPDX-License-Identifier: MIT
#include "io/replace_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "io/file_writer.h"
#include "io/text.h"

namespace topple::io {
namespace fs = std::filesystem;
namespace {

// After the check, which tells more than a folder where nothing can be made.
const fs::path& checked(const fs::path& file) {
    check_replaceable_file(file);
    return file;
}

}  // namespace

PendingFile::PendingFile(const fs::path& file)
    : file_(checked(file)), staging_(file.has_parent_path() ? file.parent_path() : fs::path(".")) {}

void PendingFile::commit() {
    check_replaceable_file(file_);
    if (std::rename(path().c_str(), file_.c_str()) != 0)
        fail(file_, std::string("can't be written: ") + std::strerror(errno));
}

void replace_file(const fs::path& file, std::string_view text) {
    PendingFile pending(file);
    write_file(pending.path(), text);
    pending.commit();
}

void check_replaceable_file(const fs::path& file) {
    if (!file.has_filename()) fail(file, "can't be written: it is no file's name");
    struct stat status {};
    if (::lstat(file.c_str(), &status) != 0) {
        if (errno == ENOENT) return;
        fail(file, std::string("can't be written: ") + std::strerror(errno));
    }
    if (S_ISREG(status.st_mode)) return;
    const char* const what = S_ISLNK(status.st_mode)   ? "a link"
                             : S_ISDIR(status.st_mode) ? "a folder"
                                                       : "no regular file";
    fail(file, std::string("is ") + what +
                   ", which topple did not write; move it away or choose another name");
}

std::string beginning_of(const fs::path& file, std::size_t bytes) {
    std::string out(bytes, '\0');
    try {
        out.resize(OpenFile(FileName::beside(file, file.filename())).read(out.data(), bytes));
    } catch (const Error&) {
        out.clear();
    }
    return out;
}

void check_own_file(const fs::path& file, std::string_view mark, const char* what) {
    check_replaceable_file(file);
    std::error_code error;
    if (!fs::exists(file, error) || fs::is_empty(file, error)) return;
    if (beginning_of(file, 1024).find(mark) == std::string::npos)
        fail(file, std::string("exists and ").append(what));
}

}  // namespace topple::io
