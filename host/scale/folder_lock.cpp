// SPDX-License-Identifier: MIT
#include "scale/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "io/text.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

// " (process 123)", as the lock's owner has left it; empty where it has not yet.
std::string owner_of(int descriptor) {
    std::array<char, 24> text{};
    const auto got = ::pread(descriptor, text.data(), text.size() - 1, 0);
    std::uint64_t pid = 0;
    const std::string_view first(text.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
    if (!io::parse_count(first.substr(0, first.find('\n')), pid)) return "";
    return " (process " + std::to_string(pid) + ")";
}

// Whether the file that is open is still the one of that name: who has let go of the lock may have
// removed it.
bool is_there(int descriptor, const fs::path& file) {
    struct stat open {
    }, named{};
    return ::fstat(descriptor, &open) == 0 && ::lstat(file.c_str(), &named) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) {
    const fs::path file = folder / file_name;
    const std::string pid = std::to_string(::getpid()) + "\n";
    for (;;) {
        descriptor_ =
            io::Descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
        if (descriptor_.get() < 0)
            io::fail(file, std::string("can't be written: ") + std::strerror(errno));
        // Where the file system has no locks, there is none.
        if (::flock(descriptor_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            io::fail(folder, "another run" + owner_of(descriptor_.get()) +
                                 " is at work there; wait for its end, or choose another output "
                                 "folder");
        }
        if (is_there(descriptor_.get(), file)) break;
    }
    const bool told =
        ::ftruncate(descriptor_.get(), 0) == 0 &&
        ::pwrite(descriptor_.get(), pid.data(), pid.size(), 0) == static_cast<ssize_t>(pid.size());
    if (!told) io::fail(file, std::string("can't be written: ") + std::strerror(errno));
}

}  // namespace topple::tiles
