    for (int h = 0; h < KINKS; ++h) {
        const double beyond = q[KINK_ACTUATOR[h][0]] - KINK_AT[h];
        for (int o = 0; beyond > 0.0 && o < MODEL_OUTPUTS; ++o) {
            y[o] += KINK_SLOPE[h][o] * beyond;
        }
    }
