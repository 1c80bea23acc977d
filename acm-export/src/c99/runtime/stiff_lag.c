/* Place z at which a cubic spring rests, z + k (z - c)^3 = x, by Newton's method; x where that does not converge. */
static double stiff_lag_at_rest(double x, double k, double c)
{
    double z = x;
    for (int step = 0; step < 30; ++step) {
        const double o = z - c;
        z += (x - k * o * o * o - z) / (1.0 + 3.0 * k * o * o);
    }
    const double o = z - c, off = x - k * o * o * o - z;
    return off < 1e-9 && off > -1e-9 && z - x < 30.0 && z - x > -30.0 ? z : x;
}

/* Second-order lag whose spring is cubic: z'' + 2 d w z' + w^2 (z + k (z - c)^3) = w^2 x. Four parts of an interval; in each
 * the linear part is exact and the cubic part is an input beside x, corrected twice. z stays within 30 of x. */
static double stiff_lag_step(double time, double x, double unit, double damping, double k, double c, $name_spring *m)
{
    if (m->started && time > m->time && unit > 1e-9) {
        const double h = (time - m->time) / 4.0;
        double cosine, sine, past = m->x;
        swing(h / unit, damping, &cosine, &sine);
        for (int part = 1; part <= 4; ++part) {
            const double to = part == 4 ? x : m->x + (x - m->x) * (double)part / 4.0;
            const double o = m->y - c, before = -k * o * o * o;
            double pull = before, z = m->y, speed = m->speed;
            for (int pass = 0; pass < 3; ++pass) {
                const double from = past + before, end = to + pull;
                const double slope = (end - from) / h, behind = 2.0 * damping * slope * unit;
                const double e = m->y - from + behind, rate = m->speed - slope;
                z = end - behind + (cosine + damping * sine) * e + sine * unit * rate;
                speed = slope + (cosine - damping * sine) * rate - sine / unit * e;
                pull = -k * (z - c) * (z - c) * (z - c);
            }
            if (z - to < 30.0 && z - to > -30.0) {
                m->y = z;
                m->speed = speed;
            } else {
                m->y = z == z ? (z > to ? to + 30.0 : to - 30.0) : to;
                m->speed = 0.0;
            }
            past = to;
        }
    } else {
        m->y = unit > 1e-9 ? stiff_lag_at_rest(x, k, c) : x;
        m->speed = 0.0;
    }
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
