/* max(0, d) whose kink is a parabola: 0 below -radius, (d + radius)^2/(4 radius) up to radius, d above it. */
static double corner(double d, double radius)
{
    if (d >= radius) {
        return d;
    }
    return d <= -radius ? 0.0 : (d + radius) * (d + radius) / (4.0 * radius);
}
