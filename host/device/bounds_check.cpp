// SPDX-License-Identifier: MIT
#include "device/bounds_check.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "topple/error.h"
#include "topple/kernels/buffer.h"

namespace topple::device {
namespace {

// A dispatch's part of the hidden buffer, in words: the report, as kernels/dialect/*/checks.* write
// it, then the number of elements of each binding.
enum : std::uint64_t { word_found, word_access, word_who, word_index, first_elements };
constexpr std::uint64_t part_words = slice_alignment / 4;
// Of word_access, below the binding's number.
constexpr std::uint32_t writes = 1, of_group = 2, binding_shift = 2;

// spare: what is bound where a range is empty, as an access outside is one of element 0 instead.
void add_checks(Dispatch& dispatch, std::span<std::uint32_t> words, const BoundRange& part,
                const BoundRange& spare) {
    const KernelSource& kernel = *dispatch.kernel;
    if (!kernel.checked)
        throw Error(ErrorKind::device, std::string("TOPPLE_CHECK=bounds: kernel ") + kernel.name +
                                           " was built without its checked form; configure the "
                                           "build with -DTOPPLE_CHECKED_KERNELS=ON");
    if (first_elements + dispatch.ranges.size() > words.size())
        throw Error(ErrorKind::device,
                    std::string("TOPPLE_CHECK=bounds: kernel ") + kernel.name + " has more than " +
                        std::to_string(words.size() - first_elements) + " buffers");
    for (std::size_t b = 0; b < dispatch.ranges.size(); ++b) {
        BoundRange& range = dispatch.ranges[b];
        words[first_elements + b] = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(range.bytes / kernel.bindings[b].element_bytes, 0xffffffffu));
        if (range.bytes == 0) range = spare;
    }
    dispatch.kernel = kernel.checked;
    dispatch.ranges.push_back(part);
}

std::string index_text(std::uint32_t index, std::uint32_t elements) {
    constexpr std::uint32_t most = 0x7fffffff;
    return index > most && elements <= most ? std::to_string(static_cast<std::int32_t>(index))
                                            : std::to_string(index);
}

void throw_if_found(const KernelSource& kernel, std::span<const std::uint32_t> words) {
    if (words[word_found] == 0) return;
    const std::uint32_t access = words[word_access], binding = access >> binding_shift;
    const std::uint32_t elements = words[first_elements + binding];
    const std::string buffer = kernel.bindings[binding].name;
    throw Error(ErrorKind::device,
                std::string("kernel ") + kernel.name +
                    (access & of_group ? ": work-group " : ": work-item ") +
                    std::to_string(words[word_who]) + (access & writes ? " writes " : " reads ") +
                    buffer + "[" + index_text(words[word_index], elements) + "], which has " +
                    std::to_string(elements) + (elements == 1 ? " element" : " elements"));
}

}  // namespace

bool bounds_check_wanted() {
    const char* const wanted = ::secure_getenv("TOPPLE_CHECK");
    if (!wanted || !*wanted) return false;
    if (std::string(wanted) != "bounds")
        throw Error(ErrorKind::usage,
                    std::string("TOPPLE_CHECK=") + wanted + " is unknown; take bounds");
    return true;
}

BoundsCheck::BoundsCheck(Device& device, std::vector<Dispatch>& batch)
    : words_((batch.size() + 1) * part_words), report_(device, words_.size(), "bounds check") {
    const auto bound = [&](std::size_t d) {
        return report_.slice(d * part_words, part_words).range;
    };
    for (std::size_t d = 0; d < batch.size(); ++d) {
        add_checks(batch[d], std::span(words_).subspan(d * part_words, part_words), bound(d),
                   bound(batch.size()));
        kernels_.push_back(batch[d].kernel);
    }
    report_.upload(words_);
}

void BoundsCheck::throw_if_found() {
    report_.download(words_);
    for (std::size_t d = 0; d < kernels_.size(); ++d)
        device::throw_if_found(*kernels_[d], std::span(words_).subspan(d * part_words, part_words));
}

Memory& BoundsCheck::memory() const {
    return *report_.slice(0, 0).range.memory;
}

}  // namespace topple::device
