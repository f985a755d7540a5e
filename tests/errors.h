// SPDX-License-Identifier: MIT
#pragma once

#include "testing.h"
#include "topple/error.h"

// What calls that fail say.
namespace topple::test {

// What an Error that a call throws says, of that kind; of any, where it is none.
template <class Call>
std::string message_of(const Call& call, std::optional<ErrorKind> kind = ErrorKind::device) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind.value_or(error.kind())) << error.what();
        return error.what();
    }
    return "nothing was thrown";
}

// The message of the Error(input) that `call` throws: one line, with every part of `parts` in it.
template <class Call>
void expect_input_error(Call call, const std::vector<std::string_view>& parts) {
    try {
        call();
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(error.kind(), ErrorKind::input) << message;
        for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << message;
        for (const auto part : parts)
            EXPECT_NE(message.find(part), std::string::npos) << message << "\nshould say: " << part;
        return;
    }
    ADD_FAILURE() << "no error, where one should say: " << (parts.empty() ? "" : parts[0]);
}

}  // namespace topple::test
