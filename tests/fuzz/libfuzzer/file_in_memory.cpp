// SPDX-License-Identifier: MIT
#include "fuzz/libfuzzer/file_in_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstdarg>

namespace {

constexpr int descriptor = 1 << 20;  // beyond what a process may have

struct {
    const char* path = "";
    std::string_view bytes;
    std::size_t read = 0;
} shown;

}  // namespace

namespace topple::fuzz {

void show_file(const char* path, std::string_view bytes) {
    shown = {path, bytes, 0};
}

}  // namespace topple::fuzz

// What --wrap=NAME calls instead of NAME, and the NAME that it hides.
extern "C" {

int __real_open(const char* path, int flags, mode_t mode);
int __real_fstat(int file, struct stat* status);
ssize_t __real_read(int file, void* out, size_t size);
int __real_close(int file);
void* __real_mmap(void* at, size_t size, int protection, int flags, int file, off_t offset);
int __real_madvise(void* at, size_t size, int advice);
int __real_munmap(void* at, size_t size);

int __wrap_open(const char* path, int flags, ...) {
    if (std::strcmp(path, shown.path) == 0) {
        shown.read = 0;
        return descriptor;
    }
    std::va_list rest;
    va_start(rest, flags);
    const auto mode = flags & O_CREAT ? static_cast<mode_t>(va_arg(rest, int)) : mode_t{0};
    va_end(rest);
    return __real_open(path, flags, mode);
}

int __wrap_fstat(int file, struct stat* status) {
    if (file != descriptor) return __real_fstat(file, status);
    *status = {};
    status->st_mode = S_IFREG | 0600;
    status->st_size = static_cast<off_t>(shown.bytes.size());
    return 0;
}

ssize_t __wrap_read(int file, void* out, size_t size) {
    if (file != descriptor) return __real_read(file, out, size);
    const std::size_t taken = std::min(size, shown.bytes.size() - shown.read);
    std::memcpy(out, shown.bytes.data() + shown.read, taken);
    shown.read += taken;
    return static_cast<ssize_t>(taken);
}

// Read only, so that the bytes need not be copied.
void* __wrap_mmap(void* at, size_t size, int protection, int flags, int file, off_t offset) {
    if (file != descriptor) return __real_mmap(at, size, protection, flags, file, offset);
    return const_cast<char*>(shown.bytes.data());
}

int __wrap_madvise(void* at, size_t size, int advice) {
    return at == shown.bytes.data() ? 0 : __real_madvise(at, size, advice);
}

int __wrap_munmap(void* at, size_t size) {
    return at == shown.bytes.data() ? 0 : __real_munmap(at, size);
}

int __wrap_close(int file) {
    return file == descriptor ? 0 : __real_close(file);
}

}  // extern "C"
