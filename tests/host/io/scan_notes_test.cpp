// SPDX-License-Identifier: MIT
#include "points/formats/scan_notes.h"

#include <gtest/gtest.h>

#include "files.h"

namespace topple::io {
namespace {

class ScanNotes : public test::Files {};

TEST_F(ScanNotes, AreTheLinesBesideAFileOrWithinAFolder) {
    const auto scan = write("scan.ply", "ply\n");
    EXPECT_TRUE(scan_notes(scan).empty());
    write("scan.ply.topple-notes.txt", "The phone's poses drift.\r\n\n3 frames\x01 were lost.");
    EXPECT_EQ(scan_notes(scan),
              (std::vector<std::string>{"The phone's poses drift.", "3 frames\\x01 were lost."}));
    const auto folder = scan.parent_path() / "frames";
    std::filesystem::create_directories(folder / "topple-notes.txt");
    EXPECT_TRUE(scan_notes(folder).empty()) << "a folder of that name is none";
    std::filesystem::remove(folder / "topple-notes.txt");
    write("frames/topple-notes.txt", "One.\n");
    EXPECT_EQ(scan_notes(folder), std::vector<std::string>{"One."});
}

TEST_F(ScanNotes, AreNotOfOthers) {
    write("secret.txt", "4711");
    const auto scan = write("in/scan.ply", "ply\n"), notes = path("in/scan.ply.topple-notes.txt");
    for (const char* target : {"../secret.txt", "scan.ply"}) {
        std::filesystem::create_symlink(target, notes);
        test::expect_input_error([&] { scan_notes(scan); },
                                 {"scan.ply.topple-notes.txt", "a link"});
        std::filesystem::remove(notes);
    }
}

TEST_F(ScanNotes, OfAnySizeAreFew) {
    const auto scan = write("scan.ply", "ply\n");
    std::string many;
    for (int n = 0; n < 100; ++n) many += "Note " + std::to_string(n) + ".\n";
    for (const std::string& text :
         {many, std::string(3'000'000, 'x'), many + std::string(90'000, '\n')}) {
        write("scan.ply.topple-notes.txt", text);
        const auto notes = scan_notes(scan);
        ASSERT_LE(notes.size(), 51u);
        EXPECT_TRUE(notes.back().ends_with("scan.ply.topple-notes.txt was left out."))
            << notes.back();
        for (const auto& note : notes) EXPECT_LT(note.size(), 1100u);
    }
}

}  // namespace
}  // namespace topple::io
