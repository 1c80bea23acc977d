/* Marker positions of an arm with the strain coordinates c, m: every step is folded onto the next, from the tip to the base,
 * then turned and moved to where the base is: p = TURN r + BASE. */
static void arm(const double *c, double *y)
{
    vector r[MARKERS];
    for (int m = 0; m < MARKERS; ++m) {
        r[m] = vector_of(0.0, 0.0, 0.0);
    }
    for (int step = STEPS - 1; step >= 0; --step) {
        vector omega, v;
        coefficients k;
        twist(&ARM_GRID, step, c, &omega, &v);
        k = coefficients_at(omega.x * omega.x + omega.y * omega.y + omega.z * omega.z);
        for (int m = 0; m < MARKERS; ++m) {
            if (MARKER_AFTER[m] > step) {
                r[m] = fold(omega, v, k, r[m]);
            }
        }
    }
    for (int m = 0; m < MARKERS; ++m) {
        for (int i = 0; i < 3; ++i) {
            y[3 * m + i] = TURN[i][0] * r[m].x + TURN[i][1] * r[m].y + TURN[i][2] * r[m].z + BASE[i];
        }
    }
}
