// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace topple::geometry {

// Weights by angle modulo 90 degrees, in bins of one: what surfaces at right angles share.
class FourfoldHistogram {
  public:
    struct Peak {
        int bin = 0;
        double weight = 0;
    };

    // degrees: any that is not negative.
    void add(double degrees, double weight) {
        bins_[static_cast<std::size_t>(degrees) % bins_.size()] += weight;
        total_ += weight;
    }
    double total() const { return total_; }

    // The first bin with the most weight within so many bins of it.
    Peak peak(int reach) const {
        constexpr int count = 90;
        Peak most;
        for (int b = 0; b < count; ++b) {
            double sum = 0;
            for (int d = -reach; d <= reach; ++d)
                sum += bins_[static_cast<std::size_t>((b + d + count) % count)];
            if (sum > most.weight) most = {b, sum};
        }
        return most;
    }

  private:
    std::array<double, 90> bins_{};
    double total_ = 0;
};

}  // namespace topple::geometry
