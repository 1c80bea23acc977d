/* Bristles of LuGre friction: s d' = v - |v| d/g(v), g = 1 + r exp(-(v/w)^2), for a signal that is straight between samples. */
static double lugre_step(double time, double x, double presliding, double surplus, double w, $name_lag *m)
{
    const double step = m->started ? x - m->x : 0.0;
    if (step != 0.0) {
        const double sign = step < 0.0 ? -1.0 : 1.0, d = sign * m->y, h = time - m->time;
        const double least = presliding > 2.2250738585072014e-308 ? presliding : 2.2250738585072014e-308;
        const double u = h > 0.0 ? step / h / w : 1e3, most = 1.0 + surplus * exp_d(-u * u);
        m->y = sign * (d - (most - d) * expm1_d(-sign * step / least / most));
    }
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
