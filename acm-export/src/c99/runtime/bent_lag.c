/* First-order lag whose time constant depends on where it is: tau b(z) z' = x - z, b = f + (1 - f) (1 + bend z) (1 + curve z^2), or
 * f + (1 - f) (1 + bend z)/(1 - curve z^2) where curve is below 0, with |z| <= 1 and 1 + bend z >= 1/20. Four parts of an interval, each exact for the tau of the mean of z at both ends, found by two passes. */
static double bent_lag_step(double time, double x, double tau, double bend, double curve, double f, $name_lag *m)
{
    if (m->started && time > m->time && tau > 1e-9) {
        const double h = (time - m->time) / 4.0;
        double past = m->x;
        for (int part = 1; part <= 4; ++part) {
            const double to = part == 4 ? x : m->x + (x - m->x) * (double)part / 4.0;
            const double start = m->y;
            for (int pass = 0; pass < 2; ++pass) {
                const double mean = 0.5 * (start + m->y);
                const double middle = mean < -1.0 ? -1.0 : (mean > 1.0 ? 1.0 : mean);
                const double along = 1.0 + bend * middle;
                const double even = 1.0 + (curve < 0.0 ? -curve : curve) * middle * middle;
                const double factor = f + (1.0 - f) * (along > 0.05 ? along : 0.05) * (curve < 0.0 ? 1.0 / even : even);
                m->y = relax(start, past, to, h, tau * factor);
            }
            past = to;
        }
    } else {
        m->y = x;
    }
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
