// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

// The files of the fitted models, as the build embeds them.
namespace topple::fitted {

std::string_view shell_model_json();
std::string_view joint_model_json();

}  // namespace topple::fitted
