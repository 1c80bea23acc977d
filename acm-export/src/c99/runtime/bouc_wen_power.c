/* Bouc-Wen state with v = (width, a, exponent n, state at the first sample) in units of its saturation: width dz = dx - (1 + a)/2 |dx|
 * |z|^(n-1) z - (1 - a)/2 dx |z|^n. Classical Runge-Kutta, in pieces that are short beside width/n. */
static double yield(double z, double a, double n)
{
    const double size = z < 0.0 ? -z : z;
    const double log_size = size > 1.0 ? log1p_d(size - 1.0) : -log1p_d(size > 0.0 ? 1.0 / size - 1.0 : 1e300);
    const double power = size > 0.0 ? exp_d(n * log_size) : 0.0;
    return 1.0 - power * (z < 0.0 ? -a : 1.0);
}

static double bouc_wen_power_step(double x, const double *v, $whole_slip *m)
{
    const double a = v[1], n = v[2], width = v[0] > 2.2250738585072014e-308 ? v[0] : 2.2250738585072014e-308;
    const double step = m->started ? x - m->x : 0.0, sign = step < 0.0 ? -1.0 : 1.0;
    if (!m->started) {
        m->z = v[3];
    }
    if (step != 0.0) {
        const double way = sign * step / width;
        double z = sign * m->z, left = way * n / 0.5, pieces = 0.0, h;
        /* No more pieces than saturate any state. */
        while (pieces < left && pieces < 4096.0) {
            pieces += 1.0;
        }
        h = pieces < 4096.0 ? way / pieces : 0.5 / n;
        for (; pieces > 0.0; pieces -= 1.0) {
            const double k1 = yield(z, a, n), k2 = yield(z + 0.5 * h * k1, a, n);
            const double k3 = yield(z + 0.5 * h * k2, a, n), k4 = yield(z + h * k3, a, n);
            z += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            if (z > 1.0 - 1e-9) {
                z = 1.0;
                break;
            }
        }
        m->z = sign * z;
    }
    m->started = 1;
    m->x = x;
    return m->z;
}
