// SPDX-License-Identifier: MIT
#include "safety/columns.h"

#include <algorithm>
#include <string>

#include "topple/error.h"

namespace topple::safety {

Columns::Columns(const SolidCells& cells) : cells_(cells) {
    const std::size_t n = cells.size();
    if (n == 0) return;
    i0_ = cells.i.front();
    ni_ = std::int64_t{cells.i.back()} - i0_ + 1;
    const auto [low, high] = std::minmax_element(cells.j.begin(), cells.j.end());
    j0_ = *low;
    nj_ = std::int64_t{*high} - j0_ + 1;
    constexpr std::int64_t limit = std::int64_t{1} << 28;
    if (nj_ > limit || ni_ > limit / nj_) {
        throw Error(ErrorKind::input,
                    "the scene spans " + std::to_string(ni_) + " x " + std::to_string(nj_) +
                        " voxels, more than the 2^28 columns that the disturbance "
                        "fields can take; use a larger voxel_m (--voxel)");
    }
    first_.assign(static_cast<std::size_t>(ni_ * nj_ + 1), 0);
    for (std::size_t c = 0; c < n; ++c)
        ++first_[static_cast<std::size_t>((cells.i[c] - i0_) * nj_ + (cells.j[c] - j0_)) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];

    const auto [deep, tall] = std::minmax_element(cells.k.begin(), cells.k.end());
    k0_ = *deep;
    nk_ = std::int64_t{*tall} - k0_ + 1;
    words_ = (nk_ + 63) / 64;
    constexpr std::int64_t most_words = std::int64_t{1} << 24;  // 128 MiB
    if (words_ > most_words / (ni_ * nj_)) return;
    bits_.assign(static_cast<std::size_t>(ni_ * nj_ * words_), 0);
    for (std::size_t c = 0; c < n; ++c) {
        const std::int64_t column = (cells.i[c] - i0_) * nj_ + (cells.j[c] - j0_),
                           k = std::int64_t{cells.k[c]} - k0_;
        bits_[column * words_ + k / 64] |= std::uint64_t{1} << (k % 64);
    }
}

std::uint64_t Columns::solid(std::int64_t i, std::int64_t j, std::int64_t k) const {
    if (i < i0_ || i >= i0_ + ni_ || j < j0_ || j >= j0_ + nj_) return 0;
    const auto column = static_cast<std::size_t>((i - i0_) * nj_ + (j - j0_));
    if (!bits_.empty()) {
        const std::int64_t at = k - k0_;
        const auto word = [&](std::int64_t w) {
            return w < 0 || w >= words_ ? 0
                                        : bits_[column * static_cast<std::size_t>(words_) +
                                                static_cast<std::size_t>(w)];
        };
        const std::int64_t w = at >= 0 ? at / 64 : -((63 - at) / 64);
        const auto shift = static_cast<unsigned>(at - 64 * w);
        return shift == 0 ? word(w) : word(w) >> shift | word(w + 1) << (64 - shift);
    }
    const auto begin = cells_.k.begin() + static_cast<std::ptrdiff_t>(first_[column]);
    const auto end = cells_.k.begin() + static_cast<std::ptrdiff_t>(first_[column + 1]);
    std::uint64_t out = 0;
    for (auto at = std::lower_bound(begin, end, k); at != end && *at < k + 64; ++at)
        out |= std::uint64_t{1} << (*at - k);
    return out;
}

}  // namespace topple::safety
