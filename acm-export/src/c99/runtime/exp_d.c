/* exp x in double precision, x held within -708 and 709: 2^n times Taylor's polynomial of the rest, |rest| <= ln(2)/2. */
static double exp_d(double x)
{
    const double z = x > -708.0 ? (x < 709.0 ? x : 709.0) : -708.0;
    const double turns = z * 1.4426950408889634;
    const int32_t n = (int32_t)(turns + (turns < 0.0 ? -0.5 : 0.5));
    const double r = (z - (double)n * 6.93147180369123816490e-01) - (double)n * 1.90821492927058770002e-10;
    const uint64_t bits = (uint64_t)(n + 1023) << 52;
    double power, sum = 1.0;
    for (int k = 14; k > 0; --k) {
        sum = 1.0 + sum * r / (double)k;
    }
    memcpy(&power, &bits, sizeof power);
    if (x < -708.0) {
        return 0.0;
    }
    return x == x ? sum * power : x;
}
