/* tanh x. */
static float tanh_activation(float x)
{
    return tanh_f(x);
}
