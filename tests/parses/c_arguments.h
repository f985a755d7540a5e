// SPDX-License-Identifier: MIT
#pragma once

#include "core/random.h"
#include "parses/random_scene.h"
#include "topple/topple.h"

// What random calls of the interface for C are made of.
namespace topple::parses {

struct Broken {
    std::string what;
};

template <auto release>
struct Release {
    template <class T>
    void operator()(T* handle) const {
        release(handle);
    }
};
using Device = std::unique_ptr<topple_device, Release<topple_device_release>>;
using Result = std::unique_ptr<topple_result, Release<topple_result_release>>;
using Volume = std::unique_ptr<topple_volume, Release<topple_volume_release>>;
using Labeller = std::unique_ptr<topple_labeller, Release<topple_labeller_release>>;

// Throws Broken where a call's code and status are not what the header says.
void check_call(const char* function, int code, const topple_status& status);

Device open_native();

class Arguments {
  public:
    explicit Arguments(std::uint64_t seed)
        : random_(seed), scene_(random_scene(seed, seed % 4 != 0)), device_(open_native()) {}

  protected:
    bool chance(double share) { return random_.uniform() < share; }
    // Mostly sensible.
    double number(double low, double high);
    // What no array in memory has so many of; functions must refuse it.
    std::uint64_t huge_count() { return random_.bits() | std::uint64_t{1} << 60; }
    // Mostly one of a few that there may be.
    std::uint64_t index() { return chance(0.1) ? random_.bits() : random_.below(8); }
    std::int32_t any_int() { return static_cast<std::int32_t>(random_.bits()); }
    template <class T>
    T* or_null(T* argument, double share = 0.04) {
        return chance(share) ? nullptr : argument;
    }
    // Most calls want to know why they fail.
    topple_status* status_or_null() { return or_null(&status_, 0.02); }
    void check(const char* function, int code);
    topple_device* device() { return or_null(device_.get()); }
    topple_cloud cloud();
    // Of one camera; they are kept here until the next call.
    topple_frames frames();

    Random random_;
    RandomScene scene_;
    Device device_;
    topple_status status_{};

  private:
    std::vector<std::uint16_t> depth_;
    std::vector<float> depth_m_;
    std::vector<std::uint8_t> rgb_;
    std::vector<double> pose_;
    std::vector<topple_frame> frame_;
    topple_intrinsics colour_{};
};

// A struct of the size that it says, between bytes that must stay.
template <class Struct>
struct Guarded {
    std::array<unsigned char, 64> before;
    Struct value;
    std::array<unsigned char, 64> after;

    explicit Guarded(std::size_t size) {
        before.fill(mark);
        std::fill_n(reinterpret_cast<unsigned char*>(&value), sizeof(value), mark);
        after.fill(mark);
        value.size = size;
    }
    bool kept() const {
        const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
        for (std::size_t n = std::max(value.size, sizeof(value.size)); n < sizeof(value); ++n)
            if (bytes[n] != mark) return false;
        for (const auto* guard : {&before, &after})
            for (const unsigned char byte : *guard)
                if (byte != mark) return false;
        return true;
    }

  private:
    static constexpr unsigned char mark = 0xA5;
};

}  // namespace topple::parses
