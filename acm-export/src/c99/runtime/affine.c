/* y = b + W x. `w` holds b first, then one row for each input: `outputs` columns, a multiple of eight, and rows four at a time,
 * so that a compiler that knows vector registers uses them. */
static void affine(const float *restrict w, int inputs, int outputs, const float *restrict x, float *restrict y)
{
    const float *restrict row = w + outputs;
    int i = 0;
    for (int j = 0; j < outputs; ++j) {
        y[j] = w[j];
    }
    for (; i + 4 <= inputs; i += 4) {
        const float a = x[i], b = x[i + 1], c = x[i + 2], d = x[i + 3];
        const float *restrict second = row + outputs, *restrict third = second + outputs, *restrict fourth = third + outputs;
        for (int j = 0; j < outputs; ++j) {
            y[j] += (row[j] * a + second[j] * b) + (third[j] * c + fourth[j] * d);
        }
        row = fourth + outputs;
    }
    for (; i < inputs; ++i) {
        for (int j = 0; j < outputs; ++j) {
            y[j] += row[j] * x[i];
        }
        row += outputs;
    }
}
