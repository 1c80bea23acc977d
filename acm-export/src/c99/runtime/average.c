
/* Adds the answer of a member by its weight. */
static void add($whole_answer *sum, const $whole_answer *one, double weight)
{
    for (int o = 0; o < $WHOLE_OUTPUTS; ++o) {
        sum->output[o] += weight * one->output[o];
        sum->nominal[o] += weight * one->nominal[o];
    }
    sum->in_range = sum->in_range == 1 ? one->in_range : sum->in_range;
}

/* The next sample, which every member takes: the answer is the weighted mean of theirs. */
static int take($whole_state *s, const double *in, double elapsed, int seen, $whole_answer *answer)
{
    $whole_answer sum = { { 0.0 }, { 0.0 }, 1 }, one;
    int result;
    for (int i = 0; i < $WHOLE_INPUTS; ++i) {
        if (!(in[i] >= -1e12 && in[i] <= 1e12)) {
            return $WHOLE_INPUT;
        }
    }
@MEMBERS    *answer = sum;
    return $WHOLE_OK;
}
