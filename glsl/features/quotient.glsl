// A quotient that every device rounds alike: to the nearest, of equals to the even one, as processors do.

#ifndef FEATURES_QUOTIENT
#define FEATURES_QUOTIENT

// Only what is not negative over what is positive. Numbers that are not normal are left to the device.
float quotient(float a, float b) {
    uint a_bits = floatBitsToUint(a);
    uint b_bits = floatBitsToUint(b);
    uint a_exponent = a_bits >> 23;
    uint b_exponent = b_bits >> 23;
    uint ma = (a_bits & 0x7fffffu) | 0x800000u;
    uint mb = (b_bits & 0x7fffffu) | 0x800000u;
    bool larger = ma >= mb;
    int exponent = int(a_exponent) - int(b_exponent) + (larger ? 127 : 126);
    if (a_exponent == 0u || a_exponent > 254u || b_exponent == 0u || b_exponent > 254u || exponent < 1 || exponent > 254) return a / b;
    // The device's own quotient is a few units off at most. What is left of the dividend says how many; it is small, so that
    // the lower half of the product is enough.
    uint shift = larger ? 23u : 24u;
    uint q = uint(float(ma) / float(mb) * (larger ? 8388608.0 : 16777216.0));
    int divisor = int(mb);
    int rest = int((ma << shift) - q * mb);
    for (int i = 0; i < 8 && rest < 0; i++) {
        q -= 1u;
        rest += divisor;
    }
    for (int i = 0; i < 8 && rest >= divisor; i++) {
        q += 1u;
        rest -= divisor;
    }
    if (2 * rest > divisor || (2 * rest == divisor && (q & 1u) == 1u)) q += 1u;
    // A mantissa that was rounded up to two carries into the exponent.
    return uintBitsToFloat((uint(exponent) << 23) + (q - 0x800000u));
}

#endif
