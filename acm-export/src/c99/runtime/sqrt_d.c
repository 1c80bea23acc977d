/* Square root of x >= 0 by Newton's iteration from half the exponent. */
static double sqrt_d(double x)
{
    uint64_t bits;
    double y;
    if (!(x > 1e-300)) {
        return x > 0.0 ? 0.0 : x;
    }
    memcpy(&bits, &x, sizeof bits);
    bits = (bits >> 1) + ((uint64_t)1023 << 51);
    memcpy(&y, &bits, sizeof y);
    for (int k = 0; k < 5; ++k) {
        y = 0.5 * (y + x / y);
    }
    return y;
}
