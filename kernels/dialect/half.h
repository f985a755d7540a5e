// Numbers of 16 bits (IEEE 754's binary16) in kernels of all backends: what stands before a kernel that uses them, in
// the dialect itself. By integers, as drivers round to them as they like.

// The nearest, of two the even one; 65520 and above are infinite.
FN uint half_bits(float v) {
    uint sign = (float_bits(v) >> 16) & 0x8000u;
    uint magnitude = float_bits(v) & 0x7fffffffu;
    if (magnitude > 0x7f800000u) { return sign | 0x7e00u; }
    if (magnitude >= 0x477ff000u) { return sign | 0x7c00u; }
    uint kept = magnitude - 0x38000000u;  // the exponent's offset is 15 there, 127 here
    uint dropped = 13u;
    if (magnitude < 0x38800000u) {  // below 2^-14 in units of 2^-24
        kept = (magnitude & 0x7fffffu) | 0x800000u;
        dropped = 126u - (magnitude >> 23);
        if (dropped > 24u) { return sign; }
    }
    uint rest = kept & ((1u << dropped) - 1u);
    uint half_unit = 1u << (dropped - 1u);
    kept = kept >> dropped;
    return sign | (kept + uint(rest > half_unit || (rest == half_unit && (kept & 1u) != 0u)));
}
FN float bits_half(uint bits) {
    uint sign = (bits & 0x8000u) << 16;
    uint magnitude = bits & 0x7fffu;
    if (magnitude < 0x400u) { return bits_float(sign | float_bits(float(magnitude) * 5.9604644775390625e-8f)); }
    return bits_float(sign | ((magnitude << 13) + (magnitude < 0x7c00u ? 0x38000000u : 0x70000000u)));
}
