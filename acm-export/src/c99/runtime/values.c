/* Parameters that depend on a signal s: base + slope s + bow (s - a)(s - b), within the bounds of each. */
static void values(double *v, int count, const double (*table)[5], double s, double a, double b)
{
    for (int j = 0; j < count; ++j) {
        const double value = table[j][0] + table[j][1] * s + table[j][2] * (s - a) * (s - b);
        const double above = value > table[j][3] ? value : table[j][3];
        v[j] = above < table[j][4] ? above : table[j][4];
    }
}
