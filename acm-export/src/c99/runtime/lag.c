/* First-order lag, exact for a signal that is straight between samples: tau dy/dt = x - y, at rest at the first sample. */
static double relax(double y, double past, double x, double h, double tau)
{
    const double behind = (x - past) / h * tau;
    return x - behind + (y - past + behind) * exp_d(-h / tau);
}
