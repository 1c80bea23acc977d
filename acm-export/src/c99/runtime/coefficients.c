/* Coefficients of the exponential of a rotation by the angle t, in x = t^2:
 *   a = sin t / t,   b = (1 - cos t)/t^2,   c = (t - sin t)/t^3
 * Below two radians by series; beyond, from half the angle: a = a' (1 - x' b'), b = a'^2/2, c = (1 - a)/x. */
static const double SERIES_D[10] = {
    0.041666666666666664, -0.001388888888888889, 2.48015873015873e-05, -2.755731922398589e-07, 2.08767569878681e-09,
    -1.1470745597729725e-11, 4.779477332387385e-14, -1.5619206968586225e-16, 4.110317623312165e-19, -8.896791392450574e-22,
};
static const double SERIES_E[10] = {
    0.008333333333333333, -0.0001984126984126984, 2.7557319223985893e-06, -2.505210838544172e-08, 1.6059043836821613e-10,
    -7.647163731819816e-13, 2.8114572543455206e-15, -8.22063524662433e-18, 1.9572941063391263e-20, -3.868170170630684e-23,
};

typedef struct {
    double a, b, c;
} coefficients;

static coefficients coefficients_at(double x)
{
    coefficients k;
    double d = 0.0, e = 0.0, y = x;
    int halvings = 0;
    if (!(x < 1e30)) {
        k.a = k.b = k.c = (x - x) / (x - x);
        return k;
    }
    while (y >= 4.0) {
        y *= 0.25;
        ++halvings;
    }
    for (int n = 9; n >= 0; --n) {
        d = SERIES_D[n] + d * y;
        e = SERIES_E[n] + e * y;
    }
    k.c = 1.0 / 6.0 - y * e;
    k.b = 0.5 - y * d;
    k.a = 1.0 - y * k.c;
    for (; halvings > 0; --halvings) {
        const double a = k.a;
        k.a = a * (1.0 - y * k.b);
        k.b = 0.5 * a * a;
        y *= 4.0;
        k.c = (1.0 - k.a) / y;
    }
    return k;
}
