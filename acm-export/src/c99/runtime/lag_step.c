static double lag_step(double time, double x, double tau, $whole_lag *m)
{
    const double h = m->started ? time - m->time : 0.0;
    m->y = h > 0.0 && tau > 1e-9 ? relax(m->y, m->x, x, h, tau) : x;
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
