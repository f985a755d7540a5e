// SPDX-License-Identifier: MIT
#include "child/message.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace topple::child {
namespace {

constexpr std::size_t piece_bytes = 1 << 16;

void write_all(int descriptor, const char* data, std::size_t size) {
    while (size > 0) {
        const auto put = ::write(descriptor, data, size);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) std::_Exit(1);  // the answer stays without its head
        data += put;
        size -= static_cast<std::size_t>(put);
    }
}

}  // namespace

Writer::Writer(int descriptor) : descriptor_(descriptor) {
    if (::ftruncate(descriptor_, answer_head) != 0 ||
        ::lseek(descriptor_, answer_head, SEEK_SET) != answer_head)
        std::_Exit(1);
}

void Writer::put(const void* data, std::size_t size) {
    if (waiting_.size() + size > piece_bytes) flush();
    if (size > piece_bytes) return write_all(descriptor_, static_cast<const char*>(data), size);
    waiting_.append(static_cast<const char*>(data), size);
}

void Writer::flush() {
    write_all(descriptor_, waiting_.data(), waiting_.size());
    waiting_.clear();
}

void Writer::finish() {
    flush();
    end_of_answer(descriptor_);
}

}  // namespace topple::child
