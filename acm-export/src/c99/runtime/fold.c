/* A place beyond a step, seen from where the step begins:
 *   r' = r + v + omega x w,   w = a r + b v + omega x u,   u = b r + c v */
static vector fold(vector omega, vector v, coefficients k, vector r)
{
    const vector u = plus(vector_of(k.b * r.x, k.b * r.y, k.b * r.z), k.c, v);
    const vector w = plus(plus(vector_of(k.a * r.x, k.a * r.y, k.a * r.z), k.b, v), 1.0, cross(omega, u));
    return plus(plus(r, 1.0, v), 1.0, cross(omega, w));
}
