/* Bouc-Wen state of exponent 1 in units of its saturation: width dz = dx - (1 + a)/2 |dx| z - (1 - a)/2 dx |z|. With a = 1 it
 * is Dahl's state, width dd = (sgn v - d) |dx|. */
static double away(double z, double way, double a)
{
    const int curved = a > 1e-9 || a < -1e-9;
    double returned, back;
    if (z >= 0.0 || a == 1.0) {
        return z - (1.0 - z) * expm1_d(-way);
    }
    returned = curved ? z + (z - 1.0 / a) * expm1_d(-a * way) : z + way;
    if (returned <= 0.0) {
        return returned;
    }
    back = curved ? log1p_d(-a * z) / a : -z;
    return -expm1_d(back - way);
}

static double bouc_wen_step(double x, double width, double a, $whole_slip *m)
{
    const double step = m->started ? x - m->x : 0.0;
    if (step != 0.0) {
        const double sign = step < 0.0 ? -1.0 : 1.0;
        m->z = sign * away(sign * m->z, sign * step / (width > 2.2250738585072014e-308 ? width : 2.2250738585072014e-308), a);
    }
    m->started = 1;
    m->x = x;
    return m->z;
}
