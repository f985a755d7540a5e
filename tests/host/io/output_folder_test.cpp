// SPDX-License-Identifier: MIT
#include "io/output_folder.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "files.h"
#include "io/file_writer.h"
#include "io/open_file.h"
#include "io/pending_outputs.h"
#include "io/replace_file.h"
#include "io/staging_folder.h"
#include "io/text.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;
using test::bytes_of_file;
using test::expect_input_error;

constexpr const char* our_scene = "{\n \"schema\": \"topple.scene/1\"}\n";

// Permissions don't bind root: while this lives, such a process is another user that owns `paths`.
class NotRoot {
  public:
    explicit NotRoot(std::initializer_list<fs::path> paths) : was_root_(geteuid() == 0) {
        if (!was_root_) return;
        for (const auto& path : paths) EXPECT_EQ(chown(path.c_str(), 65534, 65534), 0);
        EXPECT_EQ(seteuid(65534), 0);
    }
    ~NotRoot() {
        if (was_root_) {
            EXPECT_EQ(seteuid(0), 0);
        }
    }
    NotRoot(const NotRoot&) = delete;
    NotRoot& operator=(const NotRoot&) = delete;

  private:
    bool was_root_;
};

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

// How a process of its own ends that does this.
template <class Do>
int status_of(const Do& act) {
    const pid_t child = fork();
    EXPECT_GE(child, 0);
    if (child == 0) {
        act();
        _exit(0);
    }
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return status;
}

class Output : public test::Files {
  protected:
    void write_result(const OutputFolder& out, const std::string& points) {
        write_file(out.folder() / "points.ply", points);
        write_file(out.folder() / "scene.json", our_scene);
    }
};

TEST_F(Output, appears_whole_at_commit_with_missing_parents) {
    {
        OutputFolder out(path("a/b/out/"));
        write_result(out, "new");
        EXPECT_FALSE(fs::exists(path("a/b/out")));
        out.commit();
        EXPECT_EQ(bytes_of_file(path("a/b/out/points.ply")), "new");
        remove_pending_outputs();
        EXPECT_TRUE(fs::exists(path("a/b/out"))) << "safe from an interrupt";
    }
    EXPECT_EQ(entries(path("a/b/out")), 2u);
    EXPECT_EQ(entries(path("a/b")), 1u) << "nothing temporary is left";
}

TEST_F(Output, leaves_nothing_without_commit) {
    {
        OutputFolder out(path("a/b/out"));
        write_result(out, "new");
        EXPECT_TRUE(fs::exists(path("a/b")));
    }
    EXPECT_EQ(entries(folder_), 0u) << "not even the parents that it made";
}

TEST_F(Output, replaces_an_earlier_output_and_an_empty_folder) {
    write("out/scene.json", our_scene);
    write("out/points.ply", "old");
    write("out/volume.vdb", "old");
    write("out/view-photo.png", "old");
    {
        OutputFolder out(path("out"));
        write_result(out, "new");
        EXPECT_EQ(bytes_of_file(path("out/points.ply")), "old");
    }
    EXPECT_EQ(bytes_of_file(path("out/points.ply")), "old")
        << "a failed run leaves the earlier output";
    {
        OutputFolder out(path("out"));
        write_result(out, "new");
        out.commit();
    }
    EXPECT_EQ(bytes_of_file(path("out/points.ply")), "new");
    EXPECT_FALSE(fs::exists(path("out/volume.vdb"))) << "files of the earlier output go with it";
    EXPECT_EQ(entries(folder_), 1u);

    fs::create_directory(path("empty"));
    OutputFolder out(path("empty"));
    write_result(out, "new");
    out.commit();
    EXPECT_EQ(bytes_of_file(path("empty/points.ply")), "new");
}

TEST_F(Output, never_deletes_what_is_not_its_own) {
    write("photos/cat.jpg", "cat");
    expect_input_error([&] { OutputFolder out(path("photos")); },
                       {"photos", "cat.jpg", "no scene.json"});
    write("game/scene.json", "{\"player\": 1}");
    expect_input_error([&] { OutputFolder out(path("game")); }, {"game", "scene.json"});
    write("out/scene.json", our_scene);
    write("out/my notes.txt", "dear diary");
    expect_input_error([&] { OutputFolder out(path("out")); }, {"my notes.txt", "move it away"});
    fs::remove(path("out/my notes.txt"));
    write("out/points.ply/thesis.tex", "years");
    expect_input_error([&] { OutputFolder out(path("out")); }, {"points.ply", "a folder"});
    fs::remove_all(path("out/points.ply"));
    fs::create_symlink(path("photos/cat.jpg"), path("out/points.ply"));
    expect_input_error([&] { OutputFolder out(path("out")); }, {"points.ply", "a link"});
    write("file", "a file");
    expect_input_error([&] { OutputFolder out(path("file")); }, {"file", "no folder"});
    EXPECT_EQ(bytes_of_file(path("photos/cat.jpg")), "cat");

    // What appears while the run goes on is as safe.
    fs::create_directory(path("late"));
    OutputFolder out(path("late"));
    write_result(out, "new");
    write("late/thesis.tex", "years");
    expect_input_error([&] { out.commit(); }, {"thesis.tex"});
    EXPECT_EQ(bytes_of_file(path("late/thesis.tex")), "years");
}

