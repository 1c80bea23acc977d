/* Parameters that depend on a signal s: base + slope s, within the bounds of each. */
static void values(double *v, int count, const double (*table)[4], double s)
{
    for (int j = 0; j < count; ++j) {
        const double value = table[j][0] + table[j][1] * s;
        const double above = value > table[j][2] ? value : table[j][2];
        v[j] = above < table[j][3] ? above : table[j][3];
    }
}
