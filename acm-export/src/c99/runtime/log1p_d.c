/* ln(1 + x) for 0 <= x: ln 2 for each halving of 1 + x, and 2 artanh of the rest. */
static double log1p_d(double x)
{
    double u = 1.0 + x, halvings = 0.0, s, square, sum = 0.0;
    if (!(u < 1e300)) {
        return u;
    }
    while (u > 1.5) {
        u *= 0.5;
        halvings += 1.0;
    }
    s = halvings > 0.0 ? (u - 1.0) / (u + 1.0) : x / (2.0 + x);
    square = s * s;
    for (int k = 23; k > 0; k -= 2) {
        sum = sum * square + 1.0 / (double)k;
    }
    return 2.0 * s * sum + halvings * 0.6931471805599453;
}
