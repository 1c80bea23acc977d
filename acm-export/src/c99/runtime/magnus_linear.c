/* Rotation vector and translation of one step, by the Magnus expansion of sixth order for bending that varies linearly:
 *   Omega = a1 + [w, C1]/240 - [w, a1]/12,   C1 = [a2, a1],   w = a2 + [a1, C1]/60
 * Blanes, Casas, Oteo, Ros (2009), Phys. Rep. 470. */
static void twist(const grid *g, int step, const double *c, vector *omega, vector *v)
{
    const double h = g->length[step];
    const double x = share(g, step, c, 0), y = share(g, step, c + FUNCTIONS, 0);
    const double dx = share(g, step, c, 1), dy = share(g, step, c + FUNCTIONS, 1);
    const double cz = dx * y - dy * x, cx = dy * h, cy = -dx * h;
    const double wx = dx + y * cz / 60.0, wy = dy - x * cz / 60.0, wz = (x * cy - y * cx) / 60.0;
    omega->x = x + wy * cz / 240.0;
    omega->y = y - wx * cz / 240.0;
    omega->z = (wx * y - wy * x) / -12.0;
    v->x = (wy * h - wz * y) / -12.0;
    v->y = (wz * x - wx * h) / -12.0;
    v->z = h + (wx * cy - wy * cx) / 240.0;
}
