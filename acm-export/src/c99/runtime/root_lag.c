/* Level of a vessel that empties through an orifice: tau z' = 2 (sqrt(1 + bend x) - sqrt(1 + bend z))/bend, a lag of the time constant
 * tau (sqrt(1 + bend x) + sqrt(1 + bend z))/2. Four parts of an interval, each exact for that of the means, found by two passes. */
static double level_root(double z, double bend)
{
    const double inside = 1.0 + bend * z;
    return sqrt_d(inside > 1e-12 ? inside : 1e-12);
}

static double root_lag_step(double time, double x, double tau, double bend, $name_lag *m)
{
    if (m->started && time > m->time && tau > 1e-9) {
        const double h = (time - m->time) / 4.0;
        double past = m->x;
        for (int part = 1; part <= 4; ++part) {
            const double to = part == 4 ? x : m->x + (x - m->x) * (double)part / 4.0;
            const double start = m->y, flows_in = level_root(0.5 * (past + to), bend);
            for (int pass = 0; pass < 2; ++pass) {
                const double roots = flows_in + level_root(0.5 * (start + m->y), bend);
                m->y = relax(start, past, to, h, tau * 0.5 * roots);
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
