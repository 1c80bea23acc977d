/* Play: the output rests while the input moves within +-width of it, at first centred. */
static double play_step(double x, double width, $whole_play *m)
{
    const double rest = m->started ? m->rest : x;
    const double above = rest > x - width ? rest : x - width;
    m->rest = above < x + width ? above : x + width;
    m->started = 1;
    return m->rest;
}
