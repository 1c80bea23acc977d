    for (int i = 0; i < @INPUTS; ++i) {
        if (!(in[i] >= -1e12 && in[i] <= 1e12)) {
            return $WHOLE_INPUT;
        }
    }
    if (!s->started) {
        elapsed = 0.0;
    } else if (!(elapsed > 0.0 && s->time + elapsed <= 1e12)) {
        return $WHOLE_TIME;
    }
    time = s->time + elapsed;
    result = nominal(time, in, @MEMORYy);
    if (result != $WHOLE_OK) {
        return result;
    }
    for (int o = 0; o < @ALL; ++o) {
        if (!(y[o] >= -1e290 && y[o] <= 1e290)) {
            @REFUSE_NOMINAL
        }
    }
