/* A vessel that empties through an orifice is a lag with b(x, z) = (sqrt(1 + bend x) + sqrt(1 + bend z))/2; v is bend. */
static double level_root(double z, double bend)
{
    const double inside = 1.0 + bend * z;
    return sqrt_d(inside > 1e-12 ? inside : 1e-12);
}

static double root_pace(double x, double z, const double *v)
{
    return 0.5 * (level_root(x, v[0]) + level_root(z, v[0]));
}
