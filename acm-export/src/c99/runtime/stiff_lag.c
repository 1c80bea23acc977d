/* What a spring adds to a linear one: -k (z - c)^3, or below 0 as gravity on a pendulum, (z - c) - sin(b (z - c))/b with
 * b = sqrt(-6 k); its slope with it. */
static double stiff_lag_pull(double z, double k, double c, double *slope)
{
    const double o = z - c;
    if (k < 0.0) {
        const double bend = sqrt_d(-6.0 * k);
        double sine, cosine;
        sin_cos_d(bend * o, &sine, &cosine);
        *slope = 1.0 - cosine;
        return o - sine / bend;
    }
    *slope = -3.0 * k * o * o;
    return -k * o * o * o;
}

/* Place z at which the spring rests behind x, by Newton's method; x where that does not converge. */
static double stiff_lag_at_rest(double x, double k, double c)
{
    double z = x, slope;
    for (int step = 0; step < 30; ++step) {
        const double pull = stiff_lag_pull(z, k, c, &slope);
        z += (x + pull - z) / (1.0 - slope);
    }
    const double off = x + stiff_lag_pull(z, k, c, &slope) - z;
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

/* Second-order lag behind a spring: z'' + 2 d w z' + w^2 (z - pull(z) + f z'/sqrt(z'^2 + t^2)) = w^2 x. In each part of an
 * interval the linear part is exact, the pull is an input beside x, corrected by a Newton step, and the friction is constant. z stays
 * within 30 of x. */
static double stiff_lag_step(double time, double x, double unit, double damping, double k, double c, double force, double transition,
                             $whole_spring *m)
{
    double slope;
    if (m->started && time > m->time && unit > 1e-9) {
        const int parts = parts_of(time - m->time, k > 0.0 ? unit / sqrt_d(1.0 + 3.0 * k) : unit);
        const double h = (time - m->time) / (double)parts;
        double cosine, sine, past = m->x, pull = stiff_lag_pull(m->y, k, c, &slope);
        swing(h / unit, damping, &cosine, &sine);
        const double stays = cosine + damping * sine, keeps = cosine - damping * sine, behind = 2.0 * damping * unit;
        /* What an input that is larger by 1 at the end of a part adds to z and to its speed. */
        const double moves = 1.0 + (behind * (stays - 1.0) - sine * unit) / h;
        const double speeds_up = (1.0 - keeps - sine / unit * behind) / h;
        for (int part = 1; part <= parts; ++part) {
            const double to = part == parts ? x : m->x + (x - m->x) * (double)part / (double)parts;
            const double from = past + pull, off = m->y - from, rise = to - from;
            double free = to + stays * off + sine * unit * m->speed + (moves - 1.0) * rise;
            double fast = keeps * m->speed - sine / unit * off + speeds_up * rise;
            const double friction = dry_friction_over(force, transition, m->speed + fast + speeds_up * pull, sine / unit);
            free -= (1.0 - stays) * friction;
            fast -= sine / unit * friction;
            const double predicted = free + moves * pull, near = stiff_lag_pull(predicted, k, c, &slope);
            if (moves * slope > 0.5) {
                slope = 0.5 / moves;
            }
            const double correction = moves * (near - pull) / (1.0 - moves * slope), z = predicted + correction;
            pull = near + slope * correction;
            if (z - to < 30.0 && z - to > -30.0) {
                m->y = z;
                m->speed = fast + speeds_up * pull;
            } else {
                m->y = z == z ? (z > to ? to + 30.0 : to - 30.0) : to;
                m->speed = 0.0;
                pull = stiff_lag_pull(m->y, k, c, &slope);
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
