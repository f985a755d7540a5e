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

#define STORE_LINE(to, at, from, base) for (uint k_ = 0u; k_ < 16u; k_++) { to[(at) + k_] = from[(base) + k_]; }
#define LINES_STORED

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

// Vulkan lets drivers divide to 2.5 ulp and take roots to about 5, which real GPUs do. These two are as IEEE 754
// says all the same: quotients and roots of mantissas as integers of 25 bits, of which the driver's own give a
// few units at most in the wrong, as what is left over tells exactly, though it is computed modulo 2^32.
// tools/build_kernels.py lets topple_divide do what stands as a / b.
layout(constant_id = 1) const bool DRIVER_IS_EXACT = true;

// quotient / 2^24 * 2^(exponent - 127), rounded to the nearest float, to even in between; `more` where a little is
// missing from the quotient, of which bit 24 is the highest.
float topple_rounded(const uint sign, const uint quotient, const bool more, const int exponent) {
    if (exponent > 254) { return uintBitsToFloat(sign | 0x7f800000u); }
    int dropped = min(1 + max(1 - exponent, 0), 31);
    uint kept = quotient >> dropped;
    uint rest = quotient & ((1u << dropped) - 1u);
    uint half_unit = 1u << (dropped - 1);
    bool up = rest > half_unit || (rest == half_unit && (more || (kept & 1u) != 0u));
    uint base = uint(max(exponent - 1, 0)) << 23;
    return uintBitsToFloat(sign | (base + kept + uint(up)));
}
// The mantissa of a finite number other than 0 with bit 23 as the highest, and the exponent that goes with it.
uint topple_mantissa(const uint magnitude) {
    uint m = magnitude & 0x7fffffu;
    return magnitude >= 0x800000u ? m | 0x800000u : m << (23 - findMSB(m));
}
int topple_exponent(const uint magnitude) {
    return magnitude >= 0x800000u ? int(magnitude >> 23) : findMSB(magnitude) - 22;
}
float topple_divide(const float a, const float b) {
    if (DRIVER_IS_EXACT) { return a / b; }
    uint sign = (floatBitsToUint(a) ^ floatBitsToUint(b)) & 0x80000000u;
    uint ua = floatBitsToUint(a) & 0x7fffffffu;
    uint ub = floatBitsToUint(b) & 0x7fffffffu;
    uint inf = 0x7f800000u;
    if (ua == 0u || ub == 0u || ua >= inf || ub >= inf) {
        bool undefined = ua > inf || ub > inf || (ua == 0u && ub == 0u) || (ua == inf && ub == inf);
        bool vanishes = ua == 0u || ub == inf;
        return uintBitsToFloat(undefined ? 0x7fc00000u : vanishes ? sign : sign | inf);
    }
    uint ma = topple_mantissa(ua);
    uint mb = topple_mantissa(ub);
    int shift = ma < mb ? 25 : 24;
    uint quotient = uint(float(ma) / float(mb) * (ma < mb ? 33554432.0f : 16777216.0f));
    int left = int((ma << shift) - quotient * mb);
    int wrong = int(floor(float(left) / float(mb)));
    quotient += uint(wrong);
    left -= wrong * int(mb);
    if (left < 0) {
        quotient -= 1u;
        left += int(mb);
    } else if (left >= int(mb)) {
        quotient += 1u;
        left -= int(mb);
    }
    int exponent = topple_exponent(ua) - topple_exponent(ub) + 127 + 24 - shift;
    return topple_rounded(sign, quotient, left != 0, exponent);
}
float topple_sqrt(const float v) {
    if (DRIVER_IS_EXACT) { return sqrt(v); }
    uint bits = floatBitsToUint(v);
    if ((bits & 0x7fffffffu) == 0u || bits >= 0x7f800000u) {
        bool same = (bits & 0x7fffffffu) == 0u || bits == 0x7f800000u || (bits & 0x7fffffffu) > 0x7f800000u;
        return same ? v : uintBitsToFloat(0x7fc00000u);
    }
    // v = m 2^e with e even and m of 25 or 26 bits, so that the root of m 2^24 has 25.
    int e = topple_exponent(bits) - 151;
    uint m = topple_mantissa(bits) << 1;
    if ((e & 1) != 0) {
        m <<= 1;
        e -= 1;
    }
    uint root = uint(sqrt(float(m)) * 4096.0f);
    int left = int((m << 24) - root * root);
    root += uint(int(floor(float(left) / (2.0f * float(root)))));
    left = int((m << 24) - root * root);
    if (left < 0) {
        root -= 1u;
        left += int(2u * root + 1u);
    } else if (left > int(2u * root)) {
        left -= int(2u * root + 1u);
        root += 1u;
    }
    return topple_rounded(0u, root, left != 0, 127 + 12 + e / 2);
}
#define sqrt(v) topple_sqrt(v)

#define float_bits(v) floatBitsToUint(v)
#define bits_float(v) uintBitsToFloat(v)
#define bit_count(v) uint(bitCount(v))
uint mul_high(uint a, uint b) {
    uint high;
    uint low;
    umulExtended(a, b, high, low);
    return high;
}

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
