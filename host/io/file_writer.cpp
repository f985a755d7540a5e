// SPDX-License-Identifier: MIT
#include "io/file_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/descriptor.h"
#include "io/text.h"

namespace topple::io {
namespace {

constexpr std::size_t buffer_bytes = 1 << 20;

[[noreturn]] void can_not_write(const std::filesystem::path& file, int error) {
    fail(file, std::string("can't be written: ") + std::strerror(error) +
                   (error == ENOSPC || error == EDQUOT ? "; free some space or choose another place"
                                                       : ""));
}

// Some file systems know of no such thing.
bool has_no_sync(int error) {
    return error == EINVAL || error == EROFS || error == ENOTSUP;
}

}  // namespace

FileWriter::FileWriter(const std::filesystem::path& file) : file_(file) {
    buffer_.reserve(buffer_bytes);  // first: what throws from here on would leave the file open
    const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    descriptor_ = ::open(file.c_str(), flags, 0666);
    if (descriptor_ < 0 && errno == EEXIST) {
        struct stat status {};
        // A device or a pipe is nobody's to remove.
        if (::lstat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode) &&
            !S_ISLNK(status.st_mode))
            fail(file, "can't be written: it is no regular file");
        if (::unlink(file.c_str()) == 0) descriptor_ = ::open(file.c_str(), flags, 0666);
    }
    if (descriptor_ < 0) can_not_write(file_, errno);
}

FileWriter::~FileWriter() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void FileWriter::write(const void* bytes, std::size_t count) {
    const auto* at = static_cast<const char*>(bytes);
    while (count > 0) {
        const auto taken = std::min(count, buffer_bytes - buffer_.size());
        buffer_.insert(buffer_.end(), at, at + taken);
        at += taken;
        count -= taken;
        if (buffer_.size() == buffer_bytes) flush();
    }
}

void FileWriter::flush() {
    std::size_t done = 0;
    while (done < buffer_.size()) {
        const auto wrote = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote < 0) can_not_write(file_, errno);
        done += static_cast<std::size_t>(wrote);
    }
    buffer_.clear();
}

void FileWriter::sync() {
    flush();
    if (::fsync(descriptor_) != 0 && !has_no_sync(errno)) can_not_write(file_, errno);
}

void FileWriter::close() {
    flush();
    const int descriptor = descriptor_;
    descriptor_ = -1;
    // After EINTR the descriptor is closed all the same (Linux).
    if (::close(descriptor) != 0 && errno != EINTR) can_not_write(file_, errno);
}

void sync_folder(const std::filesystem::path& folder) {
    const Descriptor open(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (open.get() < 0 || (::fsync(open.get()) != 0 && !has_no_sync(errno)))
        can_not_write(folder, errno);
}

void write_file(const std::filesystem::path& file, std::string_view text) {
    FileWriter writer(file);
    writer.write(text);
    writer.close();
}

}  // namespace topple::io
