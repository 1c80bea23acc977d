/* What a spring adds to a linear one: -k (z - c)^3, or below 0 as gravity on a pendulum, (z - c) - sin(b (z - c))/b with
 * b = sqrt(-6 k). The slope of 1 - that is its stiffness. */
static double stiff_lag_pull(double z, double k, double c, double *stiffness)
{
    const double o = z - c;
    if (k < 0.0) {
        const double bend = sqrt_d(-6.0 * k);
        double sine, cosine;
        sin_cos_d(bend * o, &sine, &cosine);
        *stiffness = cosine;
        return o - sine / bend;
    }
    *stiffness = 1.0 + 3.0 * k * o * o;
    return -k * o * o * o;
}

/* Place z at which the spring rests behind x, by Newton's method; x where that does not converge. */
static double stiff_lag_at_rest(double x, double k, double c)
{
    double z = x, stiffness;
    for (int step = 0; step < 30; ++step) {
        const double pull = stiff_lag_pull(z, k, c, &stiffness);
        z += (x + pull - z) / stiffness;
    }
    const double off = x + stiff_lag_pull(z, k, c, &stiffness) - z;
    return off < 1e-9 && off > -1e-9 && z - x < 30.0 && z - x > -30.0 ? z : x;
}

/* Dry friction over a part, r = force s/sqrt(s^2 + 4 transition^2) with s = sum - brakes r, by Newton's method. */
static double dry_friction_over(double force, double transition, double sum, double brakes)
{
    const double width = 2.0 * (transition > 1e-12 ? transition : 1e-12), wide = width * width;
    const double size = sum < 0.0 ? -sum : sum;
    if (!(force > 0.0) || !(size > 0.0 && size <= 1.7e308)) {
        return 0.0;
    }
    const double most = force * size / sqrt_d(size * size + wide);
    double r = brakes * most > size ? size / brakes : most;
    for (int step = 0; step < 50; ++step) {
        const double speed = size - brakes * r, square = speed * speed + wide, steep = force / sqrt_d(square);
        const double change = (r - steep * speed) / (1.0 + brakes * steep * wide / square);
        r -= change;
        if (change <= 1e-9 * force && change >= -1e-9 * force) {
            break;
        }
    }
    return sum < 0.0 ? -r : r;
}

/* Second-order lag behind a spring: z'' + 2 d w z' + w^2 (z - pull(z) + f z'/sqrt(z'^2 + t^2)) = w^2 x. Four parts of an
 * interval; in each the linear part is exact, the pull is an input beside x, corrected twice, and the friction is constant. z stays within 30 of x. */
static double stiff_lag_step(double time, double x, double unit, double damping, double k, double c, double force, double transition,
                             $name_spring *m)
{
    if (m->started && time > m->time && unit > 1e-9) {
        const double h = (time - m->time) / 4.0;
        double cosine, sine, past = m->x;
        swing(h / unit, damping, &cosine, &sine);
        for (int part = 1; part <= 4; ++part) {
            const double to = part == 4 ? x : m->x + (x - m->x) * (double)part / 4.0;
            double stiffness;
            const double before = stiff_lag_pull(m->y, k, c, &stiffness);
            double pull = before, z = m->y, speed = m->speed, friction = 0.0;
            for (int pass = 0; pass < 3; ++pass) {
                const double from = past + before, end = to + pull;
                const double slope = (end - from) / h, behind = 2.0 * damping * slope * unit;
                const double e = m->y - from + behind, rate = m->speed - slope;
                z = end - behind + (cosine + damping * sine) * e + sine * unit * rate;
                speed = slope + (cosine - damping * sine) * rate - sine / unit * e;
                if (pass == 0) {
                    friction = dry_friction_over(force, transition, m->speed + speed, sine / unit);
                }
                z -= (1.0 - cosine - damping * sine) * friction;
                speed -= sine / unit * friction;
                pull = stiff_lag_pull(z, k, c, &stiffness);
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
