// SPDX-License-Identifier: MIT
#pragma once

#include "parses/c_arguments.h"

namespace topple::parses {

// Calls single stages, on a device of its own.
class StageCaller : public Arguments {
  public:
    using Arguments::Arguments;
    void call();

  private:
    void normals();
    void barriers();
    void supports();
    void volume();
    void convolve();
};

}  // namespace topple::parses
