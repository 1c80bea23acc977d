/* x Phi(x), Phi the normal distribution: its tail is exp(-x^2/2) t P(t), t = 1/(1 + 0.3 |x|/sqrt 2). */
static float gelu(float x)
{
    const float bell = exp_f(-0.5f * x * x);
    const float t = 1.0f / (0.21213203f * (x < 0.0f ? -x : x) + 1.0f);
    const float p = (((((((-0.0647614f * t + 0.24278135f) * t - 0.25613854f) * t + 0.27385947f) * t - 0.047325f) * t
        + 0.107462885f) * t + 0.07416962f) * t + 0.0853576f) * t + 0.084594005f;
    const float tail = bell * (t * p);
    return x * (x < 0.0f ? tail : 1.0f - tail);
}
