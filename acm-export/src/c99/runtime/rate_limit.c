/* Follows a signal that is straight between samples at no more than the speed 1/slowness; 0 is no limit. */
static double rate_limit_step(double time, double x, double slowness, $whole_lag *m)
{
    const double h = m->started ? time - m->time : 0.0;
    if (h > 0.0 && slowness > 0.0) {
        const double speed = 1.0 / slowness, ahead = m->x - m->y;
        const double way = ahead > 0.0 ? 1.0 : (ahead < 0.0 ? -1.0 : 0.0);
        const double run = way * speed, distance = way * ahead;
        const double closing = (run - (x - m->x) / h) * way;
        const double meets = way == 0.0 ? 0.0 : (closing > 0.0 ? distance / closing : h);
        if (way != 0.0 && meets >= h) {
            m->y += run * h;
        } else {
            const double reach = speed * (h - meets), met = m->y + run * meets;
            const double above = x > met - reach ? x : met - reach;
            m->y = above < met + reach ? above : met + reach;
        }
    } else {
        m->y = x;
    }
    m->started = 1;
    m->time = time;
    m->x = x;
    return m->y;
}
