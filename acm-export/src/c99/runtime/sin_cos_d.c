/* Sine and cosine: quarter turns are taken off in three pieces of pi/2, then Taylor's polynomials. */
static void sin_cos_d(double x, double *sine, double *cosine)
{
    double s = 1.0, c = 1.0, r, square;
    int64_t n;
    if (!(x > -1e12 && x < 1e12)) {
        *sine = x - x;
        *cosine = x - x;
        return;
    }
    n = (int64_t)(x * 0.63661977236758134 + (x < 0.0 ? -0.5 : 0.5));
    r = x - (double)n * 1.57079632673412561417e+00;
    r = r - (double)n * 6.07710050630396597660e-11;
    r = r - (double)n * 2.02226624879595063154e-21;
    square = r * r;
    for (int k = 9; k > 0; --k) {
        s = 1.0 - s * square / (double)(2 * k * (2 * k + 1));
        c = 1.0 - c * square / (double)(2 * k * (2 * k - 1));
    }
    s *= r;
    switch (((n % 4) + 4) % 4) {
    case 0: *sine = s; *cosine = c; break;
    case 1: *sine = c; *cosine = -s; break;
    case 2: *sine = -s; *cosine = -c; break;
    default: *sine = -c; *cosine = s; break;
    }
}
