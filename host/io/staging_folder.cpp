// SPDX-License-Identifier: MIT
#include "io/staging_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "io/open_file.h"
#include "io/pending_outputs.h"
#include "io/text.h"

namespace topple::io {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view prefix = ".topple-", mark = "topple staging folder\n";

// 50 bits that nobody can guess.
std::string random_name() {
    std::array<unsigned char, 10> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        throw Error(ErrorKind::input, "the system gives no random numbers");
    std::string name(prefix);
    for (const unsigned char byte : bytes) name += "abcdefghijklmnopqrstuvwxyz234567"[byte % 32];
    return name;
}

// Whether the folder is one of ours, and no process is at work in it: its lock is taken then.
bool is_abandoned(int folder, Descriptor& lock) {
    struct stat status {};
    if (::fstat(folder, &status) != 0 || status.st_uid != ::geteuid() ||
        (status.st_mode & 077) != 0)
        return false;
    lock = Descriptor(::openat(folder, staging_lock, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (lock.get() < 0 || ::fstat(lock.get(), &status) != 0 || !S_ISREG(status.st_mode) ||
        status.st_uid != ::geteuid() || ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0)
        return false;
    // Its maker writes the mark once it has the lock.
    std::array<char, mark.size()> text{};
    return ::pread(lock.get(), text.data(), text.size(), 0) == static_cast<ssize_t>(mark.size()) &&
           std::string_view(text.data(), text.size()) == mark;
}

}  // namespace

void remove_abandoned(const fs::path& where) {
    std::error_code error;
    for (const std::string& name : folder_names(where, error)) {
        if (!name.starts_with(prefix)) continue;
        const Descriptor folder(
            FileName::in(where, name).open(O_RDONLY | O_DIRECTORY | O_NOFOLLOW));
        Descriptor lock;
        if (folder.get() >= 0 && is_abandoned(folder.get(), lock))
            remove_tree((where / name).c_str());
    }
}

StagingFolder::StagingFolder(const fs::path& where, int parents) {
    std::error_code error;
    const fs::path whole = fs::absolute(where, error);  // whoever moves to another folder meanwhile
    remove_abandoned(where);
    do {
        path_ = (error ? where : whole) / random_name();
        const fs::path lock_file = path_ / staging_lock;  // before there is a folder to leave
        // First noted, then made: a signal may come between.
        slot_ = add_pending(path_, parents);
        if (::mkdir(path_.c_str(), 0700) == 0) {
            lock(lock_file);
            return;
        }
        const int reason = errno;
        forget_pending(slot_);
        errno = reason;
    } while (errno == EEXIST);
    fail(where, std::string("can't be written to: ") + std::strerror(errno) +
                    "; choose another place for the output");
}

void StagingFolder::lock(const fs::path& file) {
    const int flags = O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    lock_ = Descriptor(::open(file.c_str(), flags, 0600));
    // Where the file system has no locks, nobody takes it for abandoned, either.
    if (lock_.get() >= 0 && (::flock(lock_.get(), LOCK_EX) == 0 || errno != EINTR) &&
        ::write(lock_.get(), mark.data(), mark.size()) == static_cast<ssize_t>(mark.size()))
        return;
    const int reason = errno;
    remove_tree(path_.c_str());
    forget_pending(slot_);
    fail(path_.parent_path(), std::string("can't be written to: ") + std::strerror(reason) +
                                  "; free some space or choose another place for the output");
}

StagingFolder StagingFolder::temporary() {
    std::error_code error;
    const fs::path where = fs::temp_directory_path(error);
    return StagingFolder(error ? fs::path("/tmp") : where);
}

StagingFolder::StagingFolder(StagingFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      lock_(std::move(other.lock_)),
      slot_(std::exchange(other.slot_, -1)) {}

StagingFolder::~StagingFolder() {
    if (path_.empty()) return;
    lock_ = Descriptor();  // one more to look into the folder by, where there are few
    remove_tree(path_.c_str());
    forget_pending(slot_);
}

}  // namespace topple::io
