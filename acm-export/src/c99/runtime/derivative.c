/* First and second derivative and smoothed value d of a signal at the newest of `count` samples in a ring with `room` places: a
 * parabola by least squares with weights (1 - u^2)^2, u = (t - newest)/h. No window is narrower than 1.6 times the reach of the last
 * five samples; where samples do not tell a parabola, d is the slope of the line through the last three, and the sample itself. The
 * value is that of the sample at h = 0, and on the way to the narrowest window as far between the two as h is. */
static void derivative(const double *time, const double *x, int first, int count, int room, double h, double d[3])
{
    const int end = first + count - 1, newest = end < room ? end : end - room;
    const int early = count > 5 ? end - 4 : first, fifth = early < room ? early : early - room;
    const double narrowest = 1.6 * (time[newest] - time[fifth]);
    const int wide = h > 0.0 && narrowest > 0.0 && h >= narrowest;
    const double width = wide ? h : narrowest;
    const int last = wide || count < 9 ? count : 9, few = count < 3 ? count : 3;
    double s[8] = { 0.0 }, t2, t3, t4, y1, y2, determinant;
    for (int k = 0; k < last; ++k) {
        const int at = end - k < room ? end - k : end - k - room;
        const double u = (time[at] - time[newest]) / width, y = x[at] - x[newest];
        const double inside = 1.0 - u * u, weight = inside > 0.0 ? inside * inside : 0.0;
        if (wide && !(inside > 0.0)) {
            break;
        }
        s[0] += weight;
        s[1] += weight * u;
        s[2] += weight * u * u;
        s[3] += weight * u * u * u;
        s[4] += weight * u * u * u * u;
        s[5] += weight * y;
        s[6] += weight * y * u;
        s[7] += weight * y * u * u;
    }
    t2 = s[2] - s[1] / s[0] * s[1];
    t3 = s[3] - s[2] / s[0] * s[1];
    t4 = s[4] - s[2] / s[0] * s[2];
    y1 = s[6] - s[1] / s[0] * s[5];
    y2 = s[7] - s[2] / s[0] * s[5];
    determinant = t2 * t4 - t3 * t3;
    if (s[0] > 0.0 && determinant > 1e-9 * t2 * t4) {
        d[0] = (t4 * y1 - t3 * y2) / determinant / width;
        d[1] = 2.0 * ((t2 * y2 - t3 * y1) / determinant) / (width * width);
        d[2] = s[5] / s[0] - d[0] * width * (s[1] / s[0]) - 0.5 * d[1] * width * width * (s[2] / s[0]);
        d[2] = x[newest] + (wide ? 1.0 : h > 0.0 ? h / narrowest : 0.0) * d[2];
        return;
    }
    for (int k = 0; k < 4; ++k) {
        s[k] = 0.0;
    }
    for (int k = 0; k < few; ++k) {
        const int at = end - k < room ? end - k : end - k - room;
        s[0] += (time[at] - time[newest]) / (double)few;
        s[1] += (x[at] - x[newest]) / (double)few;
    }
    for (int k = 0; k < few; ++k) {
        const int at = end - k < room ? end - k : end - k - room;
        const double t = time[at] - time[newest] - s[0];
        s[2] += t * t;
        s[3] += t * (x[at] - x[newest] - s[1]);
    }
    d[0] = s[2] > 0.0 ? s[3] / s[2] : 0.0;
    d[1] = 0.0;
    d[2] = x[newest];
}
