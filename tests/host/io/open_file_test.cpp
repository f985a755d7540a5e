// SPDX-License-Identifier: MIT
#include "io/open_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include "files.h"
#include "io/folder_names.h"
#include "io/text.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;
using test::expect_input_error;

class OpenedFile : public test::Files {
  protected:
    OpenedFile() {
        write("in/a/b.txt", "b");
        write("secret.txt", "4711");
        fs::create_symlink("../secret.txt", path("in/out"));
        fs::create_symlink(path("secret.txt"), path("in/whole"));
        fs::create_symlink("..", path("in/up"));
        fs::create_symlink("/proc/self/root", path("in/magic"));
        fs::create_symlink("a", path("in/within"));
        EXPECT_EQ(::mkfifo(path("in/pipe").c_str(), 0600), 0);
    }
};

TEST_F(OpenedFile, lies_in_the_folder_that_names_it) {
    const auto read = [&](const char* name) {
        return std::string(read_file(FileName::in(path("in"), name)).text());
    };
    EXPECT_EQ(read("a/b.txt"), "b");
    EXPECT_EQ(read("within/b.txt"), "b");
    for (const char* name : {"out", "whole", "up/secret.txt", "../secret.txt", "a/../../secret.txt",
                             "/etc/hostname", "magic/etc/hostname"}) {
        SCOPED_TRACE(name);
        expect_input_error([&] { read(name); }, {"a link"});
    }
    expect_input_error([&] { read("pipe"); }, {"pipe", "not a regular file"});
    expect_input_error([&] { read("a"); }, {"is a folder"});
    std::error_code error;
    folder_names(FileName::in(path("in"), "up"), error);
    EXPECT_EQ(error.value(), EXDEV);
    EXPECT_EQ(folder_names(FileName::in(path("in"), "within"), error).size(), 1u);
    // The user's own word is taken.
    EXPECT_EQ(read_file(path("in/out")).text(), "4711");
    expect_input_error([&] { read_file(FileName::beside(path("in/x"), "within/b.txt")); },
                       {"a link"});
}

TEST_F(OpenedFile, step_by_step_follows_no_link) {
    const Descriptor folder(::open(path("in").c_str(), O_PATH | O_DIRECTORY));
    const auto opens = [&](const char* name) {
        return Descriptor(open_stepwise(folder.get(), name, O_RDONLY | O_NONBLOCK)).get() >= 0;
    };
    EXPECT_TRUE(opens("a/b.txt"));
    for (const char* name :
         {"out", "whole", "up/secret.txt", "../secret.txt", "within/b.txt", "magic/etc/hostname"})
        EXPECT_FALSE(opens(name)) << name;
}

}  // namespace
}  // namespace topple::io
