// SPDX-License-Identifier: MIT
#include "io/open_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <string>

namespace topple::io {
namespace fs = std::filesystem;
namespace {

bool leads_out(const fs::path& name) {
    if (name.empty() || name.is_absolute()) return true;
    for (const fs::path& part : name)
        if (part == "..") return true;
    return false;
}

}  // namespace

FileName FileName::in(const fs::path& folder, const fs::path& name) {
    FileName out(folder / name);
    out.root_ = folder.empty() ? fs::path(".") : folder;
    out.name_ = name;
    return out;
}

FileName FileName::beside(const fs::path& file, const fs::path& name) {
    FileName out = in(file.parent_path(), name);
    out.may_be_link_ = false;
    return out;
}

bool FileName::is_there() const {
    std::error_code error;
    return fs::exists(fs::symlink_status(path_, error));
}

int FileName::open(int flags) const {
    flags |= O_CLOEXEC | ((flags & O_PATH) != 0 ? 0 : O_NOCTTY);
    if (root_.empty()) return ::open(path_.c_str(), flags);
    const Descriptor root(::open(root_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (root.get() < 0) return -1;
    return open_beneath(root.get(), name_, flags, may_be_link_);
}

int open_beneath(int folder, const fs::path& name, int flags, bool links) {
    if (leads_out(name)) {
        errno = EXDEV;
        return -1;
    }
    open_how how{};
    how.flags = static_cast<std::uint64_t>(flags);
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS |
                  (links ? std::uint64_t{0} : std::uint64_t{RESOLVE_NO_SYMLINKS});
    for (int attempt = 0; attempt < 100; ++attempt) {
        const long got = ::syscall(SYS_openat2, folder, name.c_str(), &how, sizeof(how));
        if (got >= 0) return static_cast<int>(got);
        if (errno == EAGAIN || errno == EINTR) continue;  // something was renamed meanwhile
        // Kernels before 5.6 have no such call, and old filters of calls forbid it.
        if (errno == ENOSYS || errno == EPERM) return open_stepwise(folder, name, flags);
        return -1;
    }
    return -1;
}

int open_stepwise(int folder, const fs::path& name, int flags) {
    if (leads_out(name)) {
        errno = EXDEV;
        return -1;
    }
    Descriptor at(::dup(folder));
    for (const fs::path& part : name.parent_path()) {
        at = Descriptor(::openat(at.get(), part.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
        struct stat status {};
        if (at.get() < 0 || ::fstat(at.get(), &status) != 0) return -1;
        if (S_ISLNK(status.st_mode)) {
            errno = ELOOP;
            return -1;
        }
    }
    const fs::path last = name.has_filename() ? name.filename() : fs::path(".");
    return ::openat(at.get(), last.c_str(), flags | O_NOFOLLOW);
}

std::string why_not_opened(int error) {
    if (error == EXDEV)
        return "is a link, or lies behind one, that leads out of its folder; only what lies there "
               "is read: put a copy in its place";
    if (error == ELOOP)
        return "is a link, or lies behind one, that is not followed; put a copy of what it leads "
               "to in its place";
    return std::string("can't be read: ") + std::strerror(error);
}

// Opening a FIFO without O_NONBLOCK would wait for a writer.
OpenFile::OpenFile(const FileName& file)
    : name(file), descriptor(file.open(O_RDONLY | O_NONBLOCK)) {
    struct stat status {};
    if (descriptor.get() < 0 || ::fstat(descriptor.get(), &status) != 0)
        fail(file.path(), why_not_opened(errno));
    if (!S_ISREG(status.st_mode)) {
        fail(file.path(),
             S_ISDIR(status.st_mode) ? "is a folder, not a file" : "is not a regular file");
    }
    size = static_cast<std::uint64_t>(status.st_size);
}

std::size_t OpenFile::read(char* into, std::size_t bytes) const {
    std::size_t done = 0;
    while (done < bytes) {
        const auto got = ::read(descriptor.get(), into + done, bytes - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(name.path(), std::string("can't be read: ") + std::strerror(errno));
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

FileBytes read_file(const FileName& name, std::uint64_t limit) {
    const OpenFile open(name);
    const fs::path& file = name.path();
    if (open.size == 0) fail(file, "is empty (0 bytes)");
    if (open.size > limit) {
        fail(file, "has " + counted(open.size, "byte") + ", more than the " +
                       std::to_string(limit) + " that such a file may have");
    }
    FileBytes bytes;
    try {
        bytes.data = std::make_unique_for_overwrite<char[]>(open.size);
    } catch (const std::bad_alloc&) {
        fail(file, "has " + counted(open.size, "byte") + ", which don't fit into memory");
    }
    bytes.size = open.read(bytes.data.get(), open.size);
    if (bytes.size < open.size) {
        fail(file, "shrank while it was read: " + counted(open.size, "byte") + " expected, " +
                       std::to_string(bytes.size) + " found");
    }
    return bytes;
}

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

std::vector<std::string> folder_names(const FileName& folder, std::error_code& error) {
    error.clear();
    const auto close = [](DIR* open) { ::closedir(open); };
    Descriptor descriptor(folder.open(O_RDONLY | O_DIRECTORY));
    const std::unique_ptr<DIR, decltype(close)> open(
        descriptor.get() < 0 ? nullptr : ::fdopendir(descriptor.get()), close);
    std::vector<std::string> names;
    if (!open) {
        error.assign(errno, std::generic_category());
        return names;
    }
    descriptor.release();  // the listing closes it
    for (;;) {
        errno = 0;
        const dirent* entry = ::readdir(open.get());
        if (!entry) break;
        std::string name = entry->d_name;
        if (name != "." && name != "..") names.push_back(std::move(name));
    }
    if (errno != 0) error.assign(errno, std::generic_category());
    return names;
}

}  // namespace topple::io
