// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace topple {

// What went wrong, in the terms a caller can act on. The command line maps each to its exit code.
enum class ErrorKind {
    input,      // the input can't be parsed into a scene, or OUT can't be written (exit code 1)
    usage,      // an option or argument is wrong (exit code 2)
    device,     // the asked-for backend or device can't be used (exit code 3)
    cancelled,  // the caller's `cancelled` said so
};

// The one exception type that the library throws on purpose. `what()` is a single line that names
// the object (file, option, kernel), the value, the limit it broke and the mend. Control characters
// and bytes that are no UTF-8, as paths and values may hold, are written in it as \xNN.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message);
    ErrorKind kind() const noexcept { return kind_; }

  private:
    ErrorKind kind_;
};

}  // namespace topple
