/* A vessel that empties through an orifice and overflows: v is tau, bend, half a range over the flow out of the full vessel, and the share
 * of what overflows that goes on with it. */
static double overflow_step(double time, double x, const double *v, $whole_lag *m)
{
    const double z = varying_lag_step(time, x, v[0], flow_pace, v + 1, m);
    const double full = v[2] > 0.0 ? 1.0 / v[2] - 1.0 : z + 1.0;
    if (z < full || v[0] <= 1e-9) {
        return z;
    }
    m->y = full;
    return full + v[3] * (x > full ? x - full : 0.0);
}