TEST_F(Output, through_a_link_replaces_what_the_link_names) {
    fs::create_directory(path("real"));
    fs::create_directory_symlink(path("real"), path("link"));
    OutputFolder out(path("link"));
    write_result(out, "new");
    out.commit();
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_EQ(bytes_of_file(path("real/points.ply")), "new");
}

// Stands in a folder while it lives.
class Standing {
  public:
    explicit Standing(const fs::path& in) : before_(fs::current_path()) { fs::current_path(in); }
    ~Standing() { fs::current_path(before_); }
    Standing(const Standing&) = delete;
    Standing& operator=(const Standing&) = delete;

  private:
    fs::path before_;
};

TEST_F(Output, names_relative_to_the_current_folder) {
    fs::create_directory(path("here"));
    const Standing standing(path("here"));
    {
        OutputFolder out(".");
        write_result(out, "new");
        out.commit();
    }
    EXPECT_EQ(bytes_of_file("points.ply"), "new") << "the current folder is still the same";
    fs::remove("points.ply");
    fs::remove("scene.json");
    for (const char* name : {"out", "./out/", "../here/out"}) {
        OutputFolder out(name);
        write_result(out, name);
        out.commit();
        EXPECT_EQ(bytes_of_file("out/points.ply"), name);
    }
    EXPECT_EQ(entries("."), 1u);
}

TEST_F(Output, a_current_folder_that_is_gone) {
    fs::create_directory(path("here"));
    const Standing standing(path("here"));
    fs::remove(path("here"));
    expect_input_error([] { OutputFolder out("out"); }, {"out"});
    EXPECT_EQ(entries(folder_), 0u);
}

TEST_F(Output, bad_destinations) {
    expect_input_error([] { OutputFolder out(""); }, {"empty"});
    expect_input_error([] { OutputFolder out("/"); }, {"/"});
    write("file", "a file");
    expect_input_error([&] { OutputFolder out(path("file/out")); }, {"file"});
    expect_input_error([] { OutputFolder out("/proc/topple-out"); }, {"/proc"});
    EXPECT_EQ(entries(folder_), 1u);
}

TEST_F(Output, where_only_the_folder_itself_is_writable) {
    write("locked/out/scene.json", our_scene);
    write("locked/out/volume.vdb", "old");
    fs::permissions(path("locked"), fs::perms::owner_read | fs::perms::owner_exec);
    const NotRoot not_root({folder_, path("locked"), path("locked/out"),
                            path("locked/out/scene.json"), path("locked/out/volume.vdb")});
    expect_input_error([&] { OutputFolder out(path("locked/other")); },
                       {"locked", "Permission denied"});
    {
        OutputFolder out(path("locked/out"));
        write_result(out, "new");
        out.commit();
    }
    EXPECT_EQ(bytes_of_file(path("locked/out/points.ply")), "new");
    EXPECT_EQ(entries(path("locked/out")), 2u);
    fs::permissions(path("locked"), fs::perms::owner_all);
}

// A child is interrupted while it writes; its handler cleans up.
TEST_F(Output, an_interrupted_run_leaves_nothing) {
    const int status = status_of([destination = path("a/out")] {
        signal(SIGINT, [](int) {
            remove_pending_outputs();
            _exit(130);
        });
        OutputFolder out(destination);
        write_file(out.folder() / "points.ply", "half");
        write_file(out.folder() / "volume.vdb", "half");
        raise(SIGINT);
    });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_EQ(entries(folder_), 0u);
}

class Staging : public test::Files {};

TEST_F(Staging, of_a_killed_process_goes_with_the_next) {
    const int status = status_of([&] {
        const StagingFolder half(folder_);
        fs::create_directory(half.path() / "out");
        write_file(half.path() / "out/points.ply", "half");
        raise(SIGKILL);
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_EQ(entries(folder_), 1u);
    // What only looks so, and what is at work, stays.
    write(".topple-abcdefghij/thesis.tex", "years");
    write(".topple-abcdefghik/lock", "topple staging folder\n");  // others could look into it
    const StagingFolder alive(folder_);
    const StagingFolder next(folder_);
    EXPECT_EQ(entries(folder_), 4u);
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
    EXPECT_EQ(entries(folder_), 4u);
}

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
