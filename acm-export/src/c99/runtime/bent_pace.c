/* b(z) = f + (1 - f) (1 + bend z) (1 + curve z^2), or f + (1 - f) (1 + bend z)/(1 - curve z^2) where curve is below 0, with |z| <= 1 and
 * 1 + bend z >= 1/1000; v is bend, curve, f. */
static double bent_pace(double x, double z, const double *v)
{
    const double middle = z < -1.0 ? -1.0 : (z > 1.0 ? 1.0 : z);
    const double along = 1.0 + v[0] * middle;
    const double even = 1.0 + (v[1] < 0.0 ? -v[1] : v[1]) * middle * middle;
    (void)x;
    return v[2] + (1.0 - v[2]) * (along > 0.001 ? along : 0.001) * (v[1] < 0.0 ? 1.0 / even : even);
}
