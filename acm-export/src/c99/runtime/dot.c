static double dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
