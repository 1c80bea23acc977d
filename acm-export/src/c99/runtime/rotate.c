/* exp([w]) p: p turned by the rotation vector w, rad. */
static vector rotate(vector w, vector p)
{
    const coefficients k = coefficients_at(w.x * w.x + w.y * w.y + w.z * w.z);
    const vector once = cross(w, p);
    return plus(plus(p, k.a, once), k.b, cross(w, once));
}
