/* First-order lag whose time constant depends on its input and on where it is: tau b(x, z) z' = x - z. Parts of an interval, each
 * exact for the tau of the means at both ends, found by two passes; pace is b, with parameters v. */
static double varying_lag_step(double time, double x, double tau, double (*pace)(double, double, const double *),
                               const double *v, $whole_lag *m)
{
    if (m->started && time > m->time && tau > 1e-9) {
        const int parts = parts_of(time - m->time, tau * pace(x, m->y, v));
        const double h = (time - m->time) / (double)parts;
        double past = m->x;
        for (int part = 1; part <= parts; ++part) {
            const double to = part == parts ? x : m->x + (x - m->x) * (double)part / (double)parts;
            const double start = m->y;
            for (int pass = 0; pass < 2; ++pass) {
                m->y = relax(start, past, to, h, tau * pace(0.5 * (past + to), 0.5 * (start + m->y), v));
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
