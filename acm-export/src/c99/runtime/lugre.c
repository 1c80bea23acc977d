/* Bristles of LuGre friction: s d' = v - |v| d/g(v), g = 1 + r exp(-(v/w)^2), for a speed that is straight between samples; each
 * side of a turn at its mean speed. */
static double slide(double d, double h, double mean, double presliding, double surplus, double w)
{
    const double least = presliding > 2.2250738585072014e-308 ? presliding : 2.2250738585072014e-308;
    const double sign = mean < 0.0 ? -1.0 : 1.0, u = mean / w, most = 1.0 + surplus * exp_d(-u * u);
    return sign * (sign * d - (most - sign * d) * expm1_d(-sign * mean * h / least / most));
}

static double lugre_step(double time, double rate, double presliding, double surplus, double w, $whole_lag *m)
{
    const double h = m->started ? time - m->time : 0.0, past = m->started ? m->x : rate;
    if (past * rate < 0.0) {
        const double turn = past / (past - rate);
        m->y = slide(m->y, turn * h, 0.5 * past, presliding, surplus, w);
        m->y = slide(m->y, (1.0 - turn) * h, 0.5 * rate, presliding, surplus, w);
    } else if (past != 0.0 || rate != 0.0) {
        m->y = slide(m->y, h, 0.5 * (past + rate), presliding, surplus, w);
    }
    m->started = 1;
    m->time = time;
    m->x = rate;
    return m->y;
}
