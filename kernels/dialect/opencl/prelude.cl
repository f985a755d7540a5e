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

#define GLOBAL_ID ((uint)get_global_id(0))
#define LOCAL_ID ((uint)get_local_id(0))
#define GROUP_ID ((uint)get_group_id(0))

#define ATOMIC_ADD(lvalue, v) atomic_add(&(lvalue), v)
#define ATOMIC_MIN(lvalue, v) atomic_min(&(lvalue), v)
#define ATOMIC_OR(lvalue, v) atomic_or(&(lvalue), v)
#define SHARED_ADD(lvalue, v) atomic_add(&(lvalue), v)
#define SHARED_OR(lvalue, v) atomic_or(&(lvalue), v)

#define float_bits(v) as_uint(v)
#define bits_float(v) as_float(v)

// GLSL's constructor casts. Function-like, so that plain type names stay types.
#define float(x) ((float)(x))
#define int(x) ((int)(x))
#define uint(x) ((uint)(x))
#define bool(x) ((bool)(x))
// GLSL's names for what OpenCL calls otherwise.
#undef abs
#define abs(x) topple_abs(x)
float __attribute__((overloadable)) topple_abs(float x) { return fabs(x); }
int __attribute__((overloadable)) topple_abs(int x) { return x < 0 ? -x : x; }
