/* exp x = 2^n p(f), x = (n + f) ln 2, |f| <= 1/2, p Taylor's polynomial of 2^f; x is held within -87 and 88. */
static float exp_f(float x)
{
    const float low = x > -87.0f ? x : -87.0f;
    const float z = low < 88.0f ? low : 88.0f;
    const float turns = z * 1.44269504f;
    const int32_t n = (int32_t)(turns + (turns < 0.0f ? -0.5f : 0.5f));
    const float rest = (z - (float)n * 0.693359375f) + (float)n * 2.12194440e-4f;
    const float f = rest * 1.44269504f;
    const float p = ((((((1.5252734e-5f * f + 1.540353e-4f) * f + 1.3333558e-3f) * f + 9.618129e-3f) * f
        + 5.550411e-2f) * f + 0.2402265f) * f + 0.6931472f) * f + 1.0f;
    const uint32_t bits = (uint32_t)(n + 127) << 23;
    float power;
    memcpy(&power, &bits, sizeof power);
    return x == x ? p * power : x;
}
