/* tanh x in double precision. */
static double tanh_d(double x)
{
    const double e = expm1_d(x < 0.0 ? 2.0 * x : -2.0 * x), t = -e / (2.0 + e);
    return x < 0.0 ? -t : t;
}
