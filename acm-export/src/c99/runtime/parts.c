/* Number of parts of an interval h: the fewest of 1, 2 and 4 that are short beside a time constant. */
static int parts_of(double h, double constant)
{
    return h <= 0.1 * constant ? 1 : h <= 0.2 * constant ? 2 : 4;
}
