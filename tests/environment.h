// SPDX-License-Identifier: MIT
#pragma once

#include "testing.h"

namespace topple::test {

// A variable of the environment that is set while it lives, and then as it was.
class EnvironmentVariable {
  public:
    EnvironmentVariable(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        EXPECT_EQ(::setenv(name, value.c_str(), 1), 0);
    }
    ~EnvironmentVariable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
    EnvironmentVariable(const EnvironmentVariable&) = delete;
    EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

  private:
    const char* name_;
    std::optional<std::string> before_;
};

}  // namespace topple::test
