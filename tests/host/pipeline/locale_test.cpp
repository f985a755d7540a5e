// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clocale>
#include <locale>
#include <string>

#include "core/number_text.h"
#include "device/devices.h"
#include "io/text.h"
#include "result/scene_json.h"
#include "small_room.h"
#include "topple/parse.h"

// A host program may have set any locale: what topple writes is the same.
namespace topple::test {
namespace {

// Of a language that writes 1.234,5, for C++'s streams and, where the system has it, for C.
class Abroad {
  public:
    Abroad()
        : before_(std::locale::global(std::locale(std::locale::classic(), new Punctuation))),
          c_(std::setlocale(LC_ALL, nullptr)) {
        for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "de_DE@euro"})
            if (std::setlocale(LC_ALL, name)) return;
    }
    ~Abroad() {
        std::locale::global(before_);
        std::setlocale(LC_ALL, c_.c_str());
    }
    Abroad(const Abroad&) = delete;
    Abroad& operator=(const Abroad&) = delete;

  private:
    struct Punctuation : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    std::locale before_;
    std::string c_;
};

std::string parsed() {
    ParseOptions options;
    options.device = device::open_device("native");
    options.walks = 20;
    Scene scene = parse(SmallRoom::scattered().cloud, options).scene;
    scene.timings_s.clear();
    return io::scene_json(scene);
}

TEST(Locale, OfTheHostDoesNotReachTheResult) {
    const std::string at_home = parsed();
    const Abroad abroad;
    EXPECT_EQ(parsed(), at_home);
    EXPECT_EQ(io::bytes_text(1'600'000'000), "1.49 GiB");
    EXPECT_EQ(io::two_digits(0.25), "0.25");
    EXPECT_EQ(to_places(1234.5, 1) + " " + to_digits(0.125, 2), "1234.5 0.12");
    double value = 0;
    EXPECT_TRUE(io::parse_number("1.5e-400", value));
    EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace topple::test
