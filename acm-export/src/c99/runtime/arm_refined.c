/* Marker positions on one grid, seen from the base: every step is folded onto the next, from the tip to the base. */
static void places(const grid *g, const int *after, const double *c, vector *r)
{
    for (int m = 0; m < MARKERS; ++m) {
        r[m] = vector_of(0.0, 0.0, 0.0);
    }
    for (int step = g->steps - 1; step >= 0; --step) {
        vector omega, v;
        coefficients k;
        twist(g, step, c, &omega, &v);
        k = coefficients_at(omega.x * omega.x + omega.y * omega.y + omega.z * omega.z);
        for (int m = 0; m < MARKERS; ++m) {
            if (after[m] > step) {
                r[m] = fold(omega, v, k, r[m]);
            }
        }
    }
}

/* Marker positions of an arm with the strain coordinates c, m, on the first grid that changes them by less than 63 TOLERANCE (the
 * error of sixth order falls by 64 as steps are halved), then turned and moved to where the base is: p = TURN r + BASE. */
static void arm(const double *c, double *y)
{
    vector r[MARKERS];
    places(ARM[0], MARKER_AFTER[0], c, r);
    for (int level = 1; level < LEVELS; ++level) {
        vector coarse[MARKERS];
        double change = 0.0;
        memcpy(coarse, r, sizeof r);
        places(ARM[level], MARKER_AFTER[level], c, r);
        for (int m = 0; m < MARKERS; ++m) {
            const vector off = plus(coarse[m], -1.0, r[m]);
            const double square = dot(off, off);
            change = square > change ? square : change;
        }
        if (change < 63.0 * TOLERANCE * (63.0 * TOLERANCE)) {
            break;
        }
    }
    for (int m = 0; m < MARKERS; ++m) {
        for (int i = 0; i < 3; ++i) {
            y[3 * m + i] = TURN[i][0] * r[m].x + TURN[i][1] * r[m].y + TURN[i][2] * r[m].z + BASE[i];
        }
    }
}
