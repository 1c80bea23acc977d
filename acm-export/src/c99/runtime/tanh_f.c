/* tanh x = x P(x^2)/Q(x^2) on |x| <= 8.1, held constant beyond; relative error 1e-7. What is no number stays so. */
static float tanh_f(float x)
{
    const float low = x < -8.1f ? -8.1f : x;
    const float z = low > 8.1f ? 8.1f : low;
    const float s = z * z;
    const float top = (((2.9939088e-8f * s + 4.3343713e-5f) * s + 7.0975046e-3f) * s + 0.26760477f) * s + 1.9913543f;
    const float bottom = (((1.6819685e-6f * s + 6.768381e-4f) * s + 5.2046936e-2f) * s + 0.93138945f) * s + 1.9913543f;
    return z * top / bottom;
}
