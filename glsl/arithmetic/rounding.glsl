// Quotients and square roots that every device rounds as processors do, to the nearest. Vulkan asks that of sums and products, but
// lets a quotient be 2.5 units off in the last place and a root more. So the device's own is an estimate here, and whole numbers
// decide: what is left of the dividend, or of the radicand, says by how many units it is off. The estimate may be eight units off.

#ifndef ARITHMETIC_ROUNDING
#define ARITHMETIC_ROUNDING

// Numbers that are not normal, or whose quotient is not, are left to the device; but 0 over anything normal is 0.
float quotient(float a, float b) {
    uint a_bits = floatBitsToUint(a);
    uint b_bits = floatBitsToUint(b);
    uint sign_bit = (a_bits ^ b_bits) & 0x80000000u;
    int a_exponent = int((a_bits >> 23) & 255u);
    int b_exponent = int((b_bits >> 23) & 255u);
    uint ma = (a_bits & 0x7fffffu) | 0x800000u;
    uint mb = (b_bits & 0x7fffffu) | 0x800000u;
    bool larger = ma >= mb;
    int exponent = a_exponent - b_exponent + (larger ? 127 : 126);
    // The mantissa of the quotient in 24 bits; none lies half-way between two, since the divisor has no more bits.
    float inverse = 1.0 / float(mb);
    uint estimate = uint(float(ma) * inverse * (larger ? 8388608.0 : 16777216.0));
    // Small, so that the lower half of the product is enough.
    int rest = int((ma << (larger ? 23u : 24u)) - estimate * mb);
    int off = int(floor(float(rest) * inverse + 0.5));
    int divisor = int(mb);
    int twice = 2 * (rest - off * divisor);
    off += twice > divisor ? 1 : twice < -divisor ? -1 : 0;
    // A mantissa that was rounded up to two carries into the exponent.
    uint bits = sign_bit | ((uint(exponent) << 23) + (estimate + uint(off) - 0x800000u));
    bool is_normal = a_exponent - 1 < 254 && a_exponent > 0 && b_exponent > 0 && b_exponent < 255 && exponent > 0 && exponent < 255;
    if (is_normal) return uintBitsToFloat(bits);
    if ((a_bits << 1) == 0u && b_exponent > 0 && b_exponent < 255) return uintBitsToFloat(sign_bit);
    return a / b;
}

// Of a number of 0 or more; of others that are not normal it is left to the device.
float square_root(float a) {
    uint a_bits = floatBitsToUint(a);
    uint a_exponent = a_bits >> 23;
    uint ma = (a_bits & 0x7fffffu) | 0x800000u;
    // The radicand in 47 or 48 bits, so that the exponent is even and the root has 24 bits.
    bool even = (a_exponent & 1u) == 0u;
    float radicand = float(ma) * (even ? 16777216.0 : 8388608.0);
    float inverse = inversesqrt(radicand);
    uint estimate = uint(radicand * inverse);
    // Small, so that the lower half of the square is enough.
    int rest = int((ma << (even ? 24u : 23u)) - estimate * estimate);
    int off = int(floor(float(rest) * (0.5 * inverse) + 0.5));
    int root = int(estimate) + off;
    rest -= off * (int(estimate) + root);
    // The root's halves to the next whole numbers are at root^2 + root + 1/4 and root^2 - root + 1/4.
    root += rest > root ? 1 : rest <= -root ? -1 : 0;
    if (a_exponent > 0u && a_exponent < 255u) return uintBitsToFloat((((a_exponent + 127u) >> 1) << 23) + uint(root) - 0x800000u);
    if (a == 0.0) return a;
    return sqrt(a);
}

#endif
