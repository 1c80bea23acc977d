/* exp x - 1, without loss at small x. */
static double expm1_d(double x)
{
    double sum = 1.0;
    if (x < -0.35 || x > 0.35) {
        return exp_d(x) - 1.0;
    }
    for (int k = 15; k > 1; --k) {
        sum = 1.0 + sum * x / (double)k;
    }
    return x * sum;
}
