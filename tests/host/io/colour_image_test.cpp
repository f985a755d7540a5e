// SPDX-License-Identifier: MIT
#include "colour_image.h"

#include "files.h"
#include "points/formats/colour_frames.h"
#include "points/formats/colour_image.h"
#include "points/formats/frame_sequence.h"

namespace topple::io {
namespace {

using test::expect_input_error;
using test::jpeg_bytes;
using test::png_bytes;
using test::rgb_pixels;
using Bytes = std::vector<std::uint8_t>;

// Smooth, so that a JPEG of it is much the same.
std::array<int, 3> slope(std::uint32_t u, std::uint32_t v) {
    return {20 + int(4 * u), 30 + int(5 * v), 200 - int(2 * (u + v))};
}

TEST(ColourImage, png_of_every_kind) {
    const Bytes pixels = rgb_pixels(9, 7, slope);
    const auto decoded = [](const std::string& bytes) {
        return decode_colour_image("a.png", bytes);
    };
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
        const ColourImage image =
            decoded(png_bytes(9, 7, 8, PNG_COLOR_TYPE_RGB, pixels, interlace));
        EXPECT_EQ(image.width, 9u);
        EXPECT_EQ(image.height, 7u);
        EXPECT_EQ(image.rgb, pixels);
    }
    EXPECT_EQ(decoded(png_bytes(2, 1, 8, PNG_COLOR_TYPE_GRAY, {7, 200})).rgb,
              (Bytes{7, 7, 7, 200, 200, 200}));
    EXPECT_EQ(decoded(png_bytes(1, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {7, 8, 9, 0})).rgb,
              (Bytes{7, 8, 9}));
    EXPECT_EQ(decoded(png_bytes(1, 1, 16, PNG_COLOR_TYPE_RGB, {7, 0, 8, 0, 9, 0})).rgb,
              (Bytes{7, 8, 9}));
    EXPECT_EQ(decoded(png_bytes(2, 1, 8, PNG_COLOR_TYPE_PALETTE, {0, 0})).rgb, Bytes(6, 0));
}

TEST(ColourImage, jpeg_of_every_kind) {
    const Bytes pixels = rgb_pixels(33, 18, slope);
    for (const bool progressive : {false, true}) {
        const ColourImage image =
            decode_colour_image("a.jpg", jpeg_bytes(33, 18, pixels, 3, progressive));
        EXPECT_EQ(image.width, 33u);
        ASSERT_EQ(image.rgb.size(), pixels.size());
        for (std::size_t n = 0; n < pixels.size(); ++n) EXPECT_NEAR(image.rgb[n], pixels[n], 8);
    }
    const auto grey = decode_colour_image("a.jpg", jpeg_bytes(8, 8, Bytes(64, 90), 1));
    EXPECT_EQ(grey.rgb, Bytes(192, 90));
}

TEST(ColourImage, bad_images_are_refused_with_their_reason) {
    const Bytes pixels = rgb_pixels(64, 48, slope);
    const std::string png = png_bytes(64, 48, 8, PNG_COLOR_TYPE_RGB, pixels),
                      jpeg = jpeg_bytes(64, 48, pixels);
    const auto refuse = [](const std::string& bytes, std::initializer_list<std::string_view> why) {
        expect_input_error([&] { decode_colour_image("color/0001", bytes); }, why);
    };
    refuse("GIF89a", {"color/0001", "\"GIF8\"", "neither a PNG nor a JPEG"});
    refuse("", {"color/0001", "neither"});
    for (const std::size_t size : {std::size_t{9}, std::size_t{40}, png.size() / 2})
        refuse(png.substr(0, size), {"color/0001", "cut short"});
    for (const std::size_t size : {std::size_t{4}, std::size_t{30}, jpeg.size() / 2})
        refuse(jpeg.substr(0, size), {"color/0001", "JPEG"});
    refuse(jpeg.substr(0, jpeg.size() / 2), {"cut short"});
    refuse(jpeg_bytes(8, 8, Bytes(256, 90), 4), {"CMYK", "save it as RGB"});
    std::string broken = png;
    broken[60] = static_cast<char>(broken[60] ^ 0x55);
    refuse(broken, {"damaged PNG"});
    // A PNG that says to be larger than what can be: refused before there is memory for it.
    std::string huge = png_bytes(1, 1, 8, PNG_COLOR_TYPE_RGB, {1, 2, 3});
    std::string head("IHDR\x00\x01\x00\x00\x00\x01\x00\x00\x08\x02\x00\x00\x00", 17);
    huge.replace(12, 17, head);
    refuse(huge, {"color/0001"});
}

TEST(ColourImage, sizes_are_checked_before_memory_is_taken) {
    const std::string png = png_bytes(9, 7, 8, PNG_COLOR_TYPE_RGB, rgb_pixels(9, 7, slope));
    std::array<std::uint32_t, 2> seen{};
    EXPECT_THROW(decode_colour_image("a", png,
                                     [&](std::uint32_t width, std::uint32_t height) {
                                         seen = {width, height};
                                         throw Error(ErrorKind::input, "no");
                                     }),
                 Error);
    EXPECT_EQ(seen, (std::array<std::uint32_t, 2>{9, 7}));
}

// A sequence of one frame of 8 x 6 pixels, 8 columns by 6 rows of colours that tell where they are.
class ColourFolder : public test::Files {
  protected:
    static constexpr const char* depth_intrinsics =
        R"({"width": 8, "height": 6, "fx": 8, "fy": 8, "cx": 3.5, "cy": 2.5, "depth_scale": 1000)";
    static std::array<int, 3> place(std::uint32_t u, std::uint32_t v) {
        return {int(10 + 20 * u), int(10 + 20 * v), 50};
    }
    void make(const std::string& more = "") {
        write("depth/0000.png", test::depth_png(8, 6, 1000));
        write("intrinsics.json", std::string(depth_intrinsics) + more + "}");
    }
    std::string image(std::uint32_t width, std::uint32_t height,
                      const std::function<std::array<int, 3>(std::uint32_t, std::uint32_t)>& c) {
        return png_bytes(width, height, 8, PNG_COLOR_TYPE_RGB, rgb_pixels(width, height, c));
    }
    Bytes colours() const { return FrameSequence::open(folder_).colours().load(0); }
};

TEST_F(ColourFolder, of_the_same_size_and_of_others) {
    make();
    EXPECT_TRUE(colours().empty());
    const Bytes expected = rgb_pixels(8, 6, place);
    write("color/0000.png", image(8, 6, place));
    EXPECT_EQ(colours(), expected);
    EXPECT_TRUE(FrameSequence::open(folder_).load(0).rgb.empty()) << "decoded only when asked for";
    // Three times as large: each pixel is the mean of nine, but for what is not known.
    write("color/0000.png", image(24, 18, [](std::uint32_t u, std::uint32_t v) {
              auto c = place(u / 3, v / 3);
              if (u % 3 == 0 && v % 3 == 0) return std::array<int, 3>{0, 0, 0};
              c[0] += int(u % 3) - 1;
              return c;
          }));
    const Bytes large = colours();
    ASSERT_EQ(large.size(), expected.size());
    for (std::size_t n = 0; n < large.size(); ++n) EXPECT_NEAR(large[n], expected[n], 1);
    // Half as large: each serves four.
    write("color/0000.png",
          image(4, 3, [](std::uint32_t u, std::uint32_t v) { return place(2 * u, 2 * v); }));
    EXPECT_EQ(colours(), rgb_pixels(8, 6, [](std::uint32_t u, std::uint32_t v) {
                  return place(u / 2 * 2, v / 2 * 2);
              }));
}

// A colour camera that sees half of it, twice as fine.
TEST_F(ColourFolder, with_intrinsics_of_their_own) {
    const char* narrow = R"({"width": 8, "height": 6, "fx": 16, "fy": 16, "cx": 3.5, "cy": 2.5})";
    const auto four = [](std::uint32_t u, std::uint32_t v) {
        return std::array<int, 3>{int(10 + 20 * (u / 2)), int(10 + 20 * (v / 2)), 50};
    };
    for (const bool in_color : {false, true}) {
        make(in_color ? "" : std::string(R"(, "color_intrinsics": )") + narrow);
        if (in_color) write("color/intrinsics.json", narrow);
        write("color/0000.png", image(8, 6, four));
        const Bytes seen = colours();
        for (std::uint32_t v = 0; v < 6; ++v) {
            for (std::uint32_t u = 0; u < 8; ++u) {
                SCOPED_TRACE(std::to_string(u) + ", " + std::to_string(v));
                const std::uint8_t* at = seen.data() + 3 * (8 * v + u);
                // Four columns are seen, and of the first and last row one half.
                const bool within = u >= 2 && u <= 5 && v >= 1 && v <= 4;
                constexpr std::array<int, 6> rows{0, 10, 20, 40, 50, 0};
                EXPECT_EQ(at[0], within ? 10 + 20 * (int(u) - 2) : 0);
                EXPECT_EQ(at[1], within ? rows[v] : 0);
                EXPECT_EQ(at[2], within ? 50 : 0);
            }
        }
    }
}

TEST_F(ColourFolder, what_does_not_fit_is_refused_or_noted) {
    make();
    const auto refuse = [&](std::initializer_list<std::string_view> why) {
        expect_input_error([&] { colours(); }, why);
    };
    write("color/0000.png", image(8, 8, place));
    refuse({"color/0000.png", "8 x 8", "8 x 6", "color_intrinsics"});
    write("color/0000.png", image(8, 6, place).substr(0, 60));
    refuse({"color/0000.png", "cut short"});
    write("color/0000.jpg", "no image");
    refuse({"color", "both 0000.jpg and 0000.png"});
    std::filesystem::remove(path("color/0000.png"));
    refuse({"color/0000.jpg", "neither a PNG nor a JPEG"});
    write("color/0000.jpg", jpeg_bytes(16, 12, rgb_pixels(16, 12, slope)));
    EXPECT_EQ(colours().size(), 144u);
    write("color/.0000.png", "another system's");
    EXPECT_EQ(colours().size(), 144u);

    make(R"(, "color_intrinsics": {"width": 4, "height": 3, "fx": 4, "fy": 4, "cx": 2, "cy": 1})");
    refuse({"color/0000.jpg", "16 x 12", "its intrinsics say 4 x 3"});
    make(R"(, "color_intrinsics": {"width": 4, "height": 3, "fx": 0, "fy": 4, "cx": 2, "cy": 1})");
    refuse({"intrinsics.json", "\"fx\" is 0"});
    make(R"(, "color_intrinsics": 5)");
    refuse({"intrinsics.json", "color_intrinsics", "number"});
    make(R"(, "color_intrinsics": {})");
    write("color/intrinsics.json", "{}");
    refuse({"color/intrinsics.json", "keep the one"});
    make();
    refuse({"color/intrinsics.json", "has no \"width\""});
    std::filesystem::remove(path("color/intrinsics.json"));

    std::filesystem::rename(path("color/0000.jpg"), path("color/other.jpg"));
    const FrameSequence sequence = FrameSequence::open(folder_);
    EXPECT_TRUE(sequence.colours().load(0).empty());
    ASSERT_EQ(sequence.colours().notes().size(), 1u);
    EXPECT_THAT(sequence.colours().notes()[0], testing::HasSubstr("0000.jpg"));
}

TEST_F(ColourFolder, frames_without_one_are_noted) {
    make();
    write("depth/0001.png", test::depth_png(8, 6, 1000));
    write("trajectory.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
    write("color/0001.png", image(8, 6, place));
    const FrameSequence sequence = FrameSequence::open(folder_);
    EXPECT_TRUE(sequence.colours().load(0).empty());
    EXPECT_EQ(sequence.colours().load(1).size(), 144u);
    ASSERT_EQ(sequence.colours().notes().size(), 1u);
    EXPECT_THAT(sequence.colours().notes()[0], testing::HasSubstr("1 frame of 2"));
}

}  // namespace
}  // namespace topple::io
