// The kernel dialect as OpenCL C 1.2. See kernels/README.md.
#pragma OPENCL FP_CONTRACT OFF
#define TOPPLE_OPENCL 1

#define STRUCT(T) typedef struct T
#define STRUCT_END(T) T;
#define FN static inline
#define CONST_ARRAY(T, n, c) __constant T n[c]

#define KERNEL(name, wg) __kernel __attribute__((reqd_work_group_size(wg, 1, 1))) void name(
#define BUFFER_IN(i, T, n) __global const T* restrict n,
#define BUFFER_OUT(i, T, n) __global T* restrict n,
#define BUFFER_INOUT(i, T, n) __global T* restrict n,
#define PARAMS(T, n) const T n) {
#define SHARED(T, n, count) __local T n[count];

#define BEGIN {
#define END } }
#define BEGIN_GROUP {
#define END_GROUP } }
#define LANES {
#define END_LANES } barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);

#define EACH_ITEM(i) for (int i = 0; i < ITEMS; i++)
// Nothing is gained here, so nothing counts as near.
#define NEAR_WORDS 0
#define LOAD_NEAR(to, from, base, place) EACH_ITEM(i) { to[i] = from[(base) + place[i]]; }

#define STORE_LINE(to, at, from, base) for (uint k_ = 0u; k_ < 16u; k_++) { to[(at) + k_] = from[(base) + k_]; }
#define LINES_STORED

#define GLOBAL_ID ((uint)get_global_id(0))
#define LOCAL_ID ((uint)get_local_id(0))
#define GROUP_ID ((uint)get_group_id(0))

#define ATOMIC_ADD(lvalue, v) atomic_add(&(lvalue), v)
#define ATOMIC_OR(lvalue, v) atomic_or(&(lvalue), v)
#define ATOMIC_AND(lvalue, v) atomic_and(&(lvalue), v)
#define ATOMIC_MIN(lvalue, v) atomic_min(&(lvalue), v)
#define ATOMIC_MAX(lvalue, v) atomic_max(&(lvalue), v)
#define SHARED_ADD(lvalue, v) atomic_add(&(lvalue), v)
#define SHARED_OR(lvalue, v) atomic_or(&(lvalue), v)
#define SHARED_MIN(lvalue, v) atomic_min(&(lvalue), v)
#define SHARED_MAX(lvalue, v) atomic_max(&(lvalue), v)

#define float_bits(v) as_uint(v)
#define bits_float(v) as_float(v)
#define bit_count(v) popcount(v)
#define mul_high(a, b) mul_hi(a, b)

// GLSL's constructor casts. Function-like, so that plain type names stay types.
#define float(x) ((float)(x))
#define int(x) ((int)(x))
#define uint(x) ((uint)(x))
#define bool(x) ((bool)(x))

// OpenCL has abs for integers only, and leaves open which of two zeros min and max give; the dialect
// takes the first.
#define DIALECT_FN static inline __attribute__((overloadable))
DIALECT_FN float topple_abs(float v) { return fabs(v); }
DIALECT_FN int topple_abs(int v) { return v < 0 ? -v : v; }
DIALECT_FN float topple_min(float a, float b) { return b < a ? b : a; }
DIALECT_FN float topple_max(float a, float b) { return a < b ? b : a; }
DIALECT_FN int topple_min(int a, int b) { return b < a ? b : a; }
DIALECT_FN int topple_max(int a, int b) { return a < b ? b : a; }
DIALECT_FN uint topple_min(uint a, uint b) { return b < a ? b : a; }
DIALECT_FN uint topple_max(uint a, uint b) { return a < b ? b : a; }
DIALECT_FN float topple_clamp(float v, float lo, float hi) { return topple_min(topple_max(v, lo), hi); }
DIALECT_FN int topple_clamp(int v, int lo, int hi) { return topple_min(topple_max(v, lo), hi); }
DIALECT_FN uint topple_clamp(uint v, uint lo, uint hi) { return topple_min(topple_max(v, lo), hi); }
#undef abs
#undef min
#undef max
#undef clamp
#define abs(v) topple_abs(v)
#define min(a, b) topple_min(a, b)
#define max(a, b) topple_max(a, b)
#define clamp(v, lo, hi) topple_clamp(v, lo, hi)
