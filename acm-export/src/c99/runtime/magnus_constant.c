/* Rotation vector and translation of one step: constant strain, omega = h kappa, v = h e_z. */
static void twist(const grid *g, int step, const double *c, vector *omega, vector *v)
{
    *omega = vector_of(share(g, step, c, 0), share(g, step, c + FUNCTIONS, 0), 0.0);
    *v = vector_of(0.0, 0.0, g->length[step]);
}
