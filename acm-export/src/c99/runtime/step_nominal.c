/* The next sample, which the nominal model answers alone. */
static int take($name_state *s, const double *in, double elapsed, int seen, $whole_answer *answer)
{
    double y[@ALL], time;
    int result;
@PREDICT    for (int o = 0; o < @OUTPUTS; ++o) {
        answer->nominal[o] = y[@TIP + o];
        answer->output[o] = y[@TIP + o];
    }
    answer->in_range = -1;
    s->started = 1;
    s->time = time;
    s->history += seen ? 1u : 0u;
    return $WHOLE_OK;
}
