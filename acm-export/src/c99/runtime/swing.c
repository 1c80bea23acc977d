/* exp(-z a) cos(s a) and exp(-z a) sin(s a)/s with s = sqrt(1 - z^2), continued through z = 1. */
static void swing(double angle, double damping, double *cosine, double *sine)
{
    const double square = 1.0 - damping * damping;
    const double s = sqrt_d(square < 0.0 ? -square : square);
    const double fade = exp_d(-damping * angle);
    if (s * angle < 1e-4) {
        const double bent = square * angle * angle;
        *cosine = fade * (1.0 - bent / 2.0);
        *sine = fade * angle * (1.0 - bent / 6.0);
    } else if (square > 0.0) {
        double si, co;
        sin_cos_d(s * angle, &si, &co);
        *cosine = fade * co;
        *sine = fade * si / s;
    } else {
        const double slow = exp_d(-(damping - s) * angle), fast = exp_d(-(damping + s) * angle);
        *cosine = 0.5 * (slow + fast);
        *sine = 0.5 * (slow - fast) / s;
    }
}
