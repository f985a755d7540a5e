// SPDX-License-Identifier: MIT
#pragma once

#include "testing.h"

namespace topple::test {

// A variable of the environment that is set while it lives.
class EnvironmentVariable {
  public:
    EnvironmentVariable(const char* name, const std::string& value) : name_(name) {
        EXPECT_EQ(::setenv(name, value.c_str(), 1), 0);
    }
    ~EnvironmentVariable() { ::unsetenv(name_); }
    EnvironmentVariable(const EnvironmentVariable&) = delete;
    EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

  private:
    const char* name_;
};

}  // namespace topple::test
