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

    // Within so many bins of one.
    double around(int bin, int reach) const {
        double sum = 0;
        for (int d = -reach; d <= reach; ++d) sum += bins_[(bin + d + count) % count];
        return sum;
    }
    // The first bin with the most weight within so many bins of it.
    Peak peak(int reach) const {
        Peak most;
        for (int b = 0; b < count; ++b) {
            const double sum = around(b, reach);
            if (sum > most.weight) most = {b, sum};
        }
        return most;
    }

  private:
    static constexpr int count = 90;
    std::array<double, count> bins_{};
    double total_ = 0;
};

}  // namespace topple::geometry
