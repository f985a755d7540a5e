// SPDX-License-Identifier: MIT
// Damaged files: whatever is done to a valid file, a reader returns or throws Error(input) of one
// line. Memory errors show under the sanitizers.
#include <liblzf/lzf.h>

#include "colour_image.h"
#include "files.h"
#include "io/text.h"
#include "motion_files.h"
#include "points/formats/colour_image.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/read_cloud.h"
#include "result/scene_json.h"
#include "topple/input.h"
#include "topple/motion.h"

namespace topple::io {
namespace {

using test::append;

struct Tally {
    int good = 0, refused = 0;
};

class Mutation : public test::Files {
  protected:
    template <class Read>
    void try_one(const std::string& name, const std::string& bytes, Read read, Tally& tally) {
        const auto file = write(name, bytes);
        try {
            read(file);
            ++tally.good;
        } catch (const Error& error) {
            ++tally.refused;
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
        }
    }

    // Cuts at every length; then flips bits, overwrites, removes and doubles bytes.
    template <class Read>
    void mutate(const std::string& name, const std::string& valid, Read read) {
        Tally whole, cut, changed;
        try_one(name, valid, read, whole);
        EXPECT_EQ(whole.good, 1) << name << " must be valid";
        for (std::size_t length = 0; length < valid.size(); ++length)
            try_one(name, valid.substr(0, length), read, cut);
        EXPECT_GT(cut.refused, 0) << name;
        test::Random random(valid.size());
        static const char* const tokens[] = {
            "nan", "-1", "1e999", "18446744073709551615", "\n", " ", "0", "\xff", ","};
        for (int i = 0; i < 2500; ++i) {
            auto bytes = valid;
            for (auto edits = 1 + random.below(4); edits > 0 && !bytes.empty(); --edits) {
                const auto at = random.below(bytes.size());
                switch (random.below(5)) {
                    case 0:
                        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
                        break;
                    case 1:
                        bytes[at] = static_cast<char>(random.below(256));
                        break;
                    case 2:
                        bytes.erase(at, 1 + random.below(8));
                        break;
                    case 3:
                        bytes.insert(at, bytes.substr(at, 1 + random.below(8)));
                        break;
                    default:
                        bytes.insert(at, tokens[random.below(std::size(tokens))]);
                }
            }
            try_one(name, bytes, read, changed);
        }
        EXPECT_GT(changed.refused, 0) << name;
    }
};

const auto cloud = [](const std::filesystem::path& file) {
    const auto result = read_cloud(file);
    EXPECT_GT(result.size(), 0u);
    EXPECT_EQ(result.y.size(), result.size());
    EXPECT_EQ(result.z.size(), result.size());
    EXPECT_TRUE(result.nx.empty() || result.nx.size() == result.size());
    EXPECT_TRUE(result.width == 0 || result.pixel.size() == result.size());
    for (const auto pixel : result.pixel)
        EXPECT_LT(pixel, std::uint64_t(result.width) * result.height);
    for (const float value : result.x) EXPECT_LE(std::abs(value), 1e6f);
};

TEST_F(Mutation, ply) {
    const std::string vertex =
        "element vertex 3\nproperty float x\nproperty double y\nproperty short z\nproperty list "
        "uchar float w\n"
        "property float nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty list "
        "uchar int i\nend_header\n";
    mutate("a.ply",
           "ply\nformat ascii 1.0\n" + vertex +
               "1 2 3 0 0 0 1\n4 5 6 2 1 1 0 1 0\n7 8 9 0 1 0 0\n3 0 1 2\n",
           cloud);
    for (const bool big : {false, true}) {
        auto bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                     "_endian 1.0\n" + "element face 1\nproperty list uchar int i\n" +
                     vertex.substr(0, vertex.find("element face")) + "end_header\n";
        append<std::uint8_t>(bytes, 3, big);
        for (int i = 0; i < 3; ++i) append<std::int32_t>(bytes, i, big);
        for (int i = 0; i < 3; ++i) {
            append<float>(bytes, float(i), big);
            append<double>(bytes, i, big);
            append<std::int16_t>(bytes, std::int16_t(i), big);
            append<std::uint8_t>(bytes, std::uint8_t(i), big);
            for (int k = 0; k < i; ++k) append<float>(bytes, 1, big);
            for (int k = 0; k < 3; ++k) append<float>(bytes, float(k), big);
        }
        mutate("a.ply", bytes, cloud);
    }
}

TEST_F(Mutation, pcd) {
    const auto head = [](const std::string& data) {
        return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z n\nSIZE 4 4 8 2\nTYPE F F F I\nCOUNT 1 1 1 "
               "2\nWIDTH 3\nHEIGHT 2\n"
               "VIEWPOINT 0 0 1 1 0 0 0\nPOINTS 6\nDATA " +
               data + "\n";
    };
    mutate(
        "a.pcd",
        head("ascii") + "1 2 3 4 5\n6 7 8 9 1\nnan nan nan 0 0\n1 1 1 1 1\n2 2 2 2 2\n3 3 3 3 3\n",
        cloud);
    std::string raw;
    for (int i = 0; i < 6 * 20; ++i) raw.push_back(static_cast<char>(i % 7));
    mutate("a.pcd", head("binary") + raw, cloud);
    std::string packed(300, '\0');
    packed.resize(lzf_compress(raw.data(), unsigned(raw.size()), packed.data(), 300));
    std::string sizes;
    append<std::uint32_t>(sizes, std::uint32_t(packed.size()));
    append<std::uint32_t>(sizes, std::uint32_t(raw.size()));
    mutate("a.pcd", head("binary_compressed") + sizes + packed, cloud);
}

TEST_F(Mutation, motion) {
    const auto motion = [](const std::filesystem::path& file) {
        const BodyMotion read = read_motion(file);
        EXPECT_GE(read.frames(), 3u);
        for (const auto& track : read.track) EXPECT_TRUE(track.empty() || track.size() >= 3);
    };
    mutate("a.bvh", test::bvh(6, 0.1), motion);
    std::string table =
        "time,l_shoulder.x,l_shoulder.y,l_shoulder.z,l_elbow.x,l_elbow.y,l_elbow.z,l_wrist.x,"
        "l_wrist.y,l_wrist.z\n";
    for (int f = 0; f < 6; ++f)
        table.append(std::to_string(0.1 * f)).append(",0,0,1.4,0,0,1.1,0,0,0.83\n");
    mutate("a.csv", table, motion);
}

TEST_F(Mutation, xyz) {
    mutate("a.xyz", "# scan\n3\n1 2 3 0 0 1\n4,5,6,0,1,0\n7;8;9;1;0;0\n", cloud);
    mutate("a.csv", "id,x,y,z,nx,ny,nz\n1,2,3,4,0,0,1\n5,6,7,8,0,1,0\n", cloud);
}

TEST_F(Mutation, accelerogram) {
    const auto record = [](const std::filesystem::path& file) {
        const Accelerogram result = read_accelerogram(file);
        EXPECT_GE(result.m_s2.size(), 2u);
        EXPECT_GT(result.step_s, 0);
        EXPECT_LE(result.peak_m_s2(), 10 * 9.80665);
    };
    mutate("a.json", R"({"name": "a", "numPoints": 3, "dT": 0.02, "unit": "g", "factor": 1,
                        "accel_data": [0.1, -0.2, 3e-1]})",
           record);
    mutate("b.json", R"({"timeSeries": [{"dt": 0.01, "data": [1, 2], "units": "m/s^2"}]})", record);
    mutate("a.txt", "# time s, acceleration m/s^2\n0 0.5\n0.01 -1\n0.02 0.25\n", record);
}

