// SPDX-License-Identifier: MIT
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "host/io/files.h"

// The real program, run in a folder of its own.
namespace topple::test {

using ::testing::HasSubstr, ::testing::Not;

struct Finished {
    int code = -1;  // exit code, or -1 where it was killed: by a signal, or by us when late
    bool late = false;
    std::string out, err;
};

class Program : public Files {
  protected:
    Program() { std::filesystem::create_directory(folder_ / "work"); }
    std::filesystem::path input_ = "/dev/null";  // standard input of what is run

    std::filesystem::path in(const std::string& name) const { return path("work/" + name); }
    std::filesystem::path put(const std::string& name, std::string_view bytes) const {
        return write("work/" + name, bytes);
    }
    // Everything below the program's folder, hidden or not.
    std::set<std::string> everything() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path("work")))
            names.insert(std::filesystem::relative(entry.path(), path("work")).string());
        return names;
    }

    // Runs it to its end, or for two minutes at most. `interrupt` is asked every few milliseconds
    // with what stands on stderr so far, and returns the signal to send, or 0.
    Finished run(const std::vector<std::string>& arguments,
                 const std::function<int(const std::string&)>& interrupt = {}) const {
        std::vector<std::string> words{TOPPLE_PROGRAM};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (auto& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const auto out = path("stdout"), err = path("stderr");
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addchdir_np(&files, path("work").c_str());
        posix_spawn_file_actions_addopen(&files, 0, input_.c_str(), O_RDONLY, 0);
        const int flags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&files, 1, out.c_str(), flags, 0600);
        posix_spawn_file_actions_addopen(&files, 2, err.c_str(), flags, 0600);
        pid_t pid = 0;
        const int failed = posix_spawn(&pid, TOPPLE_PROGRAM, &files, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&files);
        Finished finished;
        if (failed != 0) {
            ADD_FAILURE() << TOPPLE_PROGRAM << " can't be started: " << std::strerror(failed);
            return finished;
        }
        const int status = wait_for(pid, err, interrupt, finished.late);
        if (WIFEXITED(status)) finished.code = WEXITSTATUS(status);
        finished.out = bytes_of_file(out);
        finished.err = bytes_of_file(err);
        EXPECT_FALSE(finished.late) << "no end within two minutes; stderr:\n" << finished.err;
        return finished;
    }

    // The same with a line of words that hold no spaces.
    Finished topple(const std::string& line,
                    const std::function<int(const std::string&)>& interrupt = {}) const {
        return run(words_of(line), interrupt);
    }
    Finished succeeds(const std::string& line) const {
        Finished done = topple(line);
        EXPECT_EQ(done.code, 0) << line << "\n" << done.err;
        return done;
    }

    // Runs it where it must fail: with this exit code, with one line on stderr that holds `parts`,
    // with nothing on stdout, and with no file made or removed.
    void fails(int code, const std::string& line, const std::vector<std::string>& parts) const {
        expect_failure(code, words_of(line), parts);
    }
    void expect_failure(int code, const std::vector<std::string>& arguments,
                        const std::vector<std::string>& parts) const {
        SCOPED_TRACE(::testing::PrintToString(arguments));
        const auto before = everything();
        const Finished finished = run(arguments);
        EXPECT_EQ(finished.code, code);
        EXPECT_EQ(finished.out, "");
        EXPECT_TRUE(finished.err.starts_with("topple: ")) << finished.err;
        EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
        EXPECT_TRUE(finished.err.ends_with("\n")) << finished.err;
        for (const auto& part : parts) EXPECT_THAT(finished.err, HasSubstr(part));
        EXPECT_EQ(everything(), before);
    }

    // A flat, noisy patch of 100 x 100 points, 2 cm apart.
    std::filesystem::path put_plane(const std::string& name) const {
        Random random(7);
        std::string text;
        for (int i = 0; i < 100; ++i) {
            for (int j = 0; j < 100; ++j) {
                const double z = 1e-6 * static_cast<double>(random.below(2000));
                text += std::to_string(0.02 * i) + " " + std::to_string(0.02 * j) + " " +
                        std::to_string(z) + "\n";
            }
        }
        return put(name, text);
    }

  private:
    static std::vector<std::string> words_of(const std::string& line) {
        std::istringstream words(line);
        return {std::istream_iterator<std::string>(words), {}};
    }
    static int wait_for(pid_t pid, const std::filesystem::path& err,
                        const std::function<int(const std::string&)>& interrupt, bool& late) {
        const auto start = std::chrono::steady_clock::now();
        int status = 0;
        bool sent = false;
        while (waitpid(pid, &status, WNOHANG) == 0) {
            if (interrupt && !sent) {
                const int signal = interrupt(bytes_of_file(err));
                if (signal != 0) sent = kill(pid, signal) == 0;
            }
            if (!late && std::chrono::steady_clock::now() - start > std::chrono::minutes(2)) {
                late = true;
                kill(pid, SIGKILL);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(3));
        }
        return status;
    }
};

}  // namespace topple::test
