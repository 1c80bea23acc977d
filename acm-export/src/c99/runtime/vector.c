/* Vectors in space. */
typedef struct {
    double x, y, z;
} vector;

static vector vector_of(double x, double y, double z)
{
    vector v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

/* a + k b. */
static vector plus(vector a, double k, vector b)
{
    return vector_of(a.x + k * b.x, a.y + k * b.y, a.z + k * b.z);
}

static vector cross(vector a, vector b)
{
    return vector_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
