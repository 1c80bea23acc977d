/* Adds the static map: polynomials that are constant beyond the actuators' range, changes of slope, and harmonics of angles:
 *   m(q) = sum_j b_j prod_a T_{n_ja}(z_a) + sum_h s_h max(0, q_{a_h} - at_h) + sum_h a_h cos(n_h q) + b_h sin(n_h q),   z_a = clamp((2 q_a - high_a - low_a)/(high_a - low_a), -1, 1) */
static void static_map(const double *q, double *y)
{
    double t[ACTUATORS][MAP_DEGREE + 2];
    for (int a = 0; a < ACTUATORS; ++a) {
        const double width = MAP_HIGH[a] - MAP_LOW[a];
        const double z = width > 0.0 ? (2.0 * q[a] - MAP_HIGH[a] - MAP_LOW[a]) / width : 0.0;
        t[a][0] = 1.0;
        t[a][1] = z < -1.0 ? -1.0 : (z > 1.0 ? 1.0 : z);
        for (int n = 2; n <= MAP_DEGREE; ++n) {
            t[a][n] = 2.0 * t[a][1] * t[a][n - 1] - t[a][n - 2];
        }
    }
    for (int j = 0; j < MAP_TERMS; ++j) {
        double basis = 1.0;
        for (int a = 0; a < ACTUATORS; ++a) {
            basis *= t[a][MAP_EXPONENT[j][a]];
        }
        for (int o = 0; o < MODEL_OUTPUTS; ++o) {
            y[o] += MAP_COEFFICIENT[j][o] * basis;
        }
    }
$kinks$harmonics}
