// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

// Text of tables, and means for it. For this folder.
namespace topple::evaluation {

// Up to 255 characters, as printf does.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...);

// A share in percent, or a dash for none.
std::string percent(double share);

// What `of` is of each score, where that is a finite number.
template <class Score, class Of>
std::vector<double> known(const std::vector<Score>& scores, const Of& of) {
    std::vector<double> out;
    for (const Score& score : scores)
        if (const double value = std::invoke(of, score); std::isfinite(value)) out.push_back(value);
    return out;
}

// Those of one name.
template <class Score>
std::vector<Score> scores_of(const std::vector<Score>& scores, std::string Score::*name,
                             const std::string& one) {
    std::vector<Score> out;
    for (const Score& score : scores)
        if (score.*name == one) out.push_back(score);
    return out;
}

// NaN of none.
double mean(const std::vector<double>& values);

}  // namespace topple::evaluation
