// Elementary functions of additions, multiplications and bit patterns alone, in a fixed order, so that every device repeats them to
// the bit; src/arithmetic/mod.rs holds the same operations.

#ifndef ARITHMETIC_ELEMENTARY
#define ARITHMETIC_ELEMENTARY

float inverse_root(float x) {
    precise float half_x = 0.5 * x;
    precise float y = uintBitsToFloat(0x5F3759DFu - (floatBitsToUint(x) >> 1));
    for (int i = 0; i < 3; i++) {
        precise float correction = 1.5 - half_x * y * y;
        y = y * correction;
    }
    return y;
}

float root(float x) {
    precise float r = x * inverse_root(x);
    return r;
}

float reciprocal(float x) {
    precise float y = inverse_root(x);
    precise float r = y * y;
    precise float refined = r + r * (1.0 - x * r);
    return refined;
}

float ln(float x) {
    const uint SQRT_HALF = 0x3F3504F3u;
    uint shifted = floatBitsToUint(x) - SQRT_HALF;
    int exponent = int(shifted) >> 23;
    float mantissa = uintBitsToFloat((shifted & 0x007FFFFFu) + SQRT_HALF);
    precise float less = mantissa - 1.0;
    precise float more = mantissa + 1.0;
    precise float t = less * reciprocal(more);
    precise float s = t * t;
    precise float series =
        1.0 + s * (0.333333343 + s * (0.2 + s * (0.142857149 + s * 0.111111112)));
    precise float whole = float(exponent) * 0.693147182;
    precise float twice = 2.0 * t;
    precise float sum = whole + twice * series;
    return sum;
}

float exp_of_negative(float x) {
    const float ROUND = 12582912.0;
    if (!(x >= -22.0)) return 0.0;
    precise float shifted = x * 1.44269502 + ROUND;
    precise float n = shifted - ROUND;
    precise float r = (x - n * 0.693359375) - n * -2.1219444e-4;
    precise float series =
        0.166666672 + r * (4.16666679e-2 + r * (8.33333377e-3 + r * (1.38888892e-3 + r * 1.98412701e-4)));
    precise float power = 1.0 + r * (1.0 + r * (0.5 + r * series));
    precise float scaled = power * uintBitsToFloat(uint(int(n) + 127) << 23);
    return scaled;
}

float real_power(float x, float exponent) {
    precise float logarithm = exponent * ln(x);
    return exp_of_negative(logarithm);
}

float sine_of_turns(float turns) {
    precise float rest = turns - floor(turns + 0.5);
    precise float folded = rest > 0.25 ? 0.5 - rest : (rest < -0.25 ? -0.5 - rest : rest);
    precise float s = folded * folded;
    precise float series = 81.60525 + s * (-76.70586 + s * (42.058693 + s * (-15.094642 + s * 3.8199525)));
    precise float sine = folded * (6.2831855 + s * (-41.3417 + s * series));
    return sine;
}

#endif
