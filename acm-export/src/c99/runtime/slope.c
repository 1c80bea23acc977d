/* Slope of the straight line through a sample and the two before it, per second. */
static double slope_step(double time, double x, $whole_slope *m)
{
    double mean_time = 0.0, mean = 0.0, spread = 0.0, joint = 0.0;
    if (m->count == 3) {
        for (int k = 0; k < 2; ++k) {
            m->time[k] = m->time[k + 1];
            m->x[k] = m->x[k + 1];
        }
        m->count = 2;
    }
    m->time[m->count] = time;
    m->x[m->count] = x;
    m->count += 1;
    for (int k = 0; k < m->count; ++k) {
        mean_time += m->time[k] / (double)m->count;
        mean += m->x[k] / (double)m->count;
    }
    for (int k = 0; k < m->count; ++k) {
        spread += (m->time[k] - mean_time) * (m->time[k] - mean_time);
        joint += (m->time[k] - mean_time) * (m->x[k] - mean);
    }
    return spread > 0.0 ? joint / spread : 0.0;
}
