// SPDX-License-Identifier: MIT
#include "io/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "io/text.h"

namespace topple::io {

MappedFile::MappedFile(const std::filesystem::path& file) {
    // Opening a FIFO without O_NONBLOCK would wait for a writer.
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat status {};
    if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
        const int reason = errno;
        if (descriptor >= 0) ::close(descriptor);
        fail(file, std::string("can't be read: ") + std::strerror(reason));
    }
    if (!S_ISREG(status.st_mode) || status.st_size == 0) {
        ::close(descriptor);
        fail(file, S_ISREG(status.st_mode) ? "is empty (0 bytes)" : "is not a regular file");
    }
    size_ = static_cast<std::size_t>(status.st_size);
    void* const at = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
    const int reason = errno;
    ::close(descriptor);
    if (at == MAP_FAILED) fail(file, std::string("can't be mapped: ") + std::strerror(reason));
    ::madvise(at, size_, MADV_SEQUENTIAL);
    data_ = static_cast<const char*>(at);
}

MappedFile::~MappedFile() {
    ::munmap(const_cast<char*>(data_), size_);
}

void MappedFile::release() const {
    ::madvise(const_cast<char*>(data_), size_, MADV_DONTNEED);
}

}  // namespace topple::io
