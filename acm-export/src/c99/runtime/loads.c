/* Where a node of the arm is, seen from the base in the directions of the measurement frame: position, tangent, axes across,
 * drag of a jet that keeps its strength and of one that loses it on its way down. */
typedef struct {
    vector p, t, d1, d2, wash, near;
} node;

static vector node_axes(const vector r[3], vector u)
{
    return plus(plus(vector_of(r[0].x * u.x, r[0].y * u.x, r[0].z * u.x), u.y, r[1]), u.z, r[2]);
}

static void node_place(node *n, vector p, const vector r[3])
{
    const vector down = vector_of(DOWN[0], DOWN[1], DOWN[2]);
    const vector across = plus(down, -dot(r[2], down), r[2]);
    const double size = sqrt_d(dot(across, across)), depth = dot(p, down) / LENGTH;
    const double left = 1.0 - (depth < 0.0 ? 0.0 : (depth > 1.0 ? 1.0 : depth));
    n->p = p;
    n->d1 = r[0];
    n->d2 = r[1];
    n->t = r[2];
    n->wash = vector_of(across.x * size, across.y * size, across.z * size);
    n->near = vector_of(n->wash.x * left, n->wash.y * left, n->wash.z * left);
}

/* Change of curvature at a node: the moment of all that lies beyond it, without the part along the arm. */
static vector node_bend(const node *n, vector force, vector torque)
{
    const vector moment = plus(torque, -1.0, cross(n->p, force));
    return plus(moment, -dot(n->t, moment), n->t);
}

/* Simpson's rule over a panel, and over its second half. */
static vector over_panel(double half, vector a, vector m, vector b)
{
    const vector sum = plus(plus(a, 4.0, m), 1.0, b);
    return vector_of(sum.x * half / 3.0, sum.y * half / 3.0, sum.z * half / 3.0);
}

static vector over_second_half(double half, vector a, vector m, vector b)
{
    return vector_of((8.0 * m.x + 5.0 * b.x - a.x) * half / 12.0, (8.0 * m.y + 5.0 * b.y - a.y) * half / 12.0,
        (8.0 * m.z + 5.0 * b.z - a.z) * half / 12.0);
}

/* Change of curvature at every node under the loads w (over bending stiffness), from the tip inwards:
 *   M(s) = int_s^L (p(u) - p(s)) x w(u) du + (p(L) - p(s)) x F,   k = M - t (t . M) */
static void bend_under(const node *n, const double *w, vector *k)
{
    vector load[NODES], turn[NODES], force, torque;
    for (int i = 0; i < NODES; ++i) {
        load[i] = vector_of(DOWN[0] * w[1] + SIDE_1[0] * w[4] + SIDE_2[0] * w[5],
            DOWN[1] * w[1] + SIDE_1[1] * w[4] + SIDE_2[1] * w[5], DOWN[2] * w[1] + SIDE_1[2] * w[4] + SIDE_2[2] * w[5]);
        load[i] = plus(plus(load[i], w[2], n[i].wash), w[3], n[i].near);
        turn[i] = cross(n[i].p, load[i]);
    }
    force = vector_of(DOWN[0] * w[0], DOWN[1] * w[0], DOWN[2] * w[0]);
    torque = cross(n[NODES - 1].p, force);
    k[NODES - 1] = node_bend(&n[NODES - 1], force, torque);
    for (int panel = PANELS - 1; panel >= 0; --panel) {
        const int a = 2 * panel;
        const double half = HALF_PANEL[panel];
        k[a + 1] = node_bend(&n[a + 1], plus(force, 1.0, over_second_half(half, load[a], load[a + 1], load[a + 2])),
            plus(torque, 1.0, over_second_half(half, turn[a], turn[a + 1], turn[a + 2])));
        force = plus(force, 1.0, over_panel(half, load[a], load[a + 1], load[a + 2]));
        torque = plus(torque, 1.0, over_panel(half, turn[a], turn[a + 1], turn[a + 2]));
        k[a] = node_bend(&n[a], force, torque);
    }
}

