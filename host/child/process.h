// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace topple::child {

// What a child may take. It dies of more.
struct Limits {
    std::uint64_t memory_bytes = 0;  // of address space, beyond what it starts with; 0: no limit
    std::uint64_t cpu_s = 0;
    double wall_s = 0;
    bool whole_environment = false;  // else what plain_environment() has
};

// What a child wrote into memory that it shares with its parent: sealed, so that nobody changes it
// any more, and mapped. Nothing in it is to be trusted.
class Answer {
  public:
    Answer() = default;
    // Takes the descriptor. Empty where what it holds was not finished by end_of_answer().
    explicit Answer(int descriptor);
    Answer(Answer&& other) noexcept;
    Answer& operator=(Answer&&) = delete;
    ~Answer();

    bool whole() const { return data_ != nullptr; }
    std::span<const std::byte> bytes() const;
    // Gives back the memory of what lies before `end`, which is not read again.
    void release(std::size_t end) const;

  private:
    std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

struct Ended {
    Answer answer;
    std::string how;  // where it is not whole: "crashed (Segmentation fault)", say; or, where it
                      // never ran, "PROGRAM did not start", why, and the mend
    bool started = true;
};

// The descriptor under which a child finds the memory for its answer; the answer begins after
// answer_head bytes, which end_of_answer() fills.
inline constexpr int answer_descriptor = 3;
inline constexpr std::size_t answer_head = 16;
void end_of_answer(int descriptor = answer_descriptor);

// Runs one of program.h on a task: words that it knows, with absolute paths. It gets no descriptors
// but the answer's, no terminal, / as its folder, and ends with the caller's thread. poll: called
// about 50 times a second; what it throws ends the child, and is thrown on.
Ended run(const std::string& program, const std::vector<std::string>& task, const Limits& limits,
          const std::function<void()>& poll);

// In the child: takes on the limits and whose child it is, which stand before the task in its
// arguments. Returns the task; empty where the arguments are none of run()'s.
std::vector<std::string> accept_task(int argc, char** argv);

}  // namespace topple::child
