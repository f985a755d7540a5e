// The kernel dialect as GLSL 4.50, for glslang. See kernels/README.md.
#define TOPPLE_VULKAN 1

#define STRUCT(T) struct T
#define STRUCT_END(T) ;
#define FN
#define CONST_ARRAY(T, n, c) const T n[c]

#define KERNEL(name, wg) layout(local_size_x = wg) in;
#define BUFFER_IN(i, T, n) layout(std430, set = 0, binding = i) readonly restrict buffer n##_block { T n[]; };
#define BUFFER_OUT(i, T, n) layout(std430, set = 0, binding = i) restrict buffer n##_block { T n[]; };
#define BUFFER_INOUT(i, T, n) layout(std430, set = 0, binding = i) restrict buffer n##_block { T n[]; };
#define PARAMS(T, n) layout(push_constant, std430) uniform T##_block { T n; };
#define SHARED(T, n, count) shared T n[count];

#define BEGIN void main() {
#define END }
#define BEGIN_GROUP void main() {
#define END_GROUP }
#define LANES {
#define END_LANES } memoryBarrierBuffer(); barrier();

#define EACH_ITEM(i) for (int i = 0; i < ITEMS; i++)
// Nothing is gained here, so nothing counts as near.
#define NEAR_WORDS 0
#define LOAD_NEAR(to, from, base, place) EACH_ITEM(i) { to[i] = from[(base) + place[i]]; }

#define GLOBAL_ID gl_GlobalInvocationID.x
#define LOCAL_ID gl_LocalInvocationID.x
#define GROUP_ID gl_WorkGroupID.x

#define ATOMIC_ADD(lvalue, v) atomicAdd(lvalue, v)
#define ATOMIC_OR(lvalue, v) atomicOr(lvalue, v)
#define ATOMIC_AND(lvalue, v) atomicAnd(lvalue, v)
#define ATOMIC_MIN(lvalue, v) atomicMin(lvalue, v)
#define ATOMIC_MAX(lvalue, v) atomicMax(lvalue, v)
#define SHARED_ADD(lvalue, v) atomicAdd(lvalue, v)
#define SHARED_OR(lvalue, v) atomicOr(lvalue, v)
#define SHARED_MIN(lvalue, v) atomicMin(lvalue, v)
#define SHARED_MAX(lvalue, v) atomicMax(lvalue, v)

#define float_bits(v) floatBitsToUint(v)
#define bits_float(v) uintBitsToFloat(v)

// GLSL leaves open which of two zeros min and max give; the dialect takes the first.
float topple_min(float a, float b) { return b < a ? b : a; }
float topple_max(float a, float b) { return a < b ? b : a; }
int topple_min(int a, int b) { return min(a, b); }
int topple_max(int a, int b) { return max(a, b); }
uint topple_min(uint a, uint b) { return min(a, b); }
uint topple_max(uint a, uint b) { return max(a, b); }
float topple_clamp(float v, float lo, float hi) { return topple_min(topple_max(v, lo), hi); }
int topple_clamp(int v, int lo, int hi) { return min(max(v, lo), hi); }
uint topple_clamp(uint v, uint lo, uint hi) { return min(max(v, lo), hi); }
#define min(a, b) topple_min(a, b)
#define max(a, b) topple_max(a, b)
#define clamp(v, lo, hi) topple_clamp(v, lo, hi)
