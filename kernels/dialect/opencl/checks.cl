// What the accesses of a checked form become, as OpenCL C: see ../glsl/checks.glsl.
#define CHECKS(i) __global uint* checks_,
static inline uint checked_(__global uint* checks_, uint access, uint who, uint index) {
    if (index < checks_[4u + (access >> 2u)]) { return index; }
    if (atomic_cmpxchg(checks_, 0u, 1u) == 0u) {
        checks_[1] = access;
        checks_[2] = who;
        checks_[3] = index;
    }
    return 0u;
}
#define CHECKED(access, who, index) checked_(checks_, access, who, uint(index))