/* Adds to every marker what the loads w[0..5] on the arm, the same w[6..11] as far as tendons hold them, and the marker's
 * displacement w[12..14] along its disk do:
 *   u_m = int_0^{s_m} k(s) x (p(s_m) - p(s)) ds
 * w: weight at the tip, own weight, wash, wash near the base, side loads 1 and 2. First order about the bent arm. */
static void add_loads(const double *c, const double *w, double *y)
{
    node n[NODES];
    vector k[NODES], r[3], p = vector_of(0.0, 0.0, 0.0), turned = p, swung = p;
    double mean_1 = 0.0, mean_2 = 0.0;
    for (int j = 0; j < 3; ++j) {
        r[j] = vector_of(TURN[0][j], TURN[1][j], TURN[2][j]);
    }
    node_place(&n[0], p, r);
    for (int i = 0; i + 1 < NODES; ++i) {
        vector omega, v, next[3];
        coefficients f;
        twist(&NODE_GRID, i, c, &omega, &v);
        f = coefficients_at(dot(omega, omega));
        p = plus(p, 1.0, node_axes(r, fold(omega, v, f, vector_of(0.0, 0.0, 0.0))));
        next[0] = node_axes(r, rotate(omega, vector_of(1.0, 0.0, 0.0)));
        next[1] = node_axes(r, rotate(omega, vector_of(0.0, 1.0, 0.0)));
        next[2] = node_axes(r, rotate(omega, vector_of(0.0, 0.0, 1.0)));
        for (int j = 0; j < 3; ++j) {
            r[j] = next[j];
        }
        node_place(&n[i + 1], p, r);
    }
    /* What tendons hold: the mean of the bending, the same everywhere along the arm. */
    bend_under(n, w + 6, k);
    for (int panel = 0; panel < PANELS; ++panel) {
        for (int i = 0; i < 3; ++i) {
            const double weight = (i == 1 ? 4.0 : 1.0) * HALF_PANEL[panel] / 3.0 / LENGTH;
            mean_1 += weight * dot(n[2 * panel + i].d1, k[2 * panel + i]);
            mean_2 += weight * dot(n[2 * panel + i].d2, k[2 * panel + i]);
        }
    }
    bend_under(n, w, k);
    for (int i = 0; i < NODES; ++i) {
        k[i] = plus(plus(k[i], mean_1, n[i].d1), mean_2, n[i].d2);
    }
    for (int panel = 0; panel < PANELS; ++panel) {
        const int a = 2 * panel, b = a + 2;
        const double half = HALF_PANEL[panel];
        turned = plus(turned, 1.0, over_panel(half, k[a], k[a + 1], k[b]));
        swung = plus(swung, 1.0, over_panel(half, cross(k[a], n[a].p), cross(k[a + 1], n[a + 1].p), cross(k[b], n[b].p)));
        for (int m = 0; m < MARKERS; ++m) {
            if (MARKER_NODE[m] == b) {
                const vector u = plus(cross(turned, n[b].p), -1.0, swung);
                y[3 * m] += u.x;
                y[3 * m + 1] += u.y;
                y[3 * m + 2] += u.z;
            }
        }
    }
    for (int m = 0; m < MARKERS; ++m) {
        const vector axes[3] = { n[MARKER_NODE[m]].d1, n[MARKER_NODE[m]].d2, n[MARKER_NODE[m]].t };
        const vector along = vector_of(AXIS[0][0] * w[12] + AXIS[1][0] * w[13] + AXIS[2][0] * w[14],
            AXIS[0][1] * w[12] + AXIS[1][1] * w[13] + AXIS[2][1] * w[14],
            AXIS[0][2] * w[12] + AXIS[1][2] * w[13] + AXIS[2][2] * w[14]);
        const vector u = node_axes(axes, along);
        y[3 * m] += u.x;
        y[3 * m + 1] += u.y;
        y[3 * m + 2] += u.z;
    }
}
