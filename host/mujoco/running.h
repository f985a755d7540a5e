// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include "mujoco/settled.h"

// A scene that MuJoCo runs. Its header is kept out of all others: it includes a "math.h" by that
// name, which the kernels have, too.
namespace topple::mujoco {

class Running {
  public:
    explicit Running(const std::filesystem::path& file);
    ~Running();
    // Why it was not loaded, or what MuJoCo warned of; empty: nothing.
    const std::string& trouble() const { return trouble_; }

    double mass_kg(const std::string& body) const;
    double height_m(const std::string& body) const;
    bool is_box(const std::string& body) const;  // its first geom

    double deepest_m();  // overlap at the start

    // Runs for so long, or until that took `patience_s`. Does not return where MuJoCo finds that it
    // can't go on: that ends the process, after `on_error` was called where it is set.
    Settled settle(double seconds, double patience_s = std::numeric_limits<double>::infinity());

    // How many of the free bodies stay for so long, and how many were ever faster than a metre a
    // second.
    struct Stay {
        int free = 0, stay = 0, launched = 0;
    };
    Stay run(double seconds);

    using OnError = void (*)(const char* what);
    static void set_on_error(OnError on_error);

  private:
    struct State;
    std::unique_ptr<State> state_;
    std::string trouble_;
};

}  // namespace topple::mujoco
