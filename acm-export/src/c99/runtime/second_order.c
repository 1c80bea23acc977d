/* Second-order lag y'' + 2 z w y' + w^2 y = w^2 x, exact for a signal that is straight between samples; unit = 1/w, s. */
static double second_order_step(double time, double x, double unit, double damping, $whole_spring *m)
{
    const double h = m->started ? time - m->time : 0.0;
    const double slope = h > 0.0 ? (x - m->x) / h : 0.0;
    if (h > 0.0 && unit > 1e-9) {
        const double behind = 2.0 * damping * slope * unit;
        const double e = m->y - m->x + behind, rate = m->speed - slope;
        double cosine, sine;
        swing(h / unit, damping, &cosine, &sine);
        m->y = x - behind + (cosine + damping * sine) * e + sine * unit * rate;
        m->speed = slope + (cosine - damping * sine) * rate - sine / unit * e;
    } else {
        m->y = x;
        m->speed = slope;
    }
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
