/* First-order lag with one time constant up and another down: up z' = x - z where x > z, down z' = x - z where x < z. The input is
 * straight between samples, and z meets it at most once in a piece. */
static double asymmetric_lag_step(double time, double x, double up, double down, $whole_lag *m)
{
    const double h = m->started ? time - m->time : 0.0;
    const double ahead = m->y == m->x ? x - m->x : m->x - m->y;
    const double tau = ahead < 0.0 ? down : up, other = ahead < 0.0 ? up : down;
    const double next = h > 0.0 && tau > 1e-9 ? relax(m->y, m->x, x, h, tau) : x;
    if (m->started && up != down && (ahead < 0.0 ? next < x : next > x)) {
        const double slope = (x - m->x) / h, share = (m->x - m->y) / (-slope * tau);
        const double meets = tau * log1p_d(share > 0.0 ? share : 0.0), left = h - (meets < h ? meets : h);
        m->y = left > 0.0 && other > 1e-9 ? relax(x - slope * left, x - slope * left, x, left, other) : x;
    } else {
        m->y = next;
    }
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
