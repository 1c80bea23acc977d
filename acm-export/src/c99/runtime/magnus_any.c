/* A twist: rotation w and translation v; the commutator is (w x w', w x v' - w' x v). */
typedef struct {
    vector w, v;
} motion;

static motion commutator(motion a, motion b)
{
    motion m;
    m.w = cross(a.w, b.w);
    m.v = plus(cross(a.w, b.v), -1.0, cross(b.w, a.v));
    return m;
}

/* a + k b. */
static motion moved(motion a, double k, motion b)
{
    motion m;
    m.w = plus(a.w, k, b.w);
    m.v = plus(a.v, k, b.v);
    return m;
}

/* Rotation vector and translation of one step, by the Magnus expansion of sixth order:
 *   Omega = a1 + a3/12 + 1/240 [a2 + C2, -20 a1 - a3 + C1],   C1 = [a2, a1],   C2 = -1/60 [2 a3 + C1, a1]
 * Blanes, Casas, Oteo, Ros (2009), Phys. Rep. 470. */
static void twist(const grid *g, int step, const double *c, vector *omega, vector *v)
{
    motion a[3], c1, w, u, sum;
    for (int o = 0; o < 3; ++o) {
        a[o].w = vector_of(share(g, step, c, o), share(g, step, c + FUNCTIONS, o), 0.0);
        a[o].v = vector_of(0.0, 0.0, o == 0 ? g->length[step] : 0.0);
    }
    c1 = commutator(a[1], a[0]);
    w = moved(a[1], -1.0 / 60.0, commutator(moved(c1, 2.0, a[2]), a[0]));
    u = moved(moved(c1, -20.0, a[0]), -1.0, a[2]);
    sum = moved(moved(a[0], 1.0 / 12.0, a[2]), 1.0 / 240.0, commutator(w, u));
    *omega = sum.w;
    *v = sum.v;
}
