/* x/(1 + exp(-x)). */
static float silu(float x)
{
    return x * (1.0f / (1.0f + exp_f(-x)));
}
