/* Steps along an arm, each with its share of every strain function:
 *   alpha_o = sum_i weights[step][o][i] c[first[step] + i]   for orders o = 0, 1, 2: strain, its slope, its curvature */
typedef struct {
    int steps;
    const double *length;
    const int *first;
    const double *weights;
} grid;

static double share(const grid *g, int step, const double *c, int order)
{
    const double *w = g->weights + (step * 3 + order) * ACTIVE;
    double sum = 0.0;
    for (int i = 0; i < ACTIVE; ++i) {
        sum += c[g->first[step] + i] * w[i];
    }
    return sum;
}
