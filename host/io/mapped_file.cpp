// SPDX-License-Identifier: MIT
#include "io/mapped_file.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "io/text.h"

namespace topple::io {

MappedFile::MappedFile(const FileName& name) {
    const OpenFile open(name);
    if (open.size == 0) fail(name.path(), "is empty (0 bytes)");
    size_ = static_cast<std::size_t>(open.size);
    void* const at = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, open.descriptor.get(), 0);
    if (at == MAP_FAILED)
        fail(name.path(), std::string("can't be mapped: ") + std::strerror(errno));
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