TEST_F(Mutation, depth_image) {
    mutate("a.png", test::depth_png(9, 7, 100), [](const std::filesystem::path& file) {
        EXPECT_EQ(read_depth_png(file, 9, 7).size(), 63u);
    });
    mutate("a.png", test::depth_png(9, 7, 100, PNG_INTERLACE_ADAM7),
           [](const std::filesystem::path& file) {
               EXPECT_EQ(read_depth_png(file, 9, 7).size(), 63u);
           });
}

TEST_F(Mutation, colour_image) {
    const auto decode = [](const std::filesystem::path& file) {
        const auto image = decode_colour_image(file, read_file(file).text());
        EXPECT_EQ(image.rgb.size(), std::size_t{3} * image.width * image.height);
    };
    std::vector<std::uint8_t> pixels(9 * 7 * 3);
    for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = static_cast<std::uint8_t>(n);
    mutate("a.png", test::png_bytes(9, 7, 8, PNG_COLOR_TYPE_RGB, pixels), decode);
    mutate("a.jpg", test::jpeg_bytes(9, 7, pixels), decode);
    mutate("a.jpg", test::jpeg_bytes(9, 7, pixels, 3, true), decode);
}

TEST_F(Mutation, intrinsics_trajectory_and_scene) {
    mutate(
        "i.json",
        R"({"width": 5, "height": 3, "fx": 4.5, "fy": 4.25, "cx": 2, "cy": 1, "depth_scale": 1000})",
        [](const std::filesystem::path& file) { EXPECT_GT(read_intrinsics(file).fx, 0); });
    mutate("t.txt", "# t\n0 1 2 3 0 0 0 1\n1 1 2 3 0.5 -0.5 0.5 0.5\n",
           [](const std::filesystem::path& file) {
               for (const auto& pose : read_trajectory(file))
                   EXPECT_LE(std::abs(pose[0]), 1 + 1e-9);
           });
    Scene scene;
    scene.primitives.emplace_back().id = 0;
    scene.objects.emplace_back().id = 0;
    scene.objects[0].instability = {{0, 1}};
    scene.contacts = {{0, 0, 0.25, {0, 0, 1}, "fixed", 0.97}};
    scene.notes = {"a note"};
    mutate("s.json", scene_json(scene),
           [](const std::filesystem::path& file) { read_scene_json(file); });
}

}  // namespace
}  // namespace topple::io
