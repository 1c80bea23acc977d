/* First-order lag with dry friction: tau z' = x - z - w sgn z; z rests at zero while |x| <= w. The input is straight between
 * samples; where z reaches zero is found by bisection. */
static double stick_lag_step(double time, double x, double tau, double width, $whole_lag *m)
{
    if (!(tau > 1e-9)) {
        m->y = x;
    } else if (!m->started) {
        m->y = x > width ? x - width : (x < -width ? x + width : 0.0);
    } else if (time > m->time) {
        const double h = time - m->time, from = m->x, slope = (x - from) / h;
        double z = m->y, t = 0.0;
        for (int turn = 0; turn < 4; ++turn) {
            const double here = from + slope * t;
            if (z == 0.0 && here <= width && here >= -width) {
                const double leaves = slope == 0.0 ? h : t + ((slope > 0.0 ? width : -width) - here) / slope;
                t = leaves < t ? t : leaves;
                if (t >= h) {
                    break;
                }
            }
            const double input = from + slope * t, heading = z != 0.0 ? z : (input != 0.0 ? input : slope);
            const double sign = heading < 0.0 ? -1.0 : 1.0, w = width * sign, start = t, past = input - w;
            const double next = relax(z, past, x - w, h - start, tau);
            if (next * sign >= 0.0) {
                z = next;
                break;
            }
            double low = start, high = h;
            for (int k = 0; k < 50; ++k) {
                const double middle = 0.5 * (low + high);
                const double at = relax(z, past, from + slope * middle - w, middle - start, tau);
                if (at * sign > 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            t = high;
            z = 0.0;
        }
        m->y = z;
    } else {
        m->y = x > width ? x - width : (x < -width ? x + width : 0.0);
    }
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
