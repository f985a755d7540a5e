// What the accesses of a checked form become (kernels/tools/check_bounds.py), as GLSL. The first one outside
// is noted, and element 0 taken instead. checks_: found, access, who, index, then the elements of each binding.
#define CHECKS(i)                                                                          \
    layout(std430, set = 0, binding = i) restrict buffer ChecksBlock { uint checks_[]; };  \
    uint checked_(uint access, uint who, uint index) {                                     \
        if (index < checks_[4u + (access >> 2u)]) { return index; }                        \
        if (atomicCompSwap(checks_[0], 0u, 1u) == 0u) {                                    \
            checks_[1] = access;                                                           \
            checks_[2] = who;                                                              \
            checks_[3] = index;                                                            \
        }                                                                                  \
        return 0u;                                                                         \
    }
#define CHECKED(access, who, index) checked_(access, who, uint(index))
