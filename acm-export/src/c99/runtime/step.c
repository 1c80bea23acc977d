/* The next sample; the network is asked where it is `seen`. */
static int take($name_state *s, const double *in, double elapsed, int seen, $whole_answer *answer)
{
    float x[@CHANNELS], predicted[@PADDED];
@LOCALS    double y[@ALL], out[@OUTPUTS], z[@CHANNELS], time, since;
    int begins, result;
@INSIDE@PREDICT    since = s->unseen + elapsed;
    /* After a longer step the network begins anew. */
    begins = s->history == 0 || since > @MAX_GAP;
    for (int c = 0; c < @CHANNELS; ++c) {
        double value = in[CHANNEL[c][0]];
        if (CHANNEL[c][1]) {
            value = begins ? 0.0 : (value - s->before[CHANNEL[c][0]]) / since;
        }
@LOOK        z[c] = (value - CHANNEL_MEAN[c]) / CHANNEL_SPREAD[c];
    }
    if (seen) {
        const float step = (float)(begins ? @FIRST : since);
        for (int c = 0; c < @CHANNELS; ++c) {
            if (!(z[c] >= -3.4e38 && z[c] <= 3.4e38)) {
                @REFUSE_CHANNEL
            }
            x[c] = (float)z[c];
        }
@ASK@STRAIGHT        for (int o = 0; o < @OUTPUTS; ++o) {
            out[o] = y[@TIP + o] + ((double)predicted[o] * TARGET_SPREAD[o] + TARGET_MEAN[o]@PATH);
            if (!(out[o] >= -1e290 && out[o] <= 1e290)) {
                @REFUSE_OUTPUT
            }
        }
@COMMIT        memcpy(s->before, in, sizeof s->before);
        s->history = begins ? 1 : s->history + 1;
        s->unseen = 0.0;
    } else {
        for (int o = 0; o < @OUTPUTS; ++o) {
            out[o] = y[@TIP + o];
        }
        s->unseen = since;
    }
    for (int o = 0; o < @OUTPUTS; ++o) {
        answer->nominal[o] = y[@TIP + o];
        answer->output[o] = out[o];
    }
    answer->in_range = @IN_RANGE;
    s->started = 1;
    s->time = time;
    return $WHOLE_OK;
}
