// SPDX-License-Identifier: MIT
#include "io/staging_folder.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "files.h"
#include "io/file_writer.h"
#include "io/replace_file.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;
using test::bytes_of_file;
using test::expect_input_error;

class Staging : public test::Files {
  protected:
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
};

TEST_F(Staging, of_a_killed_process_goes_with_the_next) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        const StagingFolder half(folder_);
        fs::create_directory(half.path() / "out");
        write_file(half.path() / "out/points.ply", "half");
        raise(SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_EQ(entries(), 1u);
    // What only looks so, and what is at work, stays.
    write(".topple-abcdefghij/thesis.tex", "years");
    write(".topple-abcdefghik/lock", "topple staging folder\n");  // others could look into it
    const StagingFolder alive(folder_);
    const StagingFolder next(folder_);
    EXPECT_EQ(entries(), 4u);
    EXPECT_TRUE(fs::exists(path(".topple-abcdefghij/thesis.tex")));
    EXPECT_TRUE(fs::exists(alive.path()));
    EXPECT_EQ(fs::status(next.path()).permissions(), fs::perms::owner_all);
}

TEST_F(Staging, a_file_replaces_its_like_and_nothing_else) {
    replace_file(path("a"), "1");
    replace_file(path("a"), "2");
    EXPECT_EQ(bytes_of_file(path("a")), "2");
    write("victim", "a letter");
    fs::create_symlink("victim", path("link"));
    fs::create_directory(path("folder"));
    expect_input_error([&] { replace_file(path("link"), "3"); }, {"link", "is a link"});
    expect_input_error([&] { replace_file(path("folder"), "3"); }, {"folder", "is a folder"});
    EXPECT_EQ(bytes_of_file(path("victim")), "a letter");
    check_own_file(path("none"), "mark");
    expect_input_error([&] { check_own_file(path("victim"), "mark", "is no cache"); }, {"victim"});
    EXPECT_EQ(entries(), 4u);
}

}  // namespace
}  // namespace topple::io
