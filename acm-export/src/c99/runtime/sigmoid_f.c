/* 1/(1 + exp(-x)) = 1/2 + tanh(x/2)/2. */
static float sigmoid_f(float x)
{
    return 0.5f * tanh_f(0.5f * x) + 0.5f;
}
