/* A vessel that empties through an orifice is a lag with b(z) = 1 + bend z, 1/1000 and more; v is bend. */
static double flow_pace(double x, double z, const double *v)
{
    const double pace = 1.0 + v[0] * z;
    (void)x;
    return pace > 0.001 ? pace : 0.001;
}
