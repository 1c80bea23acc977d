/* 1.7159 tanh(0.666 x). LeCun et al. (1998), Efficient BackProp. */
static float lecun_tanh(float x)
{
    return 1.7159f * tanh_f(0.666f * x);
}
